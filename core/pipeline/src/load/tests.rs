//! Tests of the loader, on a small world of stages that do nothing.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod basis;
mod faults;
mod graph;
pub(crate) mod kit;
mod overrides;
mod qualities;
mod syntax;
mod wild;

use super::{Faults, Override, Pipeline, load};
use std::path::Path;
use toile_core::Feed;

/// Loads a text as `vest.ron` with the test stages.
fn read(text: &str) -> Result<Pipeline, Faults> {
    set(text, &[])
}

/// The same, with `--set` arguments.
fn set(text: &str, overrides: &[&str]) -> Result<Pipeline, Faults> {
    let overrides: Vec<Override> = overrides.iter().map(|o| o.parse().expect("PATH=VALUE")).collect();
    load(text, "vest.ron", Path::new("pipelines"), &kit::registry(), &overrides)
}

fn good(text: &str) -> Pipeline {
    read(text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Loads a faulty text: its faults, a line each.
fn faults(text: &str) -> String {
    read(text).expect_err("the text has a fault").to_string()
}

/// What each fault's labels cover, with what they say.
fn places(text: &str) -> Vec<Vec<(String, String)>> {
    let faults = read(text).expect_err("the text has a fault");
    faults.faults.iter().map(|f| labels(&faults, f)).collect()
}

/// What a fault's labels cover, in the file or in the option, with what they say.
fn labels(faults: &Faults, fault: &super::Fault) -> Vec<(String, String)> {
    let text = fault.option.as_ref().unwrap_or(&faults.text);
    fault.labels.iter().map(|l| (text[l.span.clone()].to_owned(), l.text.clone())).collect()
}

/// The graph as text: `Canny < Otsu, Photos`.
fn wiring(pipeline: &Pipeline) -> Vec<String> {
    let feed = |f: &Feed| match f {
        Feed::Nothing => "-".to_owned(),
        Feed::RunLog => "log".to_owned(),
        Feed::Node { node, port: 0 } => pipeline.nodes[*node].id.clone(),
        Feed::Node { node, port } => format!("{}.{port}", pipeline.nodes[*node].id),
    };
    let line = |n: &toile_core::Node| {
        let feeds: Vec<String> = n.inputs.iter().map(feed).collect();
        format!("{} < {}", n.id, feeds.join(", ")).trim_end_matches([' ', '<']).to_owned()
    };
    pipeline.nodes.iter().map(line).collect()
}

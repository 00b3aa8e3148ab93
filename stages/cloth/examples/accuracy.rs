//! Prints the scoreboard: `cargo run --release -p toile-cloth --example accuracy -- [E1 ..] [--all] [--seeds N] [--json]`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::ops::ControlFlow;

use toile_cloth::bench::accuracy::{Options, accuracy};
use toile_cloth::bench::{Layout, Models, Test};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let has = |flag: &str| args.iter().any(|a| a == flag);
    let wanted: Vec<&String> = args.iter().filter(|a| !a.starts_with("--")).collect();
    let mut options = Options::default();
    if !wanted.is_empty() {
        let tests =
            Test::ALL.into_iter().filter(|t| wanted.iter().any(|w| t.label().starts_with(w.as_str())));
        options.tests = tests.collect();
    }
    if has("--all") {
        options.models = Models::ALL.to_vec();
    }
    if let Some(n) =
        args.iter().position(|a| a == "--seeds").and_then(|k| args.get(k + 1)?.parse::<u64>().ok())
    {
        options.layouts =
            std::iter::once(Layout::Equilateral).chain((1..=n).map(Layout::Irregular)).collect();
    }
    let report = accuracy(&options, &mut |share, what| {
        eprintln!("{:3.0} % {what}", 100.0 * share);
        ControlFlow::Continue(())
    });
    if has("--json") { println!("{}", report.to_json()) } else { println!("{report}") }
}

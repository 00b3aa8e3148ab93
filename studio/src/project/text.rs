//! What is known of a text before it runs.

use crate::fault::FaultPlace;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use toile_core::{Card, Feed, Node, Registry, Role};
use toile_pipeline::{Faults, Pipeline, add_implicit, fields_of, load};

/// A stage as a page lists it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct StageLine {
    pub(crate) id: String,
    pub(crate) name: String,
    pub(crate) role: &'static str,
    /// Its path for edits; none of a stage that the text does not name.
    pub(crate) path: Option<String>,
    /// Parameters that the text gives, as they are written.
    pub(crate) params: BTreeMap<String, String>,
    /// The stages that it reads from.
    pub(crate) made_by: Vec<String>,
    /// Whether it reads a pattern and takes a file of seams for it.
    #[serde(skip)]
    takes_seams: bool,
}

/// The body's stage, for its measures.
#[derive(Debug, Clone)]
pub(crate) struct BodyStage {
    pub(crate) name: String,
    pub(crate) path: String,
    pub(crate) card: Card,
    pub(crate) given: BTreeMap<String, String>,
}

/// A text that was looked at.
#[derive(Debug, Clone, Default)]
pub(crate) struct CheckedText {
    /// What is wrong with it.
    pub(crate) faults: Vec<FaultPlace>,
    /// How many of the faults are the text's own, and not those of files that it names.
    pub(crate) own: usize,
    /// Its stages; of a text that cannot be read, those of the last one that could.
    pub(crate) stages: Vec<StageLine>,
    /// Its body.
    pub(crate) body: Option<BodyStage>,
}

impl CheckedText {
    /// Looks at a text; `before` is what was known of the one before it.
    pub(crate) fn of(
        text: &str,
        (file, base): (&str, &Path),
        registry: &Registry,
        before: &CheckedText,
    ) -> Self {
        match load(text, file, base, registry, &[]) {
            Err(faults) => {
                let faults = FaultPlace::all(&faults);
                CheckedText { own: faults.len(), faults, ..before.clone() }
            }
            Ok(mut pipeline) => {
                add_implicit(&mut pipeline, registry);
                let of_files = toile_pipeline::faults(&pipeline, |_| true, None).err();
                let faults = of_files.as_ref().map(|f: &Faults| FaultPlace::all(f)).unwrap_or_default();
                CheckedText { faults, own: 0, stages: lines(&pipeline), body: body(&pipeline) }
            }
        }
    }

    /// Whether photos are cut by the kind of garment that they show.
    pub(crate) fn cuts_photos(&self) -> bool {
        self.stages.iter().any(|s| s.path.as_deref() == Some("style") && s.name == "Block")
    }

    /// The names of the landmarks that the style is given.
    pub(crate) fn landmarks(&self) -> BTreeSet<String> {
        let given = self.stages.iter().filter(|s| s.path.as_deref() == Some("style"));
        let texts = given.filter_map(|s| s.params.get("landmarks"));
        texts
            .flat_map(|text| fields_of(text).into_keys())
            .map(|key| key.trim_matches('"').to_owned())
            .collect()
    }

    /// The path by which the reader of the pattern is given a file of seams; none where it takes
    /// none or has one.
    pub(crate) fn seams_to_give(&self) -> Option<String> {
        let is_empty = |s: &&StageLine| s.params.get("seams").is_none_or(|text| text == "\"\"");
        let reader = self.stages.iter().filter(|s| s.takes_seams).find(is_empty)?;
        Some(format!("{}.seams", reader.path.as_ref()?))
    }

    /// Whether it can be run.
    pub(crate) fn runs(&self) -> bool {
        self.faults.is_empty()
    }

    /// Whether it has a fault that the other has not: one of the text, or one of a file with other
    /// words.
    pub(crate) fn is_worse_than(&self, other: &CheckedText) -> bool {
        let is_new = |fault: &FaultPlace| !other.faults.iter().any(|f| f.message == fault.message);
        self.own > 0 || self.faults.iter().any(is_new)
    }
}

fn given(pipeline: &Pipeline, node: &Node) -> BTreeMap<String, String> {
    let text = |(name, span): (&String, &std::ops::Range<usize>)| {
        Some((name.clone(), pipeline.text.get(span.clone())?.to_owned()))
    };
    node.params.iter().filter_map(text).collect()
}

fn lines(pipeline: &Pipeline) -> Vec<StageLine> {
    let line = |node: &Node| {
        let mut made_by: Vec<String> = Vec::new();
        for feed in &node.inputs {
            if let Feed::Node { node, .. } = feed
                && let Some(maker) = pipeline.nodes.get(*node)
                && !made_by.contains(&maker.id)
            {
                made_by.push(maker.id.clone());
            }
        }
        StageLine {
            id: node.id.clone(),
            name: node.card.name.to_owned(),
            role: node.card.role.as_str(),
            path: pipeline.path_of(node),
            params: given(pipeline, node),
            made_by,
            takes_seams: node.card.role == Role::Reader && node.card.params.iter().any(|p| p.name == "seams"),
        }
    };
    pipeline.nodes.iter().map(line).collect()
}

fn body(pipeline: &Pipeline) -> Option<BodyStage> {
    let of = |node: &Node| {
        let path = pipeline.path_of(node).filter(|path| path == "body")?;
        let (card, name) = (node.card.clone(), node.card.name.to_owned());
        Some(BodyStage { name, path, card, given: given(pipeline, node) })
    };
    pipeline.nodes.iter().find_map(of)
}

//! Which runs follow an edit, and the pipelines that they run.

use std::path::PathBuf;
use toile_core::artifact::{ArtifactType, OutputFiles};
use toile_core::{Feed, Length, Node, Registry, Role};
use toile_pipeline::{Changes, Faults, Override, Pipeline, add_implicit, fields_of, load_with};

/// The quality that drafts have where the file names one.
const DRAFT: &str = "Draft";

/// How much coarser the mesh of a draft is where the file has no such quality.
const COARSER: f64 = 2.0;

/// How finely a run works.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum RunKind {
    /// Soon, and without writers; at a quality of the file where one is named.
    Draft(Option<String>),
    /// As the file says, or at one of its qualities, with its writers.
    Full(Option<String>),
}

impl RunKind {
    pub(crate) fn word(&self) -> &'static str {
        match self {
            RunKind::Draft(_) => "draft",
            RunKind::Full(_) => "full",
        }
    }
}

/// A text to run.
#[derive(Debug, Clone)]
pub(crate) struct RunAsk {
    pub(crate) text: String,
    /// Its number.
    pub(crate) edit: u64,
    pub(crate) file: String,
    /// The folder that its paths are relative to.
    pub(crate) base: PathBuf,
    /// One run after the other.
    pub(crate) kinds: Vec<RunKind>,
}

impl RunAsk {
    /// The pipeline of a kind of run.
    ///
    /// Errors: the faults of the text.
    pub(super) fn pipeline(&self, kind: &RunKind, registry: &Registry) -> Result<Pipeline, Faults> {
        let mut pipeline = match kind {
            RunKind::Full(quality) => self.load(quality.as_deref(), &[], registry)?,
            RunKind::Draft(quality) => self.draft(quality.as_deref(), registry)?,
        };
        if matches!(kind, RunKind::Draft(_)) {
            leave_out_writers(&mut pipeline);
        }
        add_implicit(&mut pipeline, registry);
        Ok(pipeline)
    }

    fn load(&self, quality: Option<&str>, set: &[Override], registry: &Registry) -> Result<Pipeline, Faults> {
        // A quality that the text no longer has was meant for an earlier text.
        let known = |name: &&str| names(&self.text, name);
        let changes = Changes { quality: quality.filter(known), set, ..Changes::default() };
        load_with(&self.text, &self.file, &self.base, registry, &changes)
    }

    fn draft(&self, quality: Option<&str>, registry: &Registry) -> Result<Pipeline, Faults> {
        let asked = quality.unwrap_or(DRAFT);
        let plain = self.load(None, &[], registry)?;
        if plain.qualities.iter().any(|q| q.name == asked) {
            return self.load(Some(asked), &[], registry);
        }
        let coarser: Vec<Override> = plain.nodes.iter().filter_map(|node| coarser(&plain, node)).collect();
        // Where the coarser one is refused the file as it is stands for it.
        Ok(self.load(None, &coarser, registry).unwrap_or(plain))
    }
}

/// Whether a text may have a quality of that name; the load says whether it has.
fn names(text: &str, quality: &str) -> bool {
    text.contains(&format!("{quality:?}"))
}

/// The setting by which a mesher gives a coarser mesh.
fn coarser(pipeline: &Pipeline, node: &Node) -> Option<Override> {
    let doc =
        node.card.params.iter().find(|p| p.name == "edge").filter(|_| node.card.role == Role::Mesher)?;
    let given = fields_of(&node.stage.params()).remove("edge").unwrap_or_else(|| doc.default.clone());
    let edge = given.trim_matches('"').parse::<Length>().ok()?.metres();
    let longer = (COARSER * edge).min(doc.max.unwrap_or(f64::INFINITY)).max(edge);
    let path = format!("{}.edge", pipeline.path_of(node)?);
    Some(Override { path, value: format!("\"{}\"", Length::m(longer)) })
}

/// Takes the stages out that give files and nothing else. A reader that writes what it proposes
/// beside its pattern stays.
fn leave_out_writers(pipeline: &mut Pipeline) {
    let gives_files = |n: &Node| n.card.outputs.iter().all(|o| o.kind == OutputFiles::KIND);
    let writes = |n: &Node| !n.card.outputs.is_empty() && gives_files(n);
    let mut places = Vec::new();
    let mut next = 0;
    for node in &pipeline.nodes {
        places.push((!writes(node)).then_some(next));
        next += usize::from(!writes(node));
    }
    pipeline.nodes.retain(|node| !writes(node));
    for feed in pipeline.nodes.iter_mut().flat_map(|n| &mut n.inputs) {
        if let Feed::Node { node, port } = *feed {
            let moved = places.get(node).copied().flatten();
            *feed = moved.map_or(Feed::Nothing, |node| Feed::Node { node, port });
        }
    }
}

/// All stages whose results no other takes: what a run without writers is to make.
pub(super) fn ends(pipeline: &Pipeline) -> Vec<String> {
    let is_end = |i: &usize| pipeline.consumers(*i).is_empty();
    (0..pipeline.nodes.len()).filter(is_end).map(|i| pipeline.nodes[i].id.clone()).collect()
}

//! What a quality's measurement rests on, as a digest.
//!
//! A claim of 2 mm holds for the pipeline that it was measured on: another mesher, fabric, photo or
//! setting makes another garment. So a quality keeps a digest of all that the draped garment
//! depends on, taken from the pipeline with the quality's own settings: what the quality sets
//! counts as it sets it, whatever the file has there itself.
//!
//! In the digest are the stages that lead to the last garment, each with its role, all its
//! parameters and what feeds it, and the **content** of the files that they name or look at
//! (photos, scenes, bodies): a file that is moved or renamed is the same file. Not in it are
//! comments, white space, names and ids, the order of the file, and stages that the garment does
//! not need: textures, writers, reports. A second digest holds the versions of the stages'
//! algorithms, so that a newer program is told apart from another pipeline.
//!
//! Cost: reading the files once. Limit: a file that a stage reads without naming it in its
//! parameters counts only where the stage looks at it beforehand (`sizes`).

use super::Quality;
use crate::file_hash::file_hash;
use crate::load::Pipeline;
use crate::load::parse;
use crate::load::syntax::tree::ValueTree;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::{Digester, Garment, OutputFiles};
use toile_core::cost::Size;
use toile_core::{ArtifactType, Cancel, Context, Feed, Node};

/// What a measurement was made on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Basis {
    /// The pipeline, up to the garment.
    pipeline: String,
    /// The versions of its stages.
    stages: String,
}

/// What a quality's claim is worth for a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It was measured for this pipeline.
    Holds,
    /// It was never measured.
    Promised,
    /// It does not say what it was measured for.
    Unknown,
    /// It was measured for another pipeline.
    OtherPipeline,
    /// It was measured for this pipeline with other versions of its stages.
    OtherStages,
}

impl Standing {
    /// In words that follow the quality's name; none where the claim holds.
    pub fn words(self) -> Option<&'static str> {
        match self {
            Standing::Holds => None,
            Standing::Promised => Some("not measured"),
            Standing::Unknown => Some("not known what it was measured for"),
            Standing::OtherPipeline => Some("measured for another pipeline"),
            Standing::OtherStages => Some("measured with other versions of its stages"),
        }
    }
}

impl Quality {
    /// What its claim is worth for `pipeline`, which is loaded with it.
    pub fn standing(&self, pipeline: &Pipeline) -> Standing {
        let Some(basis) = &self.basis else {
            return if self.measured.is_some() { Standing::Unknown } else { Standing::Promised };
        };
        let now = Basis::of(pipeline);
        match (basis.pipeline == now.pipeline, basis.stages == now.stages) {
            (true, true) => Standing::Holds,
            (true, false) => Standing::OtherStages,
            (false, _) => Standing::OtherPipeline,
        }
    }
}

impl Basis {
    /// Of a pipeline as it is loaded.
    pub fn of(pipeline: &Pipeline) -> Self {
        let needed = pipeline.needed_for(&results(pipeline));
        let mut of_nodes: Vec<[u8; 32]> = Vec::new();
        let mut versions = BTreeSet::new();
        for (node, needed) in pipeline.nodes.iter().zip(&needed) {
            // Those before it in the file stand in the list already; what nothing needs has an
            // empty place.
            of_nodes.push(if *needed { digest(pipeline, node, &of_nodes) } else { [0; 32] });
            if *needed {
                let plugin = node.card.plugin.map(|p| p.digest.hex()).unwrap_or_default();
                versions.insert((node.card.name, node.card.role.as_str(), node.card.version, plugin));
            }
        }
        let mut d = Digester::new();
        d.text("toile quality");
        results(pipeline).into_iter().filter_map(|i| of_nodes.get(i)).for_each(|own| {
            d.bytes(own);
        });
        let mut v = Digester::new();
        for (name, role, version, plugin) in versions {
            v.text(name).text(role).count(version as usize).text(&plugin);
        }
        Basis { pipeline: d.finish().short(), stages: v.finish().short() }
    }
}

/// The stages whose results are claimed: the last that gives a garment; in a pipeline without one,
/// all that give no files.
fn results(pipeline: &Pipeline) -> Vec<usize> {
    let gives = |node: &Node, kind| node.card.outputs.iter().any(|o| o.kind == kind);
    match pipeline.nodes.iter().rposition(|n| gives(n, Garment::KIND)) {
        Some(last) => vec![last],
        None => {
            (0..pipeline.nodes.len()).filter(|&i| !gives(&pipeline.nodes[i], OutputFiles::KIND)).collect()
        }
    }
}

fn digest(pipeline: &Pipeline, node: &Node, before: &[[u8; 32]]) -> [u8; 32] {
    let mut d = Digester::new();
    d.text(node.card.name).text(node.card.role.as_str());
    d.text(&by_content(&node.stage.params(), &pipeline.base));
    let looked_at = looked_at(pipeline, node);
    d.count(looked_at.len());
    looked_at.iter().for_each(|content| {
        d.text(content);
    });
    for feed in &node.inputs {
        match feed {
            Feed::Nothing => d.text("nothing"),
            Feed::RunLog => d.text("the run so far"),
            Feed::Node { node, port } => {
                d.text("stage").bytes(&before.get(*node).copied().unwrap_or_default()).count(*port)
            }
        };
    }
    d.finish().0
}

/// Parameters with the digest of its content in the place of each file that is there.
fn by_content(params: &str, base: &Path) -> String {
    fn walk(params: &str, tree: &ValueTree, base: &Path, out: &mut Vec<(std::ops::Range<usize>, String)>) {
        let written = params.get(tree.span.clone()).filter(|t| t.starts_with(['"', 'r']));
        let text = written.and_then(|t| toile_core::param::ron_options().from_str::<String>(t).ok());
        let file = text.filter(|t| !t.is_empty()).and_then(|t| file_hash(&base.join(t)));
        out.extend(file.map(|hash| (tree.span.clone(), hash.hex())));
        tree.entries().iter().for_each(|e| walk(params, &e.value, base, out));
    }
    let Ok(tree) = parse(params) else { return params.to_owned() };
    let mut files = Vec::new();
    walk(params, &tree, base, &mut files);
    let mut text = params.to_owned();
    files.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    files.into_iter().for_each(|(span, content)| text.replace_range(span, &content));
    text
}

/// The contents of the files that a stage looks at before it runs: those that its own files name,
/// such as a scene's body.
fn looked_at(pipeline: &Pipeline, node: &Node) -> BTreeSet<String> {
    let cx = Context::new(&node.id, &pipeline.base, Cancel::new(), Arc::new(()));
    let _ = catch_unwind(AssertUnwindSafe(|| node.stage.sizes(&Size::new(), &cx)));
    cx.take_reads().into_iter().filter_map(|(_, hash)| Some(hash?.hex())).collect()
}

impl std::fmt::Display for Basis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-{}", self.pipeline, self.stages)
    }
}

impl std::str::FromStr for Basis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_digest = |t: &&str| t.len() == 16 && t.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        match text.split_once('-').map(|(p, s)| [p, s].map(|t| Some(t).filter(is_digest))) {
            Some([Some(pipeline), Some(stages)]) => {
                Ok(Basis { pipeline: pipeline.to_owned(), stages: stages.to_owned() })
            }
            _ => {
                Err("it is two digests of 16 digits with `-` between them, as `toile tune` writes it".into())
            }
        }
    }
}

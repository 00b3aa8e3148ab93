//! Digests that identify a pipeline, a garment, a file.

use std::collections::BTreeMap;
use std::path::Path;
use toile_core::artifact::{Artifact, Digest, Digester, Garment};
use toile_pipeline::Pipeline;

/// The digest that identifies a pipeline: of its stages with versions, plugins and parameters.
pub fn digest(pipeline: &Pipeline, more: &[&str]) -> String {
    let mut d = Digester::new();
    for node in &pipeline.nodes {
        d.text(node.card.name)
            .text(node.card.role.as_str())
            .count(node.card.version as usize)
            .text(&node.stage.params());
        d.text(&node.card.plugin.map_or_else(String::new, |p| p.digest.hex()));
    }
    more.iter().for_each(|text| {
        d.text(text);
    });
    d.finish().short()
}

/// Names a garment by its content.
pub(crate) fn garment_digest(garment: &Garment) -> String {
    let mut d = Digester::new();
    garment.digest(&mut d);
    d.finish().hex()
}

/// Names a file's content; none for one that cannot be read.
pub(crate) fn content(path: impl AsRef<Path>) -> Option<String> {
    toile_core::read_file(path.as_ref()).ok().map(|bytes| Digest::of(&bytes).hex())
}

/// A file of these that is not as it was.
pub(crate) fn changed(reads: &BTreeMap<String, Option<String>>) -> Option<&str> {
    reads.iter().find(|(path, digest)| content(path) != **digest).map(|(path, _)| path.as_str())
}

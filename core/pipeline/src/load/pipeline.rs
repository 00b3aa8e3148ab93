//! A loaded pipeline.

use super::fault::{Fault, Faults, LineStarts};
use super::origin::TextChanges;
use super::plugins::PluginUse;
use super::qualities::Quality;
use std::path::PathBuf;
use toile_core::{Feed, Node, needed_for};

/// A pipeline file that has passed every check.
#[derive(Debug)]
pub struct Pipeline {
    /// Its `name`; the file's stem where it gives none.
    pub name: String,
    /// The file's name as the user gave it.
    pub file: String,
    /// The text that all places refer to (with overrides applied).
    pub text: String,
    /// The folder that paths in the file are relative to.
    pub base: PathBuf,
    /// Its stages; each stands after all that feed it.
    pub nodes: Vec<Node>,
    /// Plugins that the file asks for.
    pub plugins: Vec<PluginUse>,
    /// Its named qualities.
    pub qualities: Vec<Quality>,
    /// The quality that it is loaded with, for people: `Draft`, `Draft, changed by --set`.
    pub quality: Option<String>,
    /// The file's text as it stands, and where the parts of `text` come from.
    pub(super) written: (String, TextChanges),
}

impl Pipeline {
    /// The index of the stage with that id.
    pub fn find(&self, id: &str) -> Option<usize> {
        self.nodes.iter().position(|n| n.id == id)
    }

    /// The stages that read from a stage, in order.
    pub fn consumers(&self, node: usize) -> Vec<usize> {
        let reads =
            |n: &Node| n.inputs.iter().any(|f| matches!(f, Feed::Node { node: from, .. } if *from == node));
        self.nodes.iter().enumerate().filter(|(_, n)| reads(n)).map(|(i, _)| i).collect()
    }

    /// For each stage, whether it is one of `sinks` or feeds one, near or far.
    pub fn needed_for(&self, sinks: &[usize]) -> Vec<bool> {
        needed_for(&self.nodes, sinks)
    }

    /// The line of the file on which a stage stands, from 1.
    pub fn line(&self, node: &Node) -> usize {
        LineStarts::of(&self.text).position(&self.text, node.place.start).0
    }

    /// Faults of the text with its overrides, shown where the user wrote what is wrong.
    pub fn faults(&self, faults: Vec<Fault>) -> Faults {
        let (text, origin) = &self.written;
        Faults::new(&self.file, text, faults.into_iter().map(|f| origin.told(f)).collect())
    }
}

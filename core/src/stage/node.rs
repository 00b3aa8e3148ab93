//! A stage in its place in a pipeline.

use super::{Card, Stage};
use std::collections::BTreeMap;
use std::ops::Range;

/// A stage in its place.
#[derive(Debug)]
pub struct Node {
    /// Its id: unique, fit for a folder's name.
    pub id: String,
    /// The stage with its parameters.
    pub stage: Box<dyn Stage>,
    /// Its card.
    pub card: Card,
    /// The stage as written: `Otsu(bias: 3)`; of a table section, its value.
    pub span: Range<usize>,
    /// Its name as written, which diagnostics underline; of a table section, the field's name.
    pub place: Range<usize>,
    /// The value of each parameter that the file gives.
    pub params: BTreeMap<String, Range<usize>>,
    /// What feeds each of the card's inputs.
    pub inputs: Vec<Feed>,
}

/// What feeds an input port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feed {
    /// Nothing: the port is optional and no stage makes its kind.
    Nothing,
    /// The runner's own log.
    RunLog,
    /// An output port of another stage.
    Node {
        /// Its index among the pipeline's stages.
        node: usize,
        /// Its index in the card's outputs.
        port: usize,
    },
}

/// For each stage, whether it is one of `sinks` or feeds one, near or far; each stage stands after
/// all that feed it.
pub fn needed_for(nodes: &[Node], sinks: &[usize]) -> Vec<bool> {
    let mut needed: Vec<bool> = (0..nodes.len()).map(|i| sinks.contains(&i)).collect();
    // Producers stand before their consumers, so one pass from the end reaches all.
    for (i, node) in nodes.iter().enumerate().rev() {
        for feed in &node.inputs {
            if let (true, Feed::Node { node, .. }) = (needed[i], feed) {
                needed[*node] = true;
            }
        }
    }
    needed
}

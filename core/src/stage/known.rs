//! What a rule may look at.

use super::{Feed, Node};
use crate::Context;
use crate::cost::{Quantity, Size};

/// What is known of a stage's place before anything runs.
pub struct Known<'a> {
    /// How much the stage is expected to be given, all ports together.
    pub given: &'a Size,
    /// The pipeline's stages.
    pub nodes: &'a [Node],
    /// The stage's index in it.
    pub index: usize,
    /// For each stage whether it runs.
    pub runs: &'a [bool],
    /// For what the stage says that it must look at, such as the headers of files.
    pub cx: &'a Context,
}

impl Known<'_> {
    /// The stage's place in the pipeline.
    pub fn node(&self) -> &Node {
        &self.nodes[self.index]
    }

    /// Whether something feeds the port of that name.
    pub fn is_wired(&self, port: &str) -> bool {
        let node = self.node();
        let mut ports = node.card.inputs.iter().zip(&node.inputs);
        ports.any(|(p, feed)| p.name == port && *feed != Feed::Nothing)
    }

    /// Stages before this one that run.
    pub fn before(&self) -> impl Iterator<Item = &Node> {
        let nodes = self.nodes.iter().zip(self.runs).take(self.index);
        nodes.filter(|(_, runs)| **runs).map(|(n, _)| n)
    }

    /// An amount for one side of the garment, where all sides are alike.
    pub fn each(&self, quantity: Quantity) -> Option<f64> {
        let pieces = self.given.get(Quantity::Pieces).filter(|p| *p >= 1.0)?;
        Some(self.given.get(quantity)? / pieces)
    }
}

//! A stage in its pipeline, before anything runs.

use super::node::{Feed, Node, needed_for};
use crate::Context;

/// What a stage may look at to check its parameters and files before the run.
pub struct Placed<'a> {
    /// The pipeline's stages.
    pub nodes: &'a [Node],
    /// The stage's index in it.
    pub index: usize,
    /// For what the stage must look at outside: files, by the rules of the pipeline's paths.
    pub cx: &'a Context,
}

impl<'a> Placed<'a> {
    /// The stage's place in the pipeline.
    pub fn node(&self) -> &'a Node {
        &self.nodes[self.index]
    }

    /// The stage that feeds the port of that name.
    pub fn maker(&self, port: &str) -> Option<&'a Node> {
        let node = self.node();
        let mut ports = node.card.inputs.iter().zip(&node.inputs);
        ports.find(|(p, _)| p.name == port).and_then(|(_, feed)| self.fed_by(feed))
    }

    /// All stages from which this one's input comes, near and far, the nearest first.
    pub fn sources(&self) -> Vec<&'a Node> {
        let needed = needed_for(self.nodes, &[self.index]);
        let before = self.nodes.iter().zip(needed).take(self.index);
        before.filter(|(_, needed)| *needed).map(|(node, _)| node).rev().collect()
    }

    fn fed_by(&self, feed: &Feed) -> Option<&'a Node> {
        match feed {
            Feed::Node { node, .. } => self.nodes.get(*node),
            _ => None,
        }
    }
}

//! Pairs of cloth that may meet, kept while the cloth hardly moves.
//!
//! Pairs are sought a little farther out than contact reaches; they hold until some node has moved by that slack, which
//! near rest is many steps. Long steps seek along the way of each node, for that step alone.

use crate::contact::limit::limit;
use crate::contact::pair::Pair;
use crate::contact::tree::ClothTree;
use crate::rest::system::System;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// How far a node may move before pairs are sought anew, in thicknesses of the layer.
const SLACK: f64 = 1.5;

/// What is near what, and where the nodes were when it was sought.
pub(super) struct Nearby<'a> {
    tree: Option<&'a ClothTree>,
    at: Vec<Vec3>,
}

impl<'a> Nearby<'a> {
    pub(super) fn new(tree: Option<&'a ClothTree>) -> Self {
        Self { tree, at: vec![] }
    }

    /// Sees to it that the pairs of the layers hold for `moves` from `x`.
    pub(super) fn seek(&mut self, system: &mut System<'_>, x: &[Vec3], moves: &[Vec3]) {
        let (Some(tree), Some(layers)) = (self.tree, &mut system.layers) else { return };
        let slack = SLACK * layers.thickness;
        if self.at.len() == x.len() && within(&self.at, x, moves, slack) {
            return;
        }
        if within(x, x, moves, 0.5 * slack) {
            layers.pairs = tree.pairs(x, &vec![Vec3::zeros(); x.len()], layers.thickness + 2.0 * slack);
            self.at = x.to_vec();
        } else {
            layers.pairs = tree.pairs(x, moves, layers.thickness);
            self.at.clear();
        }
    }

    /// Shortens moves that would lead cloth through cloth.
    pub(super) fn limit(&self, system: &System<'_>, x: &[Vec3], moves: &mut [Vec3]) {
        let (Some(_), Some(layers)) = (self.tree, &system.layers) else { return };
        if layers.tangled.is_empty() {
            limit(x, moves, &layers.pairs);
        } else {
            let strict: Vec<Pair> = layers.pairs.iter().filter(|p| !layers.is_tangled(p)).copied().collect();
            limit(x, moves, &strict);
        }
    }

    /// Takes up crossings that the start has, or that are left of them.
    pub(super) fn untangle(&self, system: &mut System<'_>, x: &[Vec3]) {
        if let (Some(tree), Some(layers)) = (self.tree, &mut system.layers) {
            layers.untangle(&tree.crossings(x), x);
        }
    }
}

/// Whether every node stays within `reach` of where it was.
fn within(was: &[Vec3], x: &[Vec3], moves: &[Vec3], reach: f64) -> bool {
    was.iter().zip(x).zip(moves).all(|((a, p), m)| {
        let left = reach - m.norm();
        left > 0.0 && (p - a).norm_squared() < left * left
    })
}

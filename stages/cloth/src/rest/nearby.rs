//! Pairs of cloth that may meet, kept while the cloth hardly moves.
//!
//! Pairs are sought a little farther out than contact reaches; they hold until some node has moved by that slack, which
//! near rest is many steps. Long steps seek along the way of each node, for that step alone.

use crate::contact::limit::hold_apart;
use crate::contact::pair::Pair;
use crate::contact::tree::ClothTree;
use crate::rest::layers::Layers;
use crate::rest::system::System;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Share of the slack that may be used up where a part begins: it goes on with the pairs that are known.
const KEPT: f64 = 0.3;

/// What is near what, and where the nodes were when it was sought.
pub(super) struct Nearby {
    tree: Option<ClothTree>,
    at: Vec<Vec3>,
    /// What a part of a system knows of is about it: this holds while its nodes stay near where they were.
    fence: Option<Fence>,
}

/// Where the nodes of a part were when it was cut out, and how far they may go from there, m.
struct Fence {
    at: Vec<Vec3>,
    reach: f64,
}

impl Nearby {
    pub(super) fn new(tree: Option<ClothTree>) -> Self {
        Self { tree, at: vec![], fence: None }
    }

    /// Seeks the pairs about `x`, so that they hold for a part.
    pub(super) fn seek_about(&mut self, system: &mut System<'_>, x: &[Vec3]) {
        let still = vec![Vec3::zeros(); x.len()];
        let holds = |l: &Layers| within(&self.at, x, &still, KEPT * l.slack());
        let holds = self.at.len() == x.len() && system.layers.as_ref().is_none_or(holds);
        if !holds {
            self.at.clear();
            self.seek(system, x, &still);
        }
    }

    /// Where the nodes were when the pairs were sought.
    pub(super) fn at(&self) -> &[Vec3] {
        &self.at
    }

    /// For a part whose pairs were sought where its nodes were `at`, and hold while none moves by `reach` from there, m.
    pub(super) fn of_part(at: Vec<Vec3>, reach: f64) -> Self {
        Self { tree: None, at: vec![], fence: Some(Fence { at, reach }) }
    }

    /// For a part that seeks pairs in a tree of its own, which knows all that its nodes may meet within `reach` of `at`, m.
    pub(super) fn fenced(tree: ClothTree, at: Vec<Vec3>, reach: f64) -> Self {
        Self { tree: Some(tree), at: vec![], fence: Some(Fence { at, reach }) }
    }

    /// The share of `moves` from `x` for which a part knows what is about it.
    pub(super) fn within_reach(&self, x: &[Vec3], moves: &[Vec3]) -> f64 {
        let Some(Fence { at, reach }) = &self.fence else { return 1.0 };
        let share = |((a, p), m): ((&Vec3, &Vec3), &Vec3)| {
            let left = reach - (p - a).norm();
            if m.norm() < left { 1.0 } else { (left / m.norm()).max(0.0) * 0.99 }
        };
        at.iter().zip(x).zip(moves).map(share).fold(1.0, f64::min)
    }

    /// Sees to it that the pairs of the layers hold for `moves` from `x`.
    pub(super) fn seek(&mut self, system: &mut System<'_>, x: &[Vec3], moves: &[Vec3]) {
        let (Some(tree), Some(layers)) = (&self.tree, &mut system.layers) else { return };
        let slack = layers.slack();
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

    /// How often triangles cross at `x`.
    pub(super) fn crossings(&self, x: &[Vec3]) -> usize {
        self.tree.as_ref().map_or(0, |t| t.crossings(x).len())
    }

    /// Shortens moves that would lead cloth through cloth; the share of them that is left. Of cloth that gets free of crossings,
    /// which takes long ways, all counts as left.
    pub(super) fn limit(&self, system: &mut System<'_>, x: &[Vec3], moves: &mut [Vec3]) -> f64 {
        let Some(layers) = system.layers.as_mut().filter(|_| self.tree.is_some() || self.fence.is_some())
        else {
            return 1.0;
        };
        let wanted = norm(moves);
        let pairs = std::mem::take(&mut layers.pairs);
        let counts = |p: &Pair| !layers.is_tangled(p);
        // Pairs all round hold for every short move.
        let tree = self.tree.as_ref().filter(|_| self.at.is_empty());
        let seek = |moves: &[Vec3]| tree.map(|t| t.pairs(x, moves, layers.thickness));
        layers.pairs = hold_apart(x, moves, pairs, counts, seek).0;
        if wanted > 0.0 && layers.tangled.is_empty() { norm(moves) / wanted } else { 1.0 }
    }

    /// Takes up crossings that the start has, or that are left of them.
    pub(super) fn untangle(&self, system: &mut System<'_>, x: &[Vec3]) {
        if let (Some(tree), Some(layers)) = (&self.tree, &mut system.layers) {
            layers.untangle(&tree.crossings(x), x);
        }
    }
}

fn norm(moves: &[Vec3]) -> f64 {
    moves.iter().map(Vec3::norm_squared).sum::<f64>().sqrt()
}

/// Whether every node stays within `reach` of where it was.
fn within(was: &[Vec3], x: &[Vec3], moves: &[Vec3], reach: f64) -> bool {
    was.iter().zip(x).zip(moves).all(|((a, p), m)| {
        let left = reach - m.norm();
        left > 0.0 && (p - a).norm_squared() < left * left
    })
}

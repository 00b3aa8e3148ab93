//! Seams that close at a set speed. Cost: O(1) a pair.

use crate::scene::Scene;
use toile_geometry::Vec3;

/// Sweeps over all pairs at most, there and back.
const SWEEPS: usize = 10;

/// Share of a step's closing below which a change of moves is left alone.
const NEGLIGIBLE: f64 = 0.01;

/// What brings the two sides of a seam together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeamClosing {
    /// They come nearer at the set speed.
    Speed,
    /// The published force of each pair, in proportion to its gap, N/m. Pairs that have met are
    /// held together.
    Linear(f64),
}

/// Pairs of vertices that close.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Seams {
    pub(super) pairs: Vec<[u32; 2]>,
    /// Whether only pairs that have met are brought together, by pair; empty where all are.
    held: Vec<bool>,
}

impl Seams {
    /// Pairs that a force brings together.
    pub(super) fn new(pairs: Vec<[u32; 2]>, force: SeamClosing) -> Self {
        let held = match force {
            SeamClosing::Speed => Vec::new(),
            SeamClosing::Linear(_) => vec![false; pairs.len()],
        };
        Self { pairs, held }
    }

    /// Holds the pairs from now on whose gaps are below `gap`, m.
    pub(super) fn hold_met(&mut self, x: &[Vec3], gap: f64) {
        for (held, [a, b]) in self.held.iter_mut().zip(&self.pairs) {
            *held |= (x[*a as usize] - x[*b as usize]).norm() < gap;
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The pair with the widest gap.
    pub(super) fn widest(&self, x: &[Vec3]) -> Option<([u32; 2], f64)> {
        let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
        self.pairs.iter().map(|p| (*p, gap(p))).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Changes the moves so that the gap of each pair shrinks by at most `most`, with the momentum
    /// of the pair kept; `inverse` is the inverse inertia of each vertex, 0 where it is held.
    ///
    /// Pairs that share a vertex change each other's moves, so it goes over them again, there and
    /// back: the change is then its own adjoint in the inertia, and central differences stay
    /// stable. Sweeps in one direction made a T-shirt's motion grow without bound, the faster the
    /// shorter the steps.
    pub(super) fn close(&self, x: &[Vec3], moves: &mut [Vec3], inverse: &[f64], most: f64) {
        let mut one = |k: usize| {
            let [a, b] = self.pairs[k].map(|v| v as usize);
            let gap = x[b] - x[a];
            let length = gap.norm();
            let wanted = if length > most { gap * (-most / length) } else { -gap };
            let (wa, wb) = (inverse[a], inverse[b]);
            if self.held.get(k) == Some(&false) || wa + wb == 0.0 {
                return 0.0;
            }
            let change = wanted - (moves[b] - moves[a]);
            moves[a] -= change * (wa / (wa + wb));
            moves[b] += change * (wb / (wa + wb));
            change.norm()
        };
        for _ in 0..SWEEPS {
            let there = (0..self.pairs.len()).map(&mut one).fold(0.0, f64::max);
            let back = (0..self.pairs.len()).rev().map(&mut one).fold(0.0, f64::max);
            if there.max(back) < NEGLIGIBLE * most {
                break;
            }
        }
    }
}

/// The seam that a vertex of the scene belongs to, by the sewn point of each vertex.
pub(super) fn name_of(scene: &Scene, points: &[u32], vertex: u32) -> String {
    let point = |v: u32| points.get(v as usize);
    let has = |p: &[u32; 2]| point(p[0]) == point(vertex);
    let seam = scene.seams.iter().find(|s| s.pairs.iter().any(has));
    seam.map_or("?".into(), |s| s.name.clone())
}

//! Keeps cloth from passing a sharp feature within a step: first moves that come too near are
//! changed along the normal, then moves that would still pass are shortened.
//!
//! The method is that of cloth against cloth (see `contact/response` and `contact/step_limit`),
//! with features that do not move. Impacts are found by additive continuous collision detection, so
//! no step jumps over a thin feature. Cloth that the body already passes through is not held back.
//!
//! Cost: one collision test per pair and round.

use super::{RidgePair, Ridges};
use rayon::prelude::*;
use toile_geometry::pair;
use toile_geometry::{Vec3, ccd::impact};

/// Rounds in which moves are changed along the normal, and in which they are shortened node by
/// node.
const ROUNDS: usize = 4;

/// Share of the time to impact that is used.
const SAFETY: f64 = 0.9;

/// Distance that a pair keeps after the change, as a share of the thickness, or of its present
/// distance where that is less.
const KEPT_DISTANCE: f64 = 0.5;

/// Least share of its present distance that a pair keeps. It is below 1 so that cloth reaches a
/// feature that is farther away than the thickness, at which contact begins.
const KEPT_SHARE: f64 = 0.15;

/// Below this distance the two sides of a feature cannot be told apart, m.
const TOUCHING: f64 = 1e-9;

impl Ridges {
    /// Takes from `moves` the share by which the closest points of colliding pairs come too near.
    /// Nodes that are `held` stay. Returns which moves have changed.
    pub(crate) fn respond(&self, x: &[Vec3], moves: &mut [Vec3], held: &[bool]) -> Vec<bool> {
        let mut pushed = vec![false; x.len()];
        for _ in 0..ROUNDS {
            let impacts = self.impacts(x, moves);
            if impacts.is_empty() {
                break;
            }
            for (pair, _) in impacts {
                self.push(&pair, x, moves, held, &mut pushed);
            }
        }
        pushed
    }

    fn push(&self, pair: &RidgePair, x: &[Vec3], moves: &mut [Vec3], held: &[bool], pushed: &mut [bool]) {
        let near = pair.near(&self.sharp, x);
        let normal = near.off / near.distance;
        let own = || (0..pair.count()).map(|k| (pair.nodes[k] as usize, near.weights[k]));
        let kept = (KEPT_DISTANCE * self.thickness.min(near.distance)).max(KEPT_SHARE * near.distance);
        let apart = own().map(|(i, w)| moves[i].dot(&normal) * w).sum::<f64>() + near.distance - kept;
        let sum = own().filter(|(i, _)| !held[*i]).map(|(_, w)| w * w).sum::<f64>();
        if apart >= 0.0 || sum == 0.0 {
            return;
        }
        for (i, w) in own().filter(|(i, w)| !held[*i] && *w != 0.0) {
            moves[i] -= normal * (apart * w / sum);
            pushed[i] = true;
        }
    }

    /// Shortens moves, node by node, so that no pair collides.
    pub(crate) fn limit_step(&self, x: &[Vec3], moves: &mut [Vec3]) {
        for _ in 0..ROUNDS {
            let hits = self.impacts(x, moves);
            if hits.is_empty() {
                return;
            }
            let mut share = vec![1.0f64; x.len()];
            for (pair, time) in hits {
                pair.nodes.iter().for_each(|&i| share[i as usize] = share[i as usize].min(SAFETY * time));
            }
            moves.iter_mut().zip(share).filter(|(_, s)| *s < 1.0).for_each(|(m, s)| *m *= s);
        }
        self.scale_step(x, moves);
    }

    /// Shortens all moves alike, so that no pair collides.
    pub(crate) fn scale_step(&self, x: &[Vec3], moves: &mut [Vec3]) {
        let least = self.impacts(x, moves).iter().map(|(_, t)| *t).fold(1.0, f64::min);
        if least < 1.0 {
            moves.iter_mut().for_each(|m| *m *= SAFETY * least);
        }
    }

    /// The pairs that would collide, and their times of impact.
    fn impacts(&self, x: &[Vec3], moves: &[Vec3]) -> Vec<(RidgePair, f64)> {
        let hit = |p: &RidgePair| {
            if self.is_free(p) {
                return None;
            }
            let (kind, from) = p.places(&self.sharp, x);
            if kind.closest(&from).distance < TOUCHING {
                return None;
            }
            let m = p.nodes.map(|i| moves[i as usize]);
            let ways = match kind {
                pair::Kind::EdgeEdge => [m[0], m[1], Vec3::zeros(), Vec3::zeros()],
                pair::Kind::VertexTriangle => [Vec3::zeros(), m[0], m[1], m[2]],
            };
            // The nodes only name the pair.
            impact(&pair::Pair { kind, nodes: [0; 4] }, &from, &ways).map(|t| (*p, t))
        };
        self.pairs.par_iter().with_min_len(256).filter_map(hit).collect()
    }

    /// Whether the body passes through the cloth of a pair: that cloth must pass features to get
    /// out.
    fn is_free(&self, pair: &RidgePair) -> bool {
        self.pierced.iter().any(|p| {
            let shared = p.nodes[..p.count()].iter().filter(|i| pair.nodes.contains(i)).count();
            shared >= 2 || p.feature == pair.feature && shared > 0
        })
    }
}

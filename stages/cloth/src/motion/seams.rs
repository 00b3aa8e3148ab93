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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const VERTICES: usize = 7;

    fn vectors() -> impl Strategy<Value = Vec<Vec3>> {
        let one = (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z));
        prop::collection::vec(one, VERTICES)
    }

    /// The inner product in the inertia.
    fn product(u: &[Vec3], v: &[Vec3], inverse: &[f64]) -> f64 {
        u.iter().zip(v).zip(inverse).map(|((u, v), w)| u.dot(v) / w).sum()
    }

    proptest! {
        #[test]
        fn holding_pairs_together_is_its_own_adjoint_in_the_inertia(
            pairs in prop::collection::vec((0..VERTICES as u32, 1..VERTICES as u32), 1..12),
            inverse in prop::collection::vec(0.1f64..10.0, VERTICES),
            (u, v) in (vectors(), vectors()),
        ) {
            let other = |(a, by): (u32, u32)| [a, (a + by) % VERTICES as u32];
            let seams = Seams::new(pairs.into_iter().map(other).collect(), SeamClosing::Speed);
            // Pairs that have met: the change is linear in the moves.
            let x = vec![Vec3::zeros(); VERTICES];
            let closed = |moves: &[Vec3]| {
                let mut moves = moves.to_vec();
                seams.close(&x, &mut moves, &inverse, 0.0);
                moves
            };
            let (one, other) = (product(&u, &closed(&v), &inverse), product(&closed(&u), &v, &inverse));
            prop_assert!((one - other).abs() < 1e-9 * product(&u, &u, &inverse).max(1.0), "{one} {other}");
        }

        #[test]
        fn momentum_is_kept_and_gaps_shrink_by_no_more_than_asked(
            (x, moves) in (vectors(), vectors()),
            inverse in prop::collection::vec(0.1f64..10.0, VERTICES),
        ) {
            let seams = Seams::new(vec![[0, 1], [2, 3]], SeamClosing::Speed);
            let mut changed = moves.clone();
            seams.close(&x, &mut changed, &inverse, 0.05);
            let momentum = |m: &[Vec3]| m.iter().zip(&inverse).map(|(m, w)| m / *w).sum::<Vec3>();
            prop_assert!((momentum(&changed) - momentum(&moves)).norm() < 1e-9);
            for [a, b] in [[0, 1], [2, 3]] {
                let (gap, after) = (x[b] - x[a], x[b] + changed[b] - x[a] - changed[a]);
                prop_assert!((gap.norm() - after.norm() - gap.norm().min(0.05)).abs() < 1e-9);
            }
        }
    }
}

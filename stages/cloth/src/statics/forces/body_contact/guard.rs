//! Shortens moves that lead into the body.
//!
//! Method: a move ends where a share of the offset is left between node and body. A node that is
//! stopped so at every step presses harder than its contact can carry, and would never come to
//! rest: then its contact becomes stiffer, or its offset grows. Cost: one query of the body per
//! node that may meet it.

use super::BodyContact;
use crate::contact::collision_surface::CollisionSurface;
use crate::statics::forces::distance_query::NUDGE;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Share of the offset that a move leaves between a node and the body.
const GUARD: f64 = 0.5;

/// Share of the offset below which a node that the guard stops counts as overloaded.
const OVERLOADED: f64 = 0.6;

/// Factor by which the contact of an overloaded node becomes stiffer.
const STIFFER: f64 = 4.0;

/// Greatest stiffness that it reaches, N/m: in half a millimetre it carries 50 kg.
const STIFFEST: f64 = 1e6;

impl BodyContact {
    /// Shortens moves that lead into the body, of the nodes that `asks` selects.
    pub(crate) fn clear(
        &mut self,
        body: &dyn CollisionSurface,
        is_sewing: bool,
        x: &[Vec3],
        moves: &mut [Vec3],
        asks: impl Fn(usize) -> bool,
    ) {
        let is_free = |i: usize| {
            self.distance_cache
                .get(i)
                .is_some_and(|n| n.distance - (x[i] - n.at).norm() - moves[i].norm() > self.guard(i))
        };
        let asked: Vec<usize> = (0..x.len()).filter(|&i| asks(i) && !is_free(i)).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let gaps: Vec<f64> = asked.iter().map(|&i| self.guard(i)).collect();
        let mut guarded: Vec<Vec3> = asked.iter().map(|&i| moves[i]).collect();
        body.guard(&points, &mut guarded, &gaps);
        for (&i, m) in asked.iter().zip(guarded) {
            if (moves[i] - m).norm() > NUDGE {
                let distance = self.distance_cache.get(i).map_or(0.0, |n| n.distance);
                match self.grows_offsets {
                    true => self.grow(i, distance),
                    // Stiffer contact would keep the seam open.
                    false if is_sewing => {}
                    false => self.mark_overloaded(i, distance),
                }
            }
            moves[i] = m;
        }
    }

    /// How near the body a move may lead node `i`, m.
    fn guard(&self, i: usize) -> f64 {
        GUARD * if self.grows_offsets { self.offset } else { self.offsets[i] }
    }

    /// Increases the offset of node `i` if it is overloaded: a stiff sheet presses harder on a few
    /// nodes than their contact can carry.
    fn grow(&mut self, i: usize, distance: f64) {
        if distance < OVERLOADED * self.offset {
            self.offsets[i] += GUARD * self.offset;
        }
    }

    /// Marks a node that the guard has stopped as overloaded if it lies too near.
    fn mark_overloaded(&mut self, i: usize, distance: f64) {
        if distance < OVERLOADED * self.offsets[i] {
            self.overloaded.push(i as u32);
        }
    }

    /// Makes contact stiffer at overloaded nodes, whose share of the sheet is too small for the
    /// load there.
    pub(super) fn stiffen_overloaded(&mut self) {
        self.overloaded.sort_unstable();
        self.overloaded.dedup();
        for i in self.overloaded.drain(..) {
            let stiffness = &mut self.stiffness[i as usize];
            *stiffness = (*stiffness * STIFFER).min(stiffness.max(STIFFEST));
        }
    }
}

//! Bending that starts far too stiff and is let go level by level, so that a garment picks its
//! folds for a reason.
//!
//! Cloth has many states of rest, and a solver that goes straight to one of them picks it by
//! chance: by the last digit of where the cloth began. A stiff sheet has few, mostly one. So the
//! garment is sewn, and first comes to rest, as if its bending length were half of its size; each
//! such state is brought so near rest that it forgets where it began. Stiffness then falls by steps
//! (graduated non-convexity, Blake and Zisserman 1987), on each level down to a bending length of
//! [`EDGES`] edges: a fold that a level would shape by its mesh is not formed on it, but on a finer
//! one, out of a state that is settled. The finest level ends with the fabric as it is.
//!
//! Friction remembers, too. Where a garment stays in its place without it, as on shoulders, it is
//! left out on the way and comes back at the end of each level. A skirt is held by it from the
//! place that it finds without; a cloth on a ball keeps it all the way (see `initial`).
//!
//! Cost: a few short runs on the coarse levels and four or five on the finest, of some twenty
//! factorizations each. Limit: where friction is kept, where the cloth began is felt a little.

use crate::fabric::Fabric;

/// The coarsest level has about this many nodes at most: a polygon of much fewer corners has seats
/// of its own on a body.
pub(crate) const COARSEST: usize = 700;

/// Bending length of the first state, as a share of the garment's size (the root of its area).
const FIRST_LENGTH: f64 = 0.5;

/// Factor at most between the stiffness of one run and the next.
const STRIDE: f64 = 8.0;

/// Edges of a level in the bending length that it lets go to. What bends over fewer bends as its
/// mesh lies: another mesh would pick other folds.
pub(crate) const EDGES: f64 = 8.0;

/// The same for cloth that is sewn through itself, whose patterns have tens of thousands of
/// vertices: coarser meshes do more of the way.
pub(crate) const EDGES_THROUGH: f64 = 2.0;

/// How stiff bending is on the way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BendingContinuation {
    /// Bending length of the limpest fabric, m.
    length: f64,
    /// Bending length of the first state, m.
    first: f64,
    /// Edges of a level in the bending length that it lets go to.
    edges: f64,
}

impl BendingContinuation {
    /// Of a garment of that size, the root of its area in metres, whose levels let go to a bending
    /// length of so many edges; nothing where cloth has no bending or no weight.
    pub(crate) fn of(cloths: &[&Fabric], gravity: f64, size: f64, edges: f64) -> Option<Self> {
        let of = |c: &&Fabric| (c.bending_warp.min(c.bending_weft) / (c.density * gravity)).cbrt();
        let length = cloths.iter().map(of).filter(|l| *l > 0.0).fold(f64::INFINITY, f64::min);
        // Bending so small that its stiffest state is no finite number counts as none: it would be
        // let go for ever.
        Some(Self { length, first: FIRST_LENGTH * size, edges })
            .filter(|g| g.first().is_finite() && length.is_finite())
    }

    /// The factor of the first state.
    pub(crate) fn first(&self) -> f64 {
        self.factor(self.first)
    }

    /// The least factor whose folds edges of that length carry, m: one of the same steps for every
    /// mesh, so that all of them let go through the same states.
    pub(crate) fn resolved(&self, edge: f64) -> f64 {
        let strides = (self.first() / self.factor(self.edges * edge)).log(STRIDE).floor();
        self.first() / STRIDE.powf(strides.max(0.0))
    }

    fn factor(&self, length: f64) -> f64 {
        (length / self.length).powi(3).max(1.0)
    }
}

/// The factors on the way from one to a lower one, without the first.
pub(crate) fn stages(from: f64, to: f64) -> Vec<f64> {
    let mut all = Vec::new();
    let mut at = from;
    while at > to {
        // Rounding must not leave a last stage that changes nothing.
        at = if at > 1.01 * STRIDE * to { at / STRIDE } else { to };
        all.push(at);
    }
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn stiffness_falls_by_strides_and_ends_where_it_shall() {
        assert_eq!(stages(512.0, 1.0), [64.0, 8.0, 1.0]);
        assert_eq!(stages(100.0, 3.0), [12.5, 3.0]);
        assert_eq!(stages(1.0, 1.0), [0.0; 0]);
        assert_eq!(stages(1.0, 4.0), [0.0; 0]);
    }

    #[test]
    fn every_mesh_lets_go_through_the_same_states() {
        let cloth = Fabric::isotropic(0.1, 1000.0, 0.0, 0.1 * 10.0 * 0.02_f64.powi(3));
        let continuation = BendingContinuation::of(&[&cloth], 10.0, 0.8, EDGES).unwrap();
        // Factors of 8000, 1000, 125, 15.6 and 1.95: of the last, edges of 3 mm carry the folds.
        assert!((continuation.resolved(0.01) - 125.0).abs() < 1e-9);
        assert!((continuation.resolved(0.003) - 1.953125).abs() < 1e-9);
        assert!((continuation.first() - 8000.0).abs() < 1e-6);
        // Of fewer edges in the bending length, coarser meshes do more of the way.
        let through = BendingContinuation::of(&[&cloth], 10.0, 0.8, EDGES_THROUGH).unwrap();
        assert!((through.resolved(0.01) - 1.953125).abs() < 1e-9);
    }

    #[test]
    fn without_bending_or_weight_there_is_nothing_to_grade() {
        let limp =
            Fabric { bending_warp: 0.0, bending_weft: 0.0, ..Fabric::isotropic(0.1, 1000.0, 0.0, 0.0) };
        assert!(BendingContinuation::of(&[&limp], 10.0, 1.0, EDGES).is_none());
        assert!(
            BendingContinuation::of(&[&Fabric::isotropic(0.1, 1000.0, 0.0, 1e-6)], 0.0, 1.0, EDGES).is_none()
        );
        assert!(
            BendingContinuation::of(&[&Fabric::isotropic(0.1, 1000.0, 0.0, 1e-320)], 10.0, 1.0, EDGES)
                .is_none()
        );
    }
}

//! Bending continuation: bending starts far too stiff and is lowered level by level to that of the
//! fabric.
//!
//! Cloth has many equilibria, and a solver that finds one of them directly chooses it by chance: by
//! rounding in the initial positions. A stiff sheet has few equilibria, mostly one. So the garment
//! is sewn and first brought to equilibrium as if its bending length were half of its size, so near
//! to rest that the state no longer depends on the start. Stiffness is then lowered by factors
//! (graduated non-convexity, Blake and Zisserman 1987), on each level down to a bending length of
//! [`EDGES`] edges. Finer folds, whose shape would depend on the mesh of the level, form on a finer
//! level. The finest level ends with the bending of the fabric.
//!
//! Friction keeps the history of the cloth, too. A garment that stays in place without friction, as
//! on shoulders, is solved without it, and friction is enabled at the end of each level. A skirt
//! gets friction where it comes to rest without; a cloth on a ball has it throughout (see
//! `drive/initial`).
//!
//! Cost: a few short runs on the coarse levels and four or five on the finest, of some twenty
//! factorizations each. Limit: where friction is kept, the result depends a little on the initial
//! positions.

use crate::fabric::Fabric;

/// Nodes of the coarsest level, at most about this many. A much coarser polygon has equilibria of
/// its own on a body.
pub(crate) const COARSEST: usize = 700;

/// Bending length of the first equilibrium, as a share of the garment's size (the root of its
/// area).
const FIRST_LENGTH: f64 = 0.5;

/// Greatest factor between the stiffness of one run and the next.
const STRIDE: f64 = 8.0;

/// Edges in the bending length to which a level lowers bending. Folds over fewer edges follow the
/// mesh: another mesh would have other folds.
pub(crate) const EDGES: f64 = 8.0;

/// The same for cloth that is sewn through itself. Such patterns have tens of thousands of
/// vertices, so more of the continuation is done on coarser levels.
pub(crate) const EDGES_THROUGH: f64 = 2.0;

/// The range of factors by which bending is stiffer than that of the fabric.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BendingContinuation {
    /// Bending length of the softest fabric, m.
    length: f64,
    /// Bending length of the first equilibrium, m.
    first: f64,
    /// Edges in the bending length to which a level lowers bending.
    edges: f64,
}

impl BendingContinuation {
    /// The continuation of a garment of that size, the root of its area in metres, whose levels
    /// lower bending to a bending length of so many edges. `None` where cloth has no bending or no
    /// weight.
    pub(crate) fn of(cloths: &[&Fabric], gravity: f64, size: f64, edges: f64) -> Option<Self> {
        let of = |c: &&Fabric| (c.bending_warp.min(c.bending_weft) / (c.density * gravity)).cbrt();
        let length = cloths.iter().map(of).filter(|l| *l > 0.0).fold(f64::INFINITY, f64::min);
        // Bending so small that the first factor is not finite counts as none: lowering it would
        // never end.
        Some(Self { length, first: FIRST_LENGTH * size, edges })
            .filter(|g| g.first().is_finite() && length.is_finite())
    }

    /// The factor of the first equilibrium.
    pub(crate) fn first(&self) -> f64 {
        self.factor(self.first)
    }

    /// The least factor whose folds edges of that length (m) resolve. It is one of the same
    /// sequence for every mesh, so that all meshes pass through the same states.
    pub(crate) fn resolved(&self, edge: f64) -> f64 {
        let strides = (self.first() / self.factor(self.edges * edge)).log(STRIDE).floor();
        self.first() / STRIDE.powf(strides.max(0.0))
    }

    fn factor(&self, length: f64) -> f64 {
        (length / self.length).powi(3).max(1.0)
    }
}

/// The factors of the runs from one factor to a lower one, without the first.
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
    fn every_mesh_passes_through_the_same_states() {
        let cloth = Fabric::isotropic(0.1, 1000.0, 0.0, 0.1 * 10.0 * 0.02_f64.powi(3));
        let continuation = BendingContinuation::of(&[&cloth], 10.0, 0.8, EDGES).unwrap();
        // Factors of 8000, 1000, 125, 15.6 and 1.95: edges of 3 mm resolve the folds at the last
        // one.
        assert!((continuation.resolved(0.01) - 125.0).abs() < 1e-9);
        assert!((continuation.resolved(0.003) - 1.953125).abs() < 1e-9);
        assert!((continuation.first() - 8000.0).abs() < 1e-6);
        // Of fewer edges in the bending length, coarser meshes do more of the way.
        let through = BendingContinuation::of(&[&cloth], 10.0, 0.8, EDGES_THROUGH).unwrap();
        assert!((through.resolved(0.01) - 1.953125).abs() < 1e-9);
    }

    #[test]
    fn without_bending_or_weight_there_is_no_continuation() {
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

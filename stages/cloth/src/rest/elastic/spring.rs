//! Elastic bands: a piece pulls its two nodes together once it is longer than at rest. A tension, never a push.

use super::super::pattern::{Slot, add_at};
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// One piece of a band.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Its ends.
    pub nodes: [u32; 2],
    /// Length unstretched, m.
    pub length: f64,
    /// N per unit of strain.
    pub stiffness: f64,
    pub(super) slot: Option<Slot>,
}

impl Spring {
    /// A piece of band between two nodes.
    #[must_use]
    pub fn new(nodes: [u32; 2], length: f64, stiffness: f64) -> Self {
        Self { nodes, length, stiffness, slot: None }
    }

    /// From the first node to the second, and the strain; 0 where it hangs loose.
    fn stretch(&self, x: &[Vec3]) -> (Vec3, f64, f64) {
        let d = x[self.nodes[1] as usize] - x[self.nodes[0] as usize];
        let reach = d.norm();
        (d, reach, (reach / self.length - 1.0).max(0.0))
    }

    pub(super) fn value(&self, x: &[Vec3]) -> f64 {
        let (_, _, strain) = self.stretch(x);
        0.5 * self.stiffness * self.length * strain * strain
    }

    pub(super) fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let (d, reach, strain) = self.stretch(x);
        if strain > 0.0 {
            let pull = d * (self.stiffness * strain / reach);
            gradient[self.nodes[0] as usize] -= pull;
            gradient[self.nodes[1] as usize] += pull;
        }
    }

    pub(super) fn add_matrix(&self, x: &[Vec3], values: &mut [Matrix3<f64>]) {
        let (d, reach, strain) = self.stretch(x);
        if strain > 0.0 {
            let along = d * d.transpose() / (reach * reach);
            let turn = self.stiffness * strain / reach;
            let block = along * (self.stiffness / self.length) + (Matrix3::identity() - along) * turn;
            values[self.nodes[0] as usize] += block;
            values[self.nodes[1] as usize] += block;
            if let Some(slot) = self.slot {
                add_at(values, slot, &-block);
            }
        }
    }
}

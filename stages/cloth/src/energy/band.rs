//! Elastic bands: a piece pulls its two nodes together once it is longer than at rest,
//! `E = k l e² / 2`, e its strain. A tension, never a push.

use super::{Assembled, Blocks, Element, Projection, Subset, Vec3, add_block_of};
use nalgebra::Matrix3;

/// One piece of a band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Its ends.
    pub nodes: [u32; 2],
    /// Length unstretched, m.
    pub length: f64,
    /// N per unit of strain.
    pub stiffness: f64,
}

/// All pieces on a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Bands(Vec<Band>);

impl Bands {
    /// The energy of these bands.
    #[must_use]
    pub fn new(bands: Vec<Band>) -> Assembled<2, Self> {
        Assembled(Self(bands))
    }
}

impl Band {
    /// From the first node to the second, its length, and the strain; 0 where it hangs loose.
    fn stretch(&self, x: &[Vec3; 2]) -> (Vec3, f64, f64) {
        let d = x[1] - x[0];
        let reach = d.norm();
        (d, reach, (reach / self.length - 1.0).max(0.0))
    }
}

impl Element<2> for Bands {
    type State = Blocks<2>;

    fn name(&self) -> &'static str {
        "elastic bands"
    }

    fn count(&self) -> usize {
        self.0.len()
    }

    fn nodes(&self, e: usize) -> [u32; 2] {
        self.0[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 2]) -> f64 {
        let (_, _, strain) = self.0[e].stretch(x);
        0.5 * self.0[e].stiffness * self.0[e].length * strain * strain
    }

    fn gradient(&self, e: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
        let (d, reach, strain) = self.0[e].stretch(x);
        let pull = if strain > 0.0 { d * (self.0[e].stiffness * strain / reach) } else { Vec3::zeros() };
        [-pull, pull]
    }

    /// The pull keeps it positive: there is no compression in a band.
    fn state(&self, e: usize, x: &[Vec3; 2], form: Projection) -> Blocks<2> {
        if form == Projection::Bound {
            let h = Matrix3::identity() * (self.0[e].stiffness / self.0[e].length);
            return [[h, -h], [-h, h]];
        }
        let (d, reach, strain) = self.0[e].stretch(x);
        if strain <= 0.0 {
            return [[Matrix3::zeros(); 2]; 2];
        }
        let along = d * d.transpose() / (reach * reach);
        let turn = self.0[e].stiffness * strain / reach;
        let block = along * (self.0[e].stiffness / self.0[e].length) + (Matrix3::identity() - along) * turn;
        [[block, -block], [-block, block]]
    }

    fn add_block(&self, _: usize, state: &Blocks<2>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let band = |&e: &usize| Band { nodes: subset.renumbered(self.0[e].nodes), ..self.0[e] };
        Self(elements.iter().map(band).collect())
    }
}

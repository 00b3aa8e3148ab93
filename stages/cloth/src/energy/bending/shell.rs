//! Discrete shells: every inner edge resists its own fold angle, `E = k psi² / 2`,
//! `psi = 2 tan(theta / 2)` (Grinspun, Hirani, Desbrun, Schroeder, 2003, with the measure of an
//! angle of Tamstorf and Grinspun, 2013).
//!
//! The measure is the angle for small folds and grows without bound towards a flat fold, so that a
//! sheet never folds through itself. The stiffness k is that of the quadratic hinges, calibrated
//! for the mesh (see `quadratic`); the free edges' correction goes with it. Cost: one angle per
//! edge. Limits: flat at rest; hinges each by itself are stiffer across the grain of a mesh than
//! along it, by up to 4 % on irregular meshes; a fold within 0.03 degrees of flat counts as that.

use super::quadratic::{Fold, folds};
use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3, add_block_of};
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// The sharpest fold that is told apart from a flat one, rad.
const SHARPEST: f64 = PI - 5e-4;

/// The hinges of a shell.
#[derive(Debug, Clone)]
pub struct DiscreteShell {
    folds: Vec<Fold>,
}

impl DiscreteShell {
    /// Flat at rest, calibrated for the mesh.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<4, Self> {
        Assembled(Self { folds: folds(cloth) })
    }
}

/// The measure of an angle and its first and second derivative.
fn measure(angle: f64) -> [f64; 3] {
    let tangent = (0.5 * angle.clamp(-SHARPEST, SHARPEST)).tan();
    [2.0 * tangent, 1.0 + tangent * tangent, tangent * (1.0 + tangent * tangent)]
}

impl Element<4> for DiscreteShell {
    type State = Blocks<4>;

    fn name(&self) -> &'static str {
        "discrete shell"
    }

    fn count(&self) -> usize {
        self.folds.len()
    }

    fn nodes(&self, e: usize) -> [u32; 4] {
        self.folds[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        let [psi, _, _] = measure(self.folds[e].angle(x).0);
        0.5 * self.folds[e].stiffness * psi * psi
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let (angle, by_node) = self.folds[e].angle(x);
        let [psi, slope, _] = measure(angle);
        by_node.map(|g| g * (self.folds[e].stiffness * psi * slope))
    }

    fn state(&self, e: usize, x: &[Vec3; 4], form: Projection) -> Blocks<4> {
        let (angle, g) = self.folds[e].angle(x);
        let ([psi, slope, bend], k) = (measure(angle), self.folds[e].stiffness);
        // Both parts of the second derivative by the angle itself are positive.
        let along = k * (slope * slope + psi * bend);
        let mut blocks: Blocks<4> =
            std::array::from_fn(|i| std::array::from_fn(|j| g[i] * g[j].transpose() * along));
        if form == Projection::Exact {
            self.folds[e].add_hessian_of_angle(x, k * psi * slope, &mut blocks);
        }
        blocks
    }

    fn add_block(&self, _: usize, state: &Blocks<4>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let fold = |&e: &usize| Fold { nodes: subset.renumbered(self.folds[e].nodes), ..self.folds[e] };
        Self { folds: elements.iter().map(fold).collect() }
    }

    fn scale_bending(&mut self, by: f64) {
        self.folds.iter_mut().for_each(|f| f.stiffness *= by);
    }
}

#[cfg(test)]
mod tests {
    use super::measure;

    #[test]
    fn the_measure_is_the_angle_at_first_and_rises_ever_steeper() {
        assert!((measure(1e-4)[0] - 1e-4).abs() < 1e-12);
        let [psi, slope, bend] = measure(2.0);
        assert!((psi - 2.0 * 1.0_f64.tan()).abs() < 1e-12);
        let step = 1e-6;
        assert!(((measure(2.0 + step)[0] - measure(2.0 - step)[0]) / (2.0 * step) - slope).abs() < 1e-8);
        assert!(((measure(2.0 + step)[1] - measure(2.0 - step)[1]) / (2.0 * step) - bend).abs() < 1e-7);
        assert!(measure(-4.0)[0].is_finite());
    }
}

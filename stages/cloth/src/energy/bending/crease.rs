//! Seams that are pressed to stay folded.
//!
//! A hinge of the quadratic isometric model (Bergou et al. 2006) measures the sum c of the two unit
//! directions that lead from its edge into its triangles; folded by an angle `a` that sum is `2
//! sin(a / 2)` long and lies along the mean n of their normals. At a crease the rest value of that
//! vector is `m n`, in plain cloth it is 0: `k / 2 |c - m n|²`, of which this energy is what it
//! adds to plain cloth. While the sheet hardly stretches, `c` lies along `n`, so that the turning
//! of `n` is left out of the derivatives, as it is for friction between yarns (see `hysteresis`);
//! the second derivative stays that of plain cloth. Cost: a few operations per hinge of the seam.

use super::quadratic::{Fold, folds};
use crate::energy::{Assembled, Cloth, Element, Projection, Subset, Vec3};
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// The rest state of one hinge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crease {
    fold: Fold,
    /// The length of its sum of directions at rest, positive where the outsides come together.
    rest: f64,
}

/// Hinges with a folded rest state.
#[derive(Debug, Clone, PartialEq)]
pub struct Creases(Vec<Crease>);

impl Creases {
    /// The numbers of hinges among the sheet's inner edges, and the angle between the outsides of
    /// each hinge's sheets at rest, radians.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>, pressed: &[(usize, f64)]) -> Assembled<4, Self> {
        let folds = if pressed.is_empty() { Vec::new() } else { folds(cloth) };
        let crease = |(hinge, angle): &(usize, f64)| {
            let fold = folds.get(*hinge).copied()?;
            Some(Crease { fold, rest: 2.0 * (0.5 * (PI - angle)).sin() })
        };
        Assembled(Self(pressed.iter().filter_map(crease).collect()))
    }
}

/// The mean direction of the two triangles' unit normals; zero where they have none.
fn mean_normal([a, b, c, d]: &[Vec3; 4]) -> Vec3 {
    let unit = |v: Vec3| v.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    unit(unit((b - a).cross(&(c - a))) + unit((d - a).cross(&(b - a))))
}

impl Element<4> for Creases {
    type State = ();

    fn name(&self) -> &'static str {
        "creases"
    }

    fn count(&self) -> usize {
        self.0.len()
    }

    fn nodes(&self, e: usize) -> [u32; 4] {
        self.0[e].fold.nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 4]) -> f64 {
        let Crease { fold, rest } = &self.0[e];
        fold.stiffness * rest * (0.5 * rest - fold.curvature(x).dot(&mean_normal(x)))
    }

    fn gradient(&self, e: usize, x: &[Vec3; 4]) -> [Vec3; 4] {
        let Crease { fold, rest } = &self.0[e];
        let moment = mean_normal(x) * (fold.stiffness * rest);
        fold.weights.map(|w| -(moment * w))
    }

    fn state(&self, _: usize, _: &[Vec3; 4], _: Projection) {}

    fn add_block(&self, _: usize, (): &(), _: usize, _: usize, _: &mut Matrix3<f64>) {}

    fn has_matrix(&self) -> bool {
        false
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let crease = |&e: &usize| {
            let fold = &self.0[e].fold;
            Crease { fold: Fold { nodes: subset.renumbered(fold.nodes), ..*fold }, ..self.0[e] }
        };
        Self(elements.iter().map(crease).collect())
    }

    fn scale_bending(&mut self, by: f64) {
        self.0.iter_mut().for_each(|c| c.fold.stiffness *= by);
    }
}

#[cfg(test)]
mod tests;

//! Seams that are pressed to stay folded.
//!
//! A hinge of the quadratic isometric model (Bergou et al. 2006) measures the sum of the two unit directions that lead from its edge into
//! its triangles; folded by an angle `a` that sum is `2 sin(a / 2)` long and lies along the mean of their normals. A crease wants that
//! vector where plain cloth wants none: `k / 2 |c - m n|^2`. While the sheet hardly stretches, `c` lies along `n`, so that the turning of
//! `n` is left out of the derivatives, as it is for friction between yarns (see `hold`); the second derivative stays that of the plain
//! hinge. Cost: a few operations a hinge of the seam.

use super::{Elastic, Hinge};
use nalgebra::Vector3;
use std::f64::consts::PI;

type Vec3 = Vector3<f64>;

/// What one hinge wants to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crease {
    /// Which hinge.
    hinge: usize,
    /// The length of its sum of directions at rest, positive where the outsides come together.
    rest: f64,
}

impl Crease {
    /// The same among these hinges, whose numbers ascend; nothing where its own is not among them.
    pub(super) fn renumbered(&self, hinges: &[usize]) -> Option<Self> {
        hinges.binary_search(&self.hinge).ok().map(|hinge| Crease { hinge, ..*self })
    }
}

impl Hinge {
    /// The mean direction of its two triangles' unit normals; zero where they have none.
    fn mean_normal(&self, x: &[Vec3]) -> Vec3 {
        let [a, b, c, d] = self.nodes.map(|i| x[i as usize]);
        let unit = |v: Vec3| v.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        unit(unit((b - a).cross(&(c - a))) + unit((d - a).cross(&(b - a))))
    }
}

impl Elastic {
    /// The same with creases: the numbers of hinges, and the angle between the outsides of each hinge's sheets at rest, radians.
    #[must_use]
    pub fn creased(self, folds: Vec<(usize, f64)>) -> Self {
        let crease = |(hinge, angle): (usize, f64)| Crease { hinge, rest: 2.0 * (0.5 * (PI - angle)).sin() };
        let known = folds.into_iter().filter(|(hinge, _)| *hinge < self.hinges.len());
        Self { creases: known.map(crease).collect(), ..self }
    }

    /// What creases add to the bending energy, J.
    pub(super) fn value_of_creases(&self, x: &[Vec3]) -> f64 {
        let value = |c: &Crease| {
            let h = &self.hinges[c.hinge];
            h.stiffness * c.rest * (0.5 * c.rest - h.curvature(x).dot(&h.mean_normal(x)))
        };
        self.creases.iter().map(value).sum()
    }

    /// Adds its derivative, N.
    pub(super) fn add_gradient_of_creases(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        for c in &self.creases {
            let h = &self.hinges[c.hinge];
            let moment = h.mean_normal(x) * (h.stiffness * c.rest);
            h.nodes.iter().zip(&h.weights).for_each(|(&i, w)| gradient[i as usize] -= moment * *w);
        }
    }
}

#[cfg(test)]
mod tests;

//! What keeps cloth at its height while it is sewn.
//!
//! Cloth without weight and friction that seams draw around a body slides along it to where the body is thinner: off the
//! shoulders, down to the waist. A spring for each node, along the vertical alone, holds it near the height at which it was placed.

use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// Springs along one direction to where the nodes started.
#[derive(Debug, Clone)]
pub struct HeightSprings {
    /// The direction, of length 1.
    pub up: Vec3,
    /// How far up each node started, m.
    pub heights: Vec<f64>,
    /// Stiffness for each kilogram of a node, N/m/kg.
    pub stiffness: f64,
}

impl HeightSprings {
    fn way(&self, x: &[Vec3], i: usize) -> f64 {
        self.up.dot(&x[i]) - self.heights[i]
    }

    /// Energy at `x`, J.
    pub(super) fn value(&self, x: &[Vec3], masses: &[f64]) -> f64 {
        let one = |(i, m): (usize, &f64)| 0.5 * self.stiffness * m * self.way(x, i).powi(2);
        masses.iter().enumerate().map(one).sum()
    }

    pub(super) fn add_gradient(&self, x: &[Vec3], masses: &[f64], g: &mut [Vec3]) {
        for (i, m) in masses.iter().enumerate() {
            g[i] += self.up * (self.stiffness * m * self.way(x, i));
        }
    }

    pub(super) fn add_matrix(&self, masses: &[f64], values: &mut [Matrix3<f64>]) {
        let along = self.up * self.up.transpose();
        for (v, m) in values.iter_mut().zip(masses) {
            *v += along * (self.stiffness * m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_is_drawn_back_to_its_height_and_may_move_aside() {
        let springs = HeightSprings { up: Vec3::y(), heights: vec![1.0, 2.0], stiffness: 30.0 };
        let (x, masses) = ([Vec3::new(5.0, 1.1, -3.0), Vec3::new(0.0, 2.0, 0.0)], [0.2, 0.1]);
        assert!((springs.value(&x, &masses) - 0.5 * 30.0 * 0.2 * 0.01).abs() < 1e-12);
        let mut g = [Vec3::zeros(); 2];
        springs.add_gradient(&x, &masses, &mut g);
        assert!((g[0] - Vec3::new(0.0, 0.6, 0.0)).norm() < 1e-12 && g[1].norm() == 0.0);
        let mut values = [Matrix3::zeros(); 2];
        springs.add_matrix(&masses, &mut values);
        assert!((values[0][(1, 1)] - 6.0).abs() < 1e-12 && values[0][(0, 0)] == 0.0);
    }
}

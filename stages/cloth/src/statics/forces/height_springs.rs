//! Height springs: hold each panel at its mean height while its seams close.
//!
//! Cloth without weight and friction that is sewn around a body slides along it to where the body
//! is thinner: off the shoulders, down to the waist. A vertical spring for each panel holds the
//! mean height of its nodes near the initial one, and leaves its edges free to move. Cost: O(n).

use crate::energy::Subset;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// Springs along one direction between the mean position of groups of nodes and the initial one.
#[derive(Debug, Clone)]
pub struct HeightSprings {
    /// The unit direction.
    pub up: Vec3,
    /// Initial height of each node, m.
    pub heights: Vec<f64>,
    /// The group of each node.
    pub groups: Vec<u32>,
    /// Stiffness per kilogram, N/m/kg.
    pub stiffness: f64,
}

impl HeightSprings {
    /// Mean rise of each group, m, and its mass, kg.
    fn ways(&self, x: &[Vec3], masses: &[f64]) -> Vec<(f64, f64)> {
        let count = self.groups.iter().max().map_or(0, |g| *g as usize + 1);
        let mut ways = vec![(0.0, 0.0); count];
        for (((g, h), p), m) in self.groups.iter().zip(&self.heights).zip(x).zip(masses) {
            let (sum, mass) = &mut ways[*g as usize];
            *sum += m * (self.up.dot(p) - h);
            *mass += m;
        }
        ways.iter().map(|(sum, mass)| (sum / mass.max(f64::MIN_POSITIVE), *mass)).collect()
    }

    /// Energy at `x`, J.
    pub(crate) fn value(&self, x: &[Vec3], masses: &[f64]) -> f64 {
        self.ways(x, masses).iter().map(|(way, mass)| 0.5 * self.stiffness * mass * way * way).sum()
    }

    pub(crate) fn add_gradient(&self, x: &[Vec3], masses: &[f64], g: &mut [Vec3]) {
        let ways = self.ways(x, masses);
        for (i, (m, group)) in masses.iter().zip(&self.groups).enumerate() {
            g[i] += self.up * (self.stiffness * m * ways[*group as usize].0);
        }
    }

    /// Adds an upper bound of the matrix, which would couple all nodes of a group: that of one
    /// spring per node.
    pub(crate) fn add_matrix(&self, masses: &[f64], values: &mut [Matrix3<f64>]) {
        let along = self.up * self.up.transpose();
        for (v, m) in values.iter_mut().zip(masses) {
            *v += along * (self.stiffness * m);
        }
    }

    /// The springs of a subset of the nodes.
    pub(crate) fn restrict(&self, cut: &Subset) -> Self {
        Self { heights: cut.pick(&self.heights), groups: cut.pick(&self.groups), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_is_drawn_back_to_its_height_and_its_nodes_may_move_in_it() {
        let springs = HeightSprings {
            up: Vec3::y(),
            heights: vec![1.0, 2.0, 2.0],
            groups: vec![0, 1, 1],
            stiffness: 30.0,
        };
        let x = [Vec3::new(5.0, 1.1, -3.0), Vec3::new(0.0, 2.3, 0.0), Vec3::new(0.0, 1.4, 0.0)];
        // The second group has not moved in the mean: 0.2 kg up by 0.3 m, 0.1 kg down by 0.6 m.
        let masses = [0.2, 0.2, 0.1];
        assert!((springs.value(&x, &masses) - 0.5 * 30.0 * 0.2 * 0.01).abs() < 1e-12);
        let mut g = [Vec3::zeros(); 3];
        springs.add_gradient(&x, &masses, &mut g);
        assert!(
            (g[0] - Vec3::new(0.0, 0.6, 0.0)).norm() < 1e-12 && g[1].norm() < 1e-12 && g[2].norm() < 1e-12
        );
    }

    #[test]
    fn the_gradient_is_the_energy_s_and_the_matrix_bounds_its_change() {
        let springs = HeightSprings {
            up: Vec3::y(),
            heights: vec![0.0, 0.5, 1.0],
            groups: vec![0, 0, 0],
            stiffness: 7.0,
        };
        let (x, masses) = ([Vec3::y() * 0.2, Vec3::y() * 0.9, Vec3::y() * 1.3], [0.1, 0.3, 0.2]);
        let mut g = [Vec3::zeros(); 3];
        springs.add_gradient(&x, &masses, &mut g);
        let mut values = [Matrix3::zeros(); 3];
        springs.add_matrix(&masses, &mut values);
        for i in 0..3 {
            let by = 1e-3;
            let mut moved = x;
            moved[i].y += by;
            let rise = springs.value(&moved, &masses) - springs.value(&x, &masses);
            assert!(rise >= g[i].y * by);
            assert!(rise <= g[i].y * by + 0.5 * values[i][(1, 1)] * by * by + 1e-15);
        }
    }
}

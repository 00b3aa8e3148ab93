//! Loads that act on the nodes by their masses: weight, pushes and height springs. Cost: O(n).

use crate::energy::Subset;
use crate::statics::forces::height_springs::HeightSprings;
use nalgebra::{Matrix3, Vector3};

type Vec3 = Vector3<f64>;

/// The masses of the nodes and what pulls on them.
#[derive(Debug, Clone)]
pub struct Loads {
    /// Mass of each node, kg.
    pub masses: Vec<f64>,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// Forces on the nodes besides their weight, N; empty where there are none.
    pub push: Vec<Vec3>,
    /// Springs that hold the nodes at their initial height, if any.
    pub height_springs: Option<HeightSprings>,
}

impl Loads {
    /// Weight alone.
    #[must_use]
    pub fn new(masses: Vec<f64>, gravity: Vec3) -> Self {
        Self { masses, gravity, push: vec![], height_springs: None }
    }

    /// Energy of the weight, J.
    #[must_use]
    pub fn weight(&self, x: &[Vec3]) -> f64 {
        x.iter().zip(&self.masses).map(|(p, m)| -m * self.gravity.dot(p)).sum()
    }

    /// Energy of pushes and height springs, J.
    #[must_use]
    pub fn pushed(&self, x: &[Vec3]) -> f64 {
        let held = self.height_springs.as_ref().map_or(0.0, |h| h.value(x, &self.masses));
        held - self.push.iter().zip(x).map(|(p, x)| p.dot(x)).sum::<f64>()
    }

    /// The derivative of both, N.
    #[must_use]
    pub fn gradient(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut g: Vec<Vec3> = self.masses.iter().map(|m| -self.gravity * *m).collect();
        g.iter_mut().zip(&self.push).for_each(|(g, p)| *g -= p);
        self.height_springs.iter().for_each(|h| h.add_gradient(x, &self.masses, &mut g));
        g
    }

    /// Adds the matrix, N/m.
    pub fn add_matrix(&self, values: &mut [Matrix3<f64>]) {
        self.height_springs.iter().for_each(|h| h.add_matrix(&self.masses, values));
    }

    /// The loads on a subset of the nodes.
    pub(crate) fn restrict(&self, cut: &Subset) -> Self {
        Self {
            masses: cut.pick(&self.masses),
            gravity: self.gravity,
            push: cut.pick(&self.push),
            height_springs: self.height_springs.as_ref().map(|h| h.restrict(cut)),
        }
    }
}

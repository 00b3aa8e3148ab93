//! A uniform field: E = -sum m g.x. Linear, so its Hessian is zero.

use super::potential::Energy;
use toile_geometry::Vec3;

/// Weight of lumped masses.
#[derive(Debug, Clone)]
pub struct Gravity {
    /// kg per vertex.
    pub masses: Vec<f64>,
    /// m/s².
    pub acceleration: Vec3,
}

impl Energy for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        -x.iter().zip(&self.masses).map(|(p, m)| m * self.acceleration.dot(p)).sum::<f64>()
    }

    fn add_gradient(&self, _: &[Vec3], gradient: &mut [Vec3]) {
        for (g, m) in gradient.iter_mut().zip(&self.masses) {
            *g -= self.acceleration * *m;
        }
    }
}

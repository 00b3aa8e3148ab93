//! Dead loads: forces that keep size and direction. E = -sum f.x.

use super::potential::Energy;
use toile_geometry::Vec3;

/// A fixed force on every vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct DeadLoad {
    /// N per vertex.
    pub forces: Vec<Vec3>,
}

impl Energy for DeadLoad {
    fn name(&self) -> &'static str {
        "dead load"
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        -x.iter().zip(&self.forces).map(|(p, f)| f.dot(p)).sum::<f64>()
    }

    fn add_gradient(&self, _: &[Vec3], gradient: &mut [Vec3]) {
        gradient.iter_mut().zip(&self.forces).for_each(|(g, f)| *g -= f);
    }
}

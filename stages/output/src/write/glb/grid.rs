//! Positions as whole numbers (`KHR_mesh_quantization`, Khronos, 2020).
//!
//! All meshes stand on one grid of 65,535 places to a side, so that seams stay closed; the nodes
//! bring it back to metres.

use toile_core::artifact::{Model, Point3};

/// The largest number to each side of the centre: -1 and 1 are exact.
const STEPS: f64 = i16::MAX as f64;

/// A cube around a model.
pub(super) struct ModelCube {
    /// Metres.
    pub(super) centre: [f64; 3],
    /// Half of its side, metres; never 0.
    pub(super) half: f64,
}

impl ModelCube {
    /// The smallest cube around all vertices.
    pub(super) fn around(model: &Model) -> ModelCube {
        let mut points = model.meshes.iter().flat_map(|m| &m.positions);
        let first = points.next().copied().unwrap_or_else(Point3::origin);
        let (lo, hi) = points.fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
        let half = (hi - lo).max() / 2.0;
        // What the file names is a 32-bit float: the cube must hold all vertices with it.
        let half = if half > 0.0 { f64::from((half * (1.0 + 1e-6)) as f32) } else { 1.0 };
        let centre = [0, 1, 2].map(|k| f64::from(((lo[k] + hi[k]) / 2.0) as f32));
        ModelCube { centre, half }
    }

    /// The nearest place of the grid.
    pub(super) fn place(&self, p: &Point3) -> [i16; 3] {
        [0, 1, 2].map(|k| ((p[k] - self.centre[k]) / self.half * STEPS).round().clamp(-STEPS, STEPS) as i16)
    }
}

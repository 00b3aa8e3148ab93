//! A calm head: cranium, face, jaw and chin; the nose and the hollows of the eyes are
//! [bumps](crate::limbs::relief).

use crate::measures::bounds::Bounds;
use crate::shape::FigureShape;
use crate::skin::field::{Ellipsoid, smooth_min};
use toile_core::artifact::{Point3, Vector3};

/// The head above the chin.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    parts: [(Ellipsoid, f64); 4],
    bounds: Bounds,
}

impl Head {
    pub(crate) fn new(shape: &FigureShape) -> Self {
        let (h, jaw) = (shape.head, shape.form.jaw);
        let part = |down: f64, z: f64, half: [f64; 3], joint: f64| {
            let half_axes = Vector3::from(half) * h;
            (Ellipsoid { centre: shape.of_head(0.0, down, z), half_axes }, joint * h)
        };
        let parts = [
            part(0.094, -0.006, [0.074, 0.094, 0.092], 0.0),
            part(0.128, 0.025, [0.061, 0.088, 0.064], 0.040),
            part(0.170, 0.030, [0.050 * jaw, 0.046, 0.050], 0.035),
            part(0.200, 0.058, [0.027 * jaw, 0.024, 0.026], 0.040),
        ];
        let corner = |e: &Ellipsoid| [e.centre - e.half_axes, e.centre + e.half_axes];
        let bounds = Bounds::of(parts.iter().flat_map(|(e, _)| corner(e)));
        Head { parts, bounds }
    }

    /// The box around it.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The value.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let join = |v: f64, (e, k): &(Ellipsoid, f64)| smooth_min(v, e.value(p), *k);
        self.parts[1..].iter().fold(self.parts[0].0.value(p), join)
    }
}

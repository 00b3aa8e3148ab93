//! Lofts: stacks of sections along a straight line, the middle of each free to lie beside it.
//!
//! A section is half an ellipse in front and another behind, joined at the sides. Trunk, neck,
//! arms, legs and feet are lofts.
//!
//! Cost: one look-up of the sections and some tens of products. Limit: the value is the distance to
//! first order only.

use crate::limbs::profile::LengthProfile;
use crate::measures::bounds::Bounds;
use crate::skin::field::smooth_max;
use toile_core::artifact::{Point3, Vector3};

/// A section: the middle's place to the side and in front of the line, half the width, depth in
/// front and behind.
pub(crate) type LoftSection = [f64; 5];

/// A stack of sections.
#[derive(Debug, Clone)]
pub(crate) struct Loft {
    origin: Point3,
    side: Vector3,
    along: Vector3,
    front: Vector3,
    sections: LengthProfile<5>,
    span: [f64; 2],
    rounding: f64,
    boxy: bool,
    bounds: Bounds,
}

impl Loft {
    /// Of sections along `along` from `origin`, whose fronts look to `front` as far as that is
    /// square to the line; the ends of `span` are rounded over `rounding`, metres.
    pub(crate) fn new(
        [origin, end]: [Point3; 2],
        front: Vector3,
        knots: &[(f64, LoftSection)],
        span: [f64; 2],
        rounding: f64,
    ) -> Self {
        let along = (end - origin).normalize();
        let front = (front - along * front.dot(&along)).normalize();
        let side = along.cross(&front);
        let sections = LengthProfile::new(knots);
        let corners = sections.samples().flat_map(|(s, [u, w, half, ahead, behind])| {
            let middle = origin + along * s + side * *u + front * *w;
            [side * *half, side * -half, front * *ahead, front * -behind].map(|r| middle + r)
        });
        let bounds = Bounds::of(corners);
        Loft { origin, side, along, front, sections, span, rounding, boxy: false, bounds }
    }

    /// With sections between ellipse and rectangle: superellipses of exponent 2.25 (Gielis, 2003).
    pub(crate) fn boxy(self) -> Self {
        Loft { boxy: true, ..self }
    }

    /// The box around the sections.
    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The value: the section's implicit form divided by its slope.
    pub(crate) fn value(&self, p: Point3) -> f64 {
        let v = p - self.origin;
        let s = v.dot(&self.along);
        let [u, w, half, ahead, behind] = self.sections.at(s.clamp(self.span[0], self.span[1]));
        let (x, z) = (v.dot(&self.side) - u, v.dot(&self.front) - w);
        let depth = if z > 0.0 { ahead } else { behind };
        let across = if self.boxy { superellipse(x, z, half, depth) } else { ellipse(x, z, half, depth) };
        smooth_max(across, (self.span[0] - s).max(s - self.span[1]), self.rounding)
    }
}

/// The root of the sum of squares. Sections are metres wide: nothing overflows, and `hypot` takes
/// three times as long.
fn length(x: f64, z: f64) -> f64 {
    (x * x + z * z).sqrt()
}

fn ellipse(x: f64, z: f64, a: f64, b: f64) -> f64 {
    let (u, w) = (x / a, z / b);
    let r = length(u, w);
    if r > 0.3 { (r - 1.0) * r / length(u / a, w / b) } else { (r - 1.0) * a.min(b) }
}

fn superellipse(x: f64, z: f64, a: f64, b: f64) -> f64 {
    let (u, w) = (x.abs() / a, z.abs() / b);
    // Roots are cheaper than powers.
    let power = |t: f64| t * t * t.sqrt().sqrt();
    let r = (power(u) + power(w)).powf(1.0 / 2.25);
    if r > 0.3 {
        let falling = |t: f64| (t / r) * (t / r).sqrt().sqrt();
        (r - 1.0) / length(falling(u) / a, falling(w) / b)
    } else {
        (r - 1.0) * a.min(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lofts_vanish_on_their_skin() {
        let section = [0.0, 0.0, 0.2, 0.1, 0.15];
        let ends = [Point3::origin(), Point3::new(0.0, 1.0, 0.0)];
        let knots = [(0.0, section), (0.5, section), (1.0, section)];
        let loft = Loft::new(ends, Vector3::z(), &knots, [0.0, 1.0], 0.05);
        for p in [[0.2, 0.5, 0.0], [0.0, 0.5, 0.1], [0.0, 0.5, -0.15]] {
            assert!(loft.value(Point3::from(p)).abs() < 1e-12);
            assert!(loft.clone().boxy().value(Point3::from(p)).abs() < 1e-12);
        }
    }
}

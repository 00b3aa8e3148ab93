//! An arc of a circle.

use super::direction;
use kurbo::{Affine, CubicBez, Point, Vec2};

/// An arc of a circle, from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftArc {
    /// The centre of its circle.
    pub centre: Point,
    /// The radius, above 0.
    pub radius: f64,
    /// The angle of its start as seen from the centre, degrees.
    pub start: f64,
    /// The angle that it turns by, degrees; below 0 where it turns to the right.
    pub sweep: f64,
}

impl DraftArc {
    /// Its point at a share of it.
    pub fn at(&self, t: f64) -> Point {
        self.centre + direction(self.start + t * self.sweep) * self.radius
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.radius * self.sweep.to_radians().abs()
    }

    /// The share of it at an angle as seen from the centre; none where the angle is not on it.
    pub(super) fn share(&self, degrees: f64) -> Option<f64> {
        let ahead = match self.sweep < 0.0 {
            true => (self.start - degrees).rem_euclid(360.0),
            false => (degrees - self.start).rem_euclid(360.0),
        };
        let share = ahead / self.sweep.abs();
        match share {
            s if s <= 1.0 + 1e-9 => Some(s.min(1.0)),
            // Just before its start.
            _ if 360.0 - ahead <= 1e-9 * self.sweep.abs().max(1.0) => Some(0.0),
            _ => None,
        }
    }

    /// The share at which it is nearest to a point.
    pub(super) fn nearest(&self, p: Point) -> f64 {
        let from_centre = p - self.centre;
        let share = self.share(super::angle(from_centre));
        share.unwrap_or_else(|| {
            let far = |t: f64| (self.at(t) - p).hypot2();
            if far(0.0) <= far(1.0) { 0.0 } else { 1.0 }
        })
    }

    /// The part of it between two shares.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        DraftArc { start: self.start + from * self.sweep, sweep: (to - from) * self.sweep, ..*self }
    }

    /// Moved by what keeps lengths: turned, mirrored, shifted.
    pub(super) fn moved(&self, by: Affine) -> Self {
        let centre = by * self.centre;
        let start = super::angle(by * self.at(0.0) - centre);
        let sweep = if by.determinant() < 0.0 { -self.sweep } else { self.sweep };
        DraftArc { centre, start, sweep, ..*self }
    }

    /// The direction in which it runs at a share.
    pub(super) fn tangent(&self, t: f64) -> Vec2 {
        direction(self.start + t * self.sweep + 90.0 * self.sweep.signum())
    }

    /// Cubics near to it.
    pub(super) fn cubics(&self, tolerance: f64) -> Vec<CubicBez> {
        let radii = Vec2::new(self.radius, self.radius);
        let arc = kurbo::Arc::new(self.centre, radii, self.start.to_radians(), self.sweep.to_radians(), 0.0);
        let (mut from, mut out) = (self.at(0.0), Vec::new());
        arc.to_cubic_beziers(tolerance, |a, b, to| {
            out.push(CubicBez::new(from, a, b, to));
            from = to;
        });
        out
    }
}

//! Curves of the plane, y up, in the unit of the pattern: what tools cut, cross and move.
//!
//! Method: a curve is a chain of cubic Bézier curves and arcs of circles, kept as they are drawn;
//! an arc of an ellipse is turned into cubics that miss it by less than [`ELLIPSE`]. Lengths are
//! those of `kurbo`, to [`ACCURACY`]; on a curve that is larger than 100 m both errors grow with
//! it.

mod arc;
mod curve;
mod meet;
mod stroke;
#[cfg(test)]
mod tests;

pub use arc::DraftArc;
pub(crate) use curve::DraftCurve;
pub(crate) use meet::{circles, crossings, line_and_circle, lines, on_ray};
pub use stroke::DraftStroke;

use kurbo::{Point, Vec2};

/// The greatest error of a length, in the pattern's unit.
const ACCURACY: f64 = 1e-9;
/// The greatest error as a share of the size of a curve, where that is more: a number has 16
/// digits, and a search to more of them does not end.
const SHARE: f64 = 1e-13;
/// Cubics of an ellipse miss it by no more, in the pattern's unit.
const ELLIPSE: f64 = 1e-6;

/// The greatest error on a curve of a size, both in the pattern's unit.
fn accuracy(otherwise: f64, size: f64) -> f64 {
    otherwise.max(SHARE * size)
}

/// The direction of an angle, degrees, counter-clockwise from the x axis.
pub(crate) fn direction(degrees: f64) -> Vec2 {
    // Right angles are exact, so that what is drawn along the axes lies on them.
    let (quarters, rest) = ((degrees / 90.0).floor(), degrees.rem_euclid(90.0));
    if rest == 0.0 {
        return match quarters.rem_euclid(4.0) as u8 {
            0 => Vec2::new(1.0, 0.0),
            1 => Vec2::new(0.0, 1.0),
            2 => Vec2::new(-1.0, 0.0),
            _ => Vec2::new(0.0, -1.0),
        };
    }
    Vec2::from_angle(degrees.to_radians())
}

/// The angle of a direction, degrees from 0 to 360.
pub(crate) fn angle(of: Vec2) -> f64 {
    of.atan2().to_degrees().rem_euclid(360.0)
}

/// The foot of a point on the line through two others; none where those are one.
pub(crate) fn foot(a: Point, b: Point, p: Point) -> Option<Point> {
    let d = b - a;
    let square = d.hypot2();
    (square > 0.0).then(|| a + d * ((p - a).dot(d) / square))
}

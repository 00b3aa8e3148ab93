//! A corner's place to a fraction of a pixel.
//!
//! Around a corner every slope is at right angles to the line from the corner (Förstner and Gülch,
//! 1987): the place that fits all slopes in a window best, weighted by a Gaussian, a few times.

use crate::pixels::colour;
use image::RgbImage;
use nalgebra::{Matrix2, Point2, Vector2};

/// The place near `start`, by a window of half a side of `reach` pixels; `start` where it moves out
/// of it.
pub(crate) fn refine(photo: &RgbImage, start: Point2<f64>, reach: f64) -> Point2<f64> {
    let mut at = start;
    for _ in 0..6 {
        let Some(next) = step(photo, at, reach) else { return start };
        let moved = (next - at).norm();
        at = next;
        if (at - start).norm() > reach {
            return start;
        }
        if moved < 1e-3 {
            break;
        }
    }
    at
}

fn step(photo: &RgbImage, at: Point2<f64>, reach: f64) -> Option<Point2<f64>> {
    let half = reach.round() as i32;
    let grey = |x: f64, y: f64| f64::from(colour(photo, x, y).iter().sum::<f32>()) / 3.0;
    let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
    for j in -half..=half {
        for i in -half..=half {
            let d = Vector2::new(f64::from(i), f64::from(j));
            let (x, y) = (at.x + d.x, at.y + d.y);
            let slope =
                Vector2::new(grey(x + 0.7, y) - grey(x - 0.7, y), grey(x, y + 0.7) - grey(x, y - 0.7));
            let weight = (-2.0 * d.norm_squared() / (reach * reach)).exp();
            let outer = slope * slope.transpose() * weight;
            a += outer;
            b += outer * d;
        }
    }
    let shift = a.try_inverse()? * b;
    let next = at + shift;
    next.iter().all(|v| v.is_finite()).then_some(next)
}

//! Lines drawn over a picture: open seams, landmarks.

use super::camera::{Camera, Projected};
use image::{Rgb, RgbImage};
use toile_core::artifact::Point3;

/// A straight line in space, drawn over everything.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverlayLine {
    /// Its ends, metres. Equal ends give a dot.
    pub ends: [Point3; 2],
    /// Its colour, sRGB.
    pub colour: [u8; 3],
    /// Its width, px.
    pub width: f64,
}

/// Draws lines with soft edges.
pub(super) fn draw(picture: &mut RgbImage, camera: &Camera, lines: &[OverlayLine]) {
    for line in lines {
        let ends = line.ends.each_ref().map(|p| camera.project(p));
        let reach = super::cover::REACH_PX;
        if ends.iter().all(|e| e.x.abs() < reach && e.y.abs() < reach) {
            stroke(picture, ends, line);
        }
    }
}

fn stroke(picture: &mut RgbImage, [a, b]: [Projected; 2], line: &OverlayLine) {
    let half = line.width / 2.0 + 0.5;
    let limit = |v: f64, n: u32| v.clamp(0.0, f64::from(n)) as u32;
    let (w, h) = picture.dimensions();
    let columns = limit(a.x.min(b.x) - half, w)..limit(a.x.max(b.x) + half + 1.0, w);
    let rows = limit(a.y.min(b.y) - half, h)..limit(a.y.max(b.y) + half + 1.0, h);
    for y in rows {
        for x in columns.clone() {
            let distance = to_segment([f64::from(x) + 0.5, f64::from(y) + 0.5], [a.x, a.y], [b.x, b.y]);
            let share = (half - distance).clamp(0.0, 1.0) as f32;
            blend(picture.get_pixel_mut(x, y), line.colour, share);
        }
    }
}

/// Distance of a point to a segment.
fn to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length2 = d[0] * d[0] + d[1] * d[1];
    let t = if length2 > 0.0 { ((e[0] * d[0] + e[1] * d[1]) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (e[0] - t * d[0]).hypot(e[1] - t * d[1])
}

fn blend(pixel: &mut Rgb<u8>, colour: [u8; 3], share: f32) {
    for (v, c) in pixel.0.iter_mut().zip(colour) {
        *v = (f32::from(*v) + (f32::from(c) - f32::from(*v)) * share).round() as u8;
    }
}

//! How far a mask is its own mirror image, about an axis of any tilt.
//!
//! Axes through the centre of area, and a little beside it, are tried all around, then between the
//! best; the score is the intersection over union of the mask and its mirror image.
//!
//! Cost: some 100 axes by 3,000 pixels, 3 ms.

use std::f64::consts::PI;

/// The axis about which a mask is most like its mirror image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Symmetry {
    /// Intersection over union of the mask and its mirror image, 0 to 1.
    pub share: f64,
    /// A point of the axis.
    point: [f64; 2],
    /// Its direction, radians.
    angle: f64,
}

impl Symmetry {
    /// The mirror image of a place.
    pub(super) fn mirror(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = (2.0 * self.angle).sin_cos();
        let (u, v) = (x - self.point[0], y - self.point[1]);
        [self.point[0] + cos * u + sin * v, self.point[1] + sin * u - cos * v]
    }
}

impl Symmetry {
    /// How far a place lies to one side of the axis, pixels; less than 0 on the other.
    pub(super) fn side(&self, [x, y]: [f64; 2]) -> f64 {
        let (sin, cos) = self.angle.sin_cos();
        cos * (y - self.point[1]) - sin * (x - self.point[0])
    }
}

/// Pixels that are looked at for each axis, about.
const SAMPLES: usize = 3000;
/// Axes that are tried all around.
const AXES: usize = 60;

/// The best axis of a mask of `w` pixels across; `None` for an empty mask.
pub(super) fn symmetry(mask: &[bool], w: usize) -> Option<Symmetry> {
    let on: Vec<[f64; 2]> =
        (0..mask.len()).filter(|&i| mask[i]).map(|i| [(i % w) as f64, (i / w) as f64]).collect();
    if on.is_empty() {
        return None;
    }
    let count = on.len() as f64;
    let centre = [0, 1].map(|k| on.iter().map(|p| p[k]).sum::<f64>() / count);
    let stride = (on.len() / SAMPLES).max(1);
    let h = mask.len() / w.max(1);
    let score = |s: Symmetry| {
        let sampled = on.iter().step_by(stride);
        let total = sampled.len() as f64;
        let both = sampled.filter(|p| at(mask, w, h, s.mirror(**p))).count() as f64;
        Symmetry { share: both / (2.0 * total - both), ..s }
    };
    let try_at = |angle: f64, shift: f64| {
        let (sin, cos) = angle.sin_cos();
        score(Symmetry { share: 0.0, point: [centre[0] - sin * shift, centre[1] + cos * shift], angle })
    };
    let best = |found: Vec<Symmetry>| found.into_iter().reduce(|a, b| if b.share > a.share { b } else { a });
    let coarse = best((0..AXES).map(|k| try_at(PI * k as f64 / AXES as f64, 0.0)).collect())?;
    let reach = 0.01 * count.sqrt();
    let near = (-3..=3).flat_map(|k| (-3..=3).map(move |s| (f64::from(k), f64::from(s))));
    best(near.map(|(k, s)| try_at(coarse.angle + k * PI / AXES as f64 / 3.0, s * reach)).collect())
}

/// Whether the mask contains a place; it contains none beyond the frame.
pub(super) fn at(mask: &[bool], w: usize, h: usize, [x, y]: [f64; 2]) -> bool {
    let (x, y) = (x.round(), y.round());
    x >= 0.0 && y >= 0.0 && x < w as f64 && y < h as f64 && mask[y as usize * w + x as usize]
}

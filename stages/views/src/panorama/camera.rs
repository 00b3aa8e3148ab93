//! A photo unrolled from the cylinder around its camera.
//!
//! A ray at the angle `t` around the axis and of height `v` on the cylinder of radius `f` meets the
//! photo at `x = f tan t`, `y = v / cos t` from its centre (Szeliski, Shum 1997). On the unrolled
//! cylinder a turn of the camera is a shift. Limit: no distortion of the lens, no roll.

use crate::picture::GreyPlane;
use rayon::prelude::*;

/// A camera without distortion.
#[derive(Debug, Clone, Copy)]
pub(super) struct CylinderCamera {
    /// Radius of the cylinder, px.
    pub(super) focal: f64,
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// The pixel that it looks at.
    pub(super) centre: [f64; 2],
}

impl CylinderCamera {
    /// Of a photo that was not cut.
    pub(super) fn new(focal: f64, [width, height]: [u32; 2]) -> CylinderCamera {
        let size = [width as usize, height as usize];
        CylinderCamera { focal, size, centre: size.map(|n| (n as f64 - 1.0) / 2.0) }
    }

    /// The camera of the photo halved so often.
    pub(super) fn halved(self, times: u32) -> CylinderCamera {
        let factor = f64::from(2u32.pow(times));
        let size = (0..times).fold(self.size, |size, _| size.map(|n| (n / 2).max(1)));
        CylinderCamera {
            focal: self.focal / factor,
            size,
            centre: self.centre.map(|c| (c + 0.5) / factor - 0.5),
        }
    }

    /// How far the photo reaches to either side of its centre on the cylinder, px.
    pub(super) fn reach(&self) -> f64 {
        self.focal * (self.size[0] as f64 / 2.0).atan2(self.focal)
    }

    /// Where a place of the cylinder, px from the centre, is in the photo; none behind the camera.
    pub(super) fn seen(&self, u: f64, v: f64) -> Option<[f64; 2]> {
        let (sin, cos) = (u / self.focal).sin_cos();
        let before = (u / self.focal).abs() < 1.57 && cos > 1e-3;
        before.then(|| [self.centre[0] + self.focal * sin / cos, self.centre[1] + v / cos])
    }

    /// The photo unrolled; its centre is the middle pixel across.
    pub(super) fn unrolled(&self, photo: &GreyPlane) -> GreyPlane {
        let half = self.reach().floor().max(0.0) as usize;
        let (width, height) = (2 * half + 1, photo.height);
        let row = |y: usize| {
            (0..width).map(move |x| {
                let [x, y] = self.seen(x as f64 - half as f64, y as f64 - self.centre[1])?;
                photo.at(x, y)
            })
        };
        let pixels: Vec<Option<f32>> = (0..height).into_par_iter().flat_map_iter(row).collect();
        GreyPlane {
            width,
            height,
            levels: pixels.iter().map(|p| p.unwrap_or(0.0)).collect(),
            seen: pixels.iter().map(Option::is_some).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn the_middle_keeps_its_scale_and_the_sides_are_narrower() {
        let camera = CylinderCamera::new(500.0, [401, 301]);
        assert_eq!(camera.seen(0.0, -40.0), Some([200.0, 110.0]));
        assert!((camera.reach() - 500.0 * (200.5f64 / 500.0).atan()).abs() < 1e-12);
        let [x, y] = camera.seen(camera.reach(), 100.0).unwrap();
        assert!((x - 400.5).abs() < 1e-9 && y > 250.0);
        assert_eq!(camera.seen(800.0, 0.0), None, "behind the camera");
        let plane =
            GreyPlane { width: 401, height: 301, levels: vec![7.0; 401 * 301], seen: vec![true; 401 * 301] };
        let unrolled = camera.unrolled(&plane);
        assert_eq!((unrolled.width, unrolled.height), (381, 301));
        assert!(unrolled.seen[150 * 381 + 190] && !unrolled.seen[0], "corners of the cylinder are not seen");
    }
}

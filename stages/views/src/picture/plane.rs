//! A grey picture as numbers, with what of it is seen.

use toile_core::{Context, StageError};

/// Brightness of each pixel, row by row; where nothing is seen its value is not used.
///
/// Pixel centres lie at whole coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct GreyPlane {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Grey levels.
    pub levels: Vec<f32>,
    /// Whether a pixel is seen.
    pub seen: Vec<bool>,
}

impl GreyPlane {
    /// Brightness (ITU-R BT.601) of a photo.
    ///
    /// # Errors
    /// When the run has been stopped.
    pub fn of(photo: &image::RgbImage, cx: &Context) -> Result<GreyPlane, StageError> {
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let mut levels = Vec::with_capacity(width * height);
        for row in photo.rows() {
            cx.check()?;
            levels.extend(row.map(|p| brightness(p.0.map(f32::from))));
        }
        Ok(GreyPlane { width, height, seen: vec![true; levels.len()], levels })
    }

    /// Half as wide and high: means of two by two pixels of which all are seen.
    pub fn half(&self) -> GreyPlane {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let (mut levels, mut seen) = (Vec::with_capacity(width * height), Vec::with_capacity(width * height));
        for y in 0..height {
            for x in 0..width {
                let at = |i: usize, j: usize| {
                    (2 * y + j).min(self.height - 1) * self.width + (2 * x + i).min(self.width - 1)
                };
                let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
                levels.push(four.iter().map(|k| self.levels[*k]).sum::<f32>() / 4.0);
                seen.push(four.iter().all(|k| self.seen[*k]));
            }
        }
        GreyPlane { width, height, levels, seen }
    }

    /// The level at a place between pixels, bilinear; none where one of the four is not seen.
    pub fn at(&self, x: f64, y: f64) -> Option<f32> {
        let (fx, fy) = (x.floor(), y.floor());
        let inside = fx >= 0.0 && fy >= 0.0 && fx < self.width as f64 && fy < self.height as f64;
        if !inside {
            return None;
        }
        let (u, v) = ((x - fx) as f32, (y - fy) as f32);
        let (x, y) = (fx as usize, fy as usize);
        let right = if u > 0.0 { x + 1 } else { x };
        let below = if v > 0.0 { y + 1 } else { y };
        if right >= self.width || below >= self.height {
            return None;
        }
        let level =
            |x: usize, y: usize| self.seen[y * self.width + x].then(|| self.levels[y * self.width + x]);
        let (a, b, c, d) = (level(x, y)?, level(right, y)?, level(x, below)?, level(right, below)?);
        let (top, bottom) = (a + (b - a) * u, c + (d - c) * u);
        Some(top + (bottom - top) * v)
    }
}

/// Brightness of a colour (ITU-R BT.601).
pub(crate) fn brightness([r, g, b]: [f32; 3]) -> f32 {
    0.299 * r + 0.587 * g + 0.114 * b
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use image::{Rgb, RgbImage};

    fn of(photo: &RgbImage) -> GreyPlane {
        GreyPlane::of(photo, &Context::quiet()).unwrap()
    }

    #[test]
    fn levels_between_pixels_are_bilinear_and_none_beyond_the_border() {
        let plane = of(&RgbImage::from_fn(4, 3, |x, y| Rgb([(10 * x + 40 * y) as u8; 3])));
        assert!((plane.at(1.5, 0.25).unwrap() - 25.0).abs() < 1e-3);
        assert!((plane.at(3.0, 2.0).unwrap() - 110.0).abs() < 1e-3);
        assert_eq!([plane.at(3.1, 0.0), plane.at(-0.1, 0.0), plane.at(f64::NAN, 0.0)], [None; 3]);
        let half = plane.half();
        assert_eq!((half.width, half.height), (2, 1));
        assert!((half.levels[0] - 25.0).abs() < 1e-3);
    }

    #[test]
    fn what_is_not_seen_gives_no_level() {
        let mut plane = of(&RgbImage::new(4, 4));
        plane.seen[5] = false;
        assert_eq!(plane.at(0.5, 0.5), None);
        assert_eq!(plane.at(2.5, 2.5), Some(0.0));
        assert_eq!(plane.half().seen, [false, true, true, true]);
    }
}

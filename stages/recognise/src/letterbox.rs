//! The letterbox: how a photo lies in the square that the network takes.
//!
//! The photo is scaled until its longer side fills the square, its shorter side to whole pixels and
//! at least one. It is centred on black, half a pixel further left or up where it cannot be in the
//! middle. Training does the same to its photos.
//!
//! Places in a photo are those of the project: whole numbers are centres of pixels, x to the right,
//! y down. Places among cells likewise.
//!
//! Cost: that of [`crate::area`]. Limits: of a photo with one side far longer than the other,
//! little is left along the shorter one.

use crate::area::resized;
use crate::network::{SIDE, STRIDE};
use image::RgbImage;
use nalgebra::Point2;

/// How a photo lies in the network's square. `x` and `y` are alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Letterbox {
    x: CellSpan,
    y: CellSpan,
}

/// How one side of a photo lies in the square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CellSpan {
    /// Pixels of the photo.
    photo: u32,
    /// Pixels of the square on which they lie.
    shown: u32,
    /// Pixels of the square before them.
    before: u32,
}

impl Letterbox {
    /// That of a photo of so many pixels; none where it has none.
    pub(crate) fn of((width, height): (u32, u32)) -> Option<Letterbox> {
        let longer = width.max(height);
        let of = |photo| CellSpan::of(photo, longer);
        (width > 0 && height > 0).then(|| Letterbox { x: of(width), y: of(height) })
    }

    /// The photo as the network takes it: red, green, blue, each row by row, 0 to 1.
    pub(crate) fn levels(&self, photo: &RgbImage) -> Vec<f32> {
        let shown = resized(photo, (self.x.shown, self.y.shown));
        let mut levels = vec![0.0; 3 * SIDE * SIDE];
        for (y, row) in shown.chunks(self.x.shown as usize).enumerate() {
            for (x, pixel) in row.iter().enumerate() {
                let at = (y + self.y.before as usize) * SIDE + x + self.x.before as usize;
                for (c, level) in pixel.iter().enumerate() {
                    levels[c * SIDE * SIDE + at] = level / 255.0;
                }
            }
        }
        levels
    }

    /// How its columns lie.
    pub(crate) fn x(&self) -> CellSpan {
        self.x
    }

    /// How its rows lie.
    pub(crate) fn y(&self) -> CellSpan {
        self.y
    }

    /// The place in the photo of a place among cells; within the photo.
    pub(crate) fn place(&self, (u, v): (f64, f64)) -> Point2<f64> {
        Point2::new(self.x.place(u), self.y.place(v))
    }
}

impl CellSpan {
    fn of(photo: u32, longer: u32) -> CellSpan {
        let shown = (f64::from(photo) * SIDE as f64 / f64::from(longer)).round_ties_even().max(1.0) as u32;
        CellSpan { photo, shown, before: (SIDE as u32 - shown) / 2 }
    }

    /// Pixels of the photo along it.
    pub(crate) fn photo(&self) -> u32 {
        self.photo
    }

    /// The place among cells of a place in the photo.
    pub(crate) fn cell(&self, at: f64) -> f64 {
        let shown = (at + 0.5) * f64::from(self.shown) / f64::from(self.photo);
        (f64::from(self.before) + shown) / STRIDE as f64 - 0.5
    }

    /// The place in the photo of a place among cells; within the photo.
    fn place(&self, cell: f64) -> f64 {
        let shown = (cell + 0.5) * STRIDE as f64 - f64::from(self.before);
        let at = shown * f64::from(self.photo) / f64::from(self.shown) - 0.5;
        at.clamp(-0.5, f64::from(self.photo) - 0.5)
    }

    /// The first and the last cell whose centre lies on the photo; of a photo that is narrower than
    /// a cell, the cell in which its middle lies.
    pub(crate) fn cells(&self) -> (usize, usize) {
        let (before, end, stride) = (self.before as usize, (self.before + self.shown) as usize, STRIDE);
        let first = (2 * before + stride).div_ceil(2 * stride) - 1;
        let beyond = (2 * end + stride) / (2 * stride);
        match first < beyond {
            true => (first, beyond - 1),
            false => [(before + end) / (2 * stride); 2].into(),
        }
    }
}

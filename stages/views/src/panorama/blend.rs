//! The panorama's pixels: each photo seen from the cylinder, blended where photos overlap.
//!
//! Each pixel is taken from the photos themselves in one step (cubic), so nothing is sampled twice.
//! *Feather*: a photo's weight falls from one in its middle to zero at its border (Szeliski 1996).
//! *Multiband*: each place belongs to the photo that weighs most; coarse detail is blended over
//! a wide seam, fine detail over a narrow one (Burt, Adelson 1983), so that nothing is double.

use super::exposure::Overlap;
use super::layout::Layout;
use super::multiband;
use crate::picture::{brightness, cubic, psnr_of};
use image::RgbImage;
use rayon::prelude::*;
use std::borrow::Cow;
use std::f64::consts::TAU;
use toile_core::prelude::*;

/// How overlapping photos become one picture.
#[choice]
#[derive(Copy, Eq)]
pub enum Blend {
    /// Wide, soft seams: least noise; what moved between the photos is double.
    Feather,
    /// Coarse detail over wide seams, fine detail over narrow ones: nothing is double.
    Multiband,
}

/// The panorama as numbers.
pub(super) struct Canvas<'a> {
    photos: &'a [Cow<'a, RgbImage>],
    gains: &'a [f64],
    layout: &'a Layout,
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// The cylinder's place of its first pixel.
    first: [f64; 2],
    /// Cylinder pixels a pixel: a ring has a whole number of pixels around.
    scale: f64,
}

/// A finished picture.
#[derive(Debug)]
pub(super) struct Blended {
    pub(super) pixels: RgbImage,
    pub(super) seen: Vec<bool>,
    /// Of photos against each other where two or more show a place, dB; none where none do.
    pub(super) overlap_psnr: Option<f64>,
}

/// Pixels between those by which exposures are compared.
const COARSE: usize = 8;

/// A photo at a place: its colour, and what it weighs.
type Sample = ([f32; 3], f32);

impl<'a> Canvas<'a> {
    /// Room for all photos.
    pub(super) fn new(photos: &'a [Cow<'a, RgbImage>], gains: &'a [f64], layout: &'a Layout) -> Self {
        let half = layout.camera.size[1] as f64 / 2.0;
        let downs = || layout.places.iter().map(|p| p[1]);
        let top = downs().fold(f64::INFINITY, f64::min) - half;
        let bottom = downs().fold(f64::NEG_INFINITY, f64::max) + half;
        let [left, right] = layout.sides();
        let whole = TAU * layout.camera.focal;
        let (width, scale, left) = match layout.closed {
            // The first photo is in the middle.
            true => (whole.round().max(1.0), whole / whole.round().max(1.0), -whole / 2.0),
            false => ((right - left).floor().max(1.0), 1.0, left + 0.5),
        };
        let height = ((bottom - top) / scale).floor().max(1.0);
        let size = [width as usize, height as usize];
        Canvas { photos, gains, layout, size, first: [left, top + 0.5], scale }
    }

    /// Photo `k` at a pixel; none where it does not show it.
    pub(super) fn sample(&self, k: usize, x: usize, y: usize) -> Option<Sample> {
        let (place, photo) = (self.layout.places.get(k)?, self.photos.get(k)?);
        let camera = &self.layout.camera;
        let u = self.across(k, x)?;
        if u.abs() > camera.reach() {
            return None;
        }
        let [px, py] = camera.seen(u, self.first[1] + self.scale * y as f64 - place[1])?;
        let colour = cubic(photo, px, py)?;
        let hat = |p: f64, n: usize| (1.0 - ((2.0 * p + 1.0) / n as f64 - 1.0).abs()).max(0.0);
        let weight = hat(px, camera.size[0]) * hat(py, camera.size[1]) + 1e-6;
        let gain = *self.gains.get(k)? as f32;
        Some((colour.map(|c| c * gain), weight as f32))
    }

    /// Photos that may show a column.
    fn of_column(&self, x: usize) -> Vec<usize> {
        let shows = |k: &usize| self.across(*k, x).is_some_and(|u| u.abs() <= self.layout.camera.reach());
        (0..self.photos()).filter(shows).collect()
    }

    /// The columns of a photo from its left side to its right one, around a ring.
    pub(super) fn columns_of(&self, k: usize) -> Vec<usize> {
        let Some(place) = self.layout.places.get(k) else { return Vec::new() };
        let middle = ((place[0] - self.first[0]) / self.scale).round() as i64;
        let (width, half) = (self.size[0] as i64, (self.layout.camera.reach() / self.scale) as i64 + 1);
        let (from, to) = match self.layout.closed {
            true => (middle - half.min(width / 2), middle + half.min((width - 1) / 2)),
            false => ((middle - half).max(0), (middle + half).min(width - 1)),
        };
        (from..=to).map(|x| x.rem_euclid(width) as usize).collect()
    }

    /// How many photos there are.
    pub(super) fn photos(&self) -> usize {
        self.layout.places.len()
    }

    /// How far a column is from the centre of a photo, px of the cylinder.
    fn across(&self, k: usize, x: usize) -> Option<f64> {
        let u = self.first[0] + self.scale * x as f64 - self.layout.places.get(k)?[0];
        let whole = TAU * self.layout.camera.focal;
        Some(if self.layout.closed { u - whole * (u / whole).round() } else { u })
    }

    /// Mean levels of neighbours over what both show, on every eighth pixel.
    pub(super) fn overlaps(&self) -> Vec<Overlap> {
        let photos = self.photos();
        let pairs = if self.layout.closed { photos } else { photos.saturating_sub(1) };
        (0..pairs).into_par_iter().filter_map(|k| self.overlap([k, (k + 1) % photos])).collect()
    }

    fn overlap(&self, pair: [usize; 2]) -> Option<Overlap> {
        let (mut sums, mut n) = ([0f64; 2], 0.0);
        let columns: Vec<usize> = self.columns_of(pair[0]).into_iter().step_by(COARSE).collect();
        for y in (0..self.size[1]).step_by(COARSE) {
            for x in &columns {
                let (Some(a), Some(b)) = (self.sample(pair[0], *x, y), self.sample(pair[1], *x, y)) else {
                    continue;
                };
                sums = [sums[0] + f64::from(brightness(a.0)), sums[1] + f64::from(brightness(b.0))];
                n += 1.0;
            }
        }
        let weight = n / (self.size[0] * self.size[1]).max(1) as f64;
        (n > 0.0).then(|| Overlap { photos: pair, means: sums.map(|s| s / n), weight })
    }

    /// The picture.
    ///
    /// # Errors
    /// When the run has been stopped.
    pub(super) fn blended(&self, blend: Blend, cx: &Context) -> Result<Blended, StageError> {
        let columns: Vec<Vec<usize>> = (0..self.size[0]).map(|x| self.of_column(x)).collect();
        let rows = |y: usize| {
            cx.check()?;
            Ok(self.row(y, &columns))
        };
        let rows: Vec<Result<Row, StageError>> = (0..self.size[1]).into_par_iter().map(rows).collect();
        let rows: Vec<Row> = rows.into_iter().collect::<Result<_, _>>()?;
        let (square, n) = rows.iter().fold((0.0, 0), |(s, n), r| (s + r.square, n + r.compared));
        let seen: Vec<bool> = rows.iter().flat_map(|r| r.colours.iter().map(Option::is_some)).collect();
        let colours = match blend {
            Blend::Feather => {
                rows.iter().flat_map(|r| r.colours.iter().map(|c| c.unwrap_or_default())).collect()
            }
            Blend::Multiband => {
                let owner: Vec<Option<usize>> = rows.iter().flat_map(|r| r.owner.iter().copied()).collect();
                multiband::blended(self, &owner, cx)?
            }
        };
        Ok(Blended {
            pixels: picture(&colours, self.size),
            seen,
            overlap_psnr: (n > 0).then(|| psnr_of(square / n as f64)),
        })
    }

    fn row(&self, y: usize, columns: &[Vec<usize>]) -> Row {
        let mut row = Row { colours: Vec::new(), owner: Vec::new(), square: 0.0, compared: 0 };
        for (x, photos) in columns.iter().enumerate() {
            let (mut sum, mut total) = ([0f32; 3], 0f32);
            let (mut most, mut second): (Option<(usize, Sample)>, Option<Sample>) = (None, None);
            for k in photos {
                let Some(sample) = self.sample(*k, x, y) else { continue };
                (0..3).for_each(|c| sum[c] += sample.0[c] * sample.1);
                total += sample.1;
                if most.is_none_or(|m| sample.1 > m.1.1) {
                    second = most.map(|m| m.1);
                    most = Some((*k, sample));
                } else if second.is_none_or(|s| sample.1 > s.1) {
                    second = Some(sample);
                }
            }
            if let (Some((_, a)), Some(b)) = (most, second) {
                row.square += (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>() / 3.0;
                row.compared += 1;
            }
            row.colours.push((total > 0.0).then(|| sum.map(|s| s / total)));
            row.owner.push(most.map(|m| m.0));
        }
        row
    }
}

/// A row of the panorama.
struct Row {
    colours: Vec<Option<[f32; 3]>>,
    /// The photo that weighs most.
    owner: Vec<Option<usize>>,
    /// Sum of squared differences of the two photos that weigh most, and over how many pixels.
    square: f64,
    compared: usize,
}

fn picture(colours: &[[f32; 3]], [w, h]: [usize; 2]) -> RgbImage {
    let mut picture = RgbImage::new(w as u32, h as u32);
    for (pixel, colour) in picture.pixels_mut().zip(colours) {
        pixel.0 = colour.map(|c| (c + 0.5).clamp(0.0, 255.0) as u8);
    }
    picture
}

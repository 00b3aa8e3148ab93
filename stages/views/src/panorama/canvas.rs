//! The panorama's pixels and what each photo shows of them.
//!
//! Each pixel is taken from the photos themselves in one step (cubic), so nothing is sampled twice.

use super::exposure::PhotoOverlap;
use super::layout::PanoramaLayout;
use crate::picture::{brightness, cubic};
use image::RgbImage;
use rayon::prelude::*;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Pixels between those by which exposures are compared.
const COARSE: usize = 8;

/// A photo at a place: its colour, and what it weighs.
pub(super) type PhotoSample = ([f32; 3], f32);

/// The panorama as numbers.
pub(super) struct PanoramaCanvas<'a> {
    photos: &'a [Cow<'a, RgbImage>],
    gains: &'a [f64],
    layout: &'a PanoramaLayout,
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// The cylinder's place of its first pixel.
    first: [f64; 2],
    /// Cylinder pixels a pixel: a ring has a whole number of pixels around.
    scale: f64,
}

impl<'a> PanoramaCanvas<'a> {
    /// Room for all photos.
    pub(super) fn new(photos: &'a [Cow<'a, RgbImage>], gains: &'a [f64], layout: &'a PanoramaLayout) -> Self {
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
        PanoramaCanvas { photos, gains, layout, size, first: [left, top + 0.5], scale }
    }

    /// Photo `k` at a pixel; none where it does not show it.
    pub(super) fn sample(&self, k: usize, x: usize, y: usize) -> Option<PhotoSample> {
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
    pub(super) fn of_column(&self, x: usize) -> Vec<usize> {
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
    pub(super) fn overlaps(&self) -> Vec<PhotoOverlap> {
        let photos = self.photos();
        let pairs = if self.layout.closed { photos } else { photos.saturating_sub(1) };
        (0..pairs).into_par_iter().filter_map(|k| self.overlap([k, (k + 1) % photos])).collect()
    }

    fn overlap(&self, pair: [usize; 2]) -> Option<PhotoOverlap> {
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
        (n > 0.0).then(|| PhotoOverlap { photos: pair, means: sums.map(|s| s / n), weight })
    }
}

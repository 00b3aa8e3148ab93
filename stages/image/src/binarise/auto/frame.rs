//! A hem a few pixels inside the frame: the strip of ground between them is ground.
//!
//! Methods that work at a reduced size bridge a strip of a pixel or two. Where a mask reaches the
//! frame, the mean colours of the pixels along it, layer by layer inwards, show whether there is a
//! step; if what lies outside of the step is like the ground along the same side, the garment ends
//! at the step.
//!
//! Cost: a look at some layers of pixels along the frame.

use super::super::small::{Lab, lab};
use image::GrayImage;
use toile_core::prelude::*;

/// The widest strip, as a share of the shorter side.
const WIDEST: f64 = 0.02;
/// The widest strip is at least so many pixels.
const LEAST: u32 = 4;
/// A step of colour that no shade makes within a few pixels, Lab units.
const STEP: f64 = 10.0;

/// Takes strips of ground along the frame off a mask of the photo's size.
pub(super) fn without_strips(mask: &mut GrayImage, photo: &Photo) {
    for side in 0..4 {
        if let Some((along, depth)) = strip(mask, photo, side) {
            for (a, d) in along.iter().flat_map(|&a| (0..depth).map(move |d| (a, d))) {
                let (x, y) = place(mask.dimensions(), side, a, d);
                mask.get_pixel_mut(x, y).0[0] = 0;
            }
        }
    }
}

/// The pixel `along` a side and `deep` below it. Sides: top, right, bottom, left.
fn place((w, h): (u32, u32), side: usize, along: u32, deep: u32) -> (u32, u32) {
    match side {
        0 => (along, deep),
        1 => (w - 1 - deep, along),
        2 => (along, h - 1 - deep),
        _ => (deep, along),
    }
}

/// Where along a side the mask meets the frame without reaching it, and how many layers of ground
/// lie between.
fn strip(mask: &GrayImage, photo: &Photo, side: usize) -> Option<(Vec<u32>, u32)> {
    let (w, h) = mask.dimensions();
    let (length, across) = if side.is_multiple_of(2) { (w, h) } else { (h, w) };
    let widest = ((WIDEST * f64::from(w.min(h))) as u32).max(LEAST);
    if across < 4 * widest {
        return None;
    }
    let on = |a: u32, d: u32| {
        let (x, y) = place((w, h), side, a, d);
        mask.get_pixel(x, y).0[0] != 0
    };
    let (meets, beside): (Vec<u32>, Vec<u32>) = (0..length).partition(|&a| on(a, 0));
    let mean = |places: &[u32], layers: std::ops::Range<u32>| {
        let pixels = || layers.clone().flat_map(|d| places.iter().map(move |&a| (a, d)));
        let colour = |(a, d)| {
            let (x, y) = place((w, h), side, a, d);
            lab(photo.pixels.get_pixel(x, y).0.map(f64::from))
        };
        pixels().map(colour).sum::<Lab>() / (pixels().count() as f64).max(1.0)
    };
    if meets.is_empty() || beside.is_empty() {
        return None;
    }
    let step = |t: u32| (mean(&meets, 0..t), mean(&meets, t + 1..t + 1 + widest));
    let steps = (1..=widest).map(|t| (t, step(t)));
    let size = |(outer, inner): (Lab, Lab)| (outer - inner).norm();
    let (t, (outer, inner)) = steps.max_by(|a, b| size(a.1).total_cmp(&size(b.1)))?;
    let ground = mean(&beside, 0..t);
    (size((outer, inner)) >= STEP && (outer - ground).norm() < (inner - ground).norm() / 2.0)
        .then_some((meets, t))
}

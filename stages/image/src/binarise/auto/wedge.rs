//! Wedges of ground between sleeve and side, or between two legs, that are closed at their wide
//! end: where a cuff touches the hem, the ground behind it is a hole of the mask, and holes are
//! filled.
//!
//! A hole is such a wedge where it is long, lies on one side of the garment's axis, and comes near
//! the outside at one place only. A print crosses the axis or lies far from the outline; a stripe
//! across a sleeve comes near it at both ends. The wedge is opened by a slit at the place where it
//! comes nearest to the outside.
//!
//! A wedge that is open at its wide end is filled from its tip on where it is narrower than what a
//! clean-up closes ([`with_inlets`]), and in the photo itself up to its tip ([`follow`]). What
//! tapers away from the outside is such a wedge; a stripe that ends at the hem does not taper.
//!
//! Cost: one labelling of the mask and a symmetry axis; an inlet one labelling. Limits: a wedge on
//! the axis, between two legs that touch at their feet, stays filled.

use super::super::morphology::dilate;
use super::super::regions::Regions;
use super::super::small::{Lab, lab};
use super::grid::{bits, picture};
use super::symmetry::{Symmetry, symmetry};
use image::GrayImage;
use toile_core::prelude::*;

/// A wedge holds at least this share of the garment.
const LEAST: f64 = 0.004;
/// It comes as near to the outside as this, as a share of the longer side.
const BRIDGE: f64 = 0.03;
/// The share of its pixels on one side of the axis.
const ONE_SIDE: f64 = 0.95;
/// The squared length of a wedge is more than so many times its area.
const LONG: f64 = 4.0;
/// Where it comes near the outside, it does so over at most this share of its length.
const ONE_PLACE: f64 = 0.5;

/// An inlet holds at least this share of the garment.
const LEAST_INLET: f64 = 0.0005;
/// The middle of an inlet lies nearer to its mouth than this, as a share of its length: a third
/// where it is a triangle, a half where it is a stripe.
const TAPERS: f64 = 0.42;

/// Half the side of the square in which an inlet is followed to its tip, as a share of the photo's
/// longer side; and of the one from which its colours are taken.
const FOLLOWED: f64 = 0.08;
const BESIDE: f64 = 0.02;
/// An inlet goes on within this of where it ends, as a share of the longer side.
const GOES_ON: f64 = 0.012;

/// The mask with the inlets of ground opened that a clean-up has closed from their tips on, and
/// where they end. `raw` is the mask by colours and edges alone, both of `w` pixels across.
pub(super) fn with_inlets(mask: &[bool], raw: &[bool], w: usize) -> (Vec<bool>, Vec<[usize; 2]>) {
    let (mut open, mut ends) = (mask.to_vec(), Vec::new());
    let h = mask.len() / w.max(1);
    let closed: Vec<bool> = mask.iter().zip(raw).map(|(on, raw)| *on && !raw).collect();
    let closed = Regions::of(&picture(&closed, w, h));
    let least = LEAST_INLET * mask.iter().filter(|on| **on).count() as f64;
    let outside: Vec<bool> = mask.iter().map(|on| !on).collect();
    let beside = bits(&dilate(&picture(&outside, w, h), 1));
    for (i, _) in closed.pieces.iter().enumerate().filter(|(_, p)| p.on && p.area as f64 >= least) {
        let pixels = places(&bits(&closed.paint(|k, _| k == i)));
        if is_inlet(&pixels, &beside, w) {
            let mouth = middle(pixels.iter().copied().filter(|&k| beside[k]), w);
            let away =
                |k: &usize| (((k % w) as f64 - mouth[0]).hypot((k / w) as f64 - mouth[1]) * 1e3) as u64;
            ends.extend(pixels.iter().copied().max_by_key(away).map(|k| [k % w, k / w]));
            pixels.into_iter().for_each(|k| open[k] = false);
        }
    }
    (open, ends)
}

/// Follows an inlet from where it ends, at `end`, to its tip in the photo: what is connected with
/// its ground, and whose colour is nearer to that of the ground than of the garment there, where it
/// is long.
pub(super) fn follow(mask: &mut GrayImage, photo: &Photo, end: [u32; 2]) {
    let (w, h) = mask.dimensions();
    let side = f64::from(w.max(h));
    let square = |at: [u32; 2], share: f64| {
        let reach = (share * side).ceil() as u32;
        let span = |at: u32, most: u32| at.saturating_sub(reach)..(at + reach + 1).min(most);
        (span(at[0], w), span(at[1], h))
    };
    // The boundary that was set in the photo ends before it.
    let (xs, ys) = square(end, FOLLOWED);
    let ground =
        ys.flat_map(|y| xs.clone().map(move |x| [x, y])).filter(|p| mask.get_pixel(p[0], p[1]).0[0] == 0);
    let away = |p: &[u32; 2]| p[0].abs_diff(end[0]).pow(2) + p[1].abs_diff(end[1]).pow(2);
    let Some(end) = ground.min_by_key(away) else { return };
    let colour = |x: u32, y: u32| lab(photo.pixels.get_pixel(x, y).0.map(f64::from));
    let (xs, ys) = square(end, BESIDE);
    let (mut sums, mut counts) = ([Lab::zeros(); 2], [0.0; 2]);
    for (x, y) in ys.flat_map(|y| xs.clone().map(move |x| (x, y))) {
        let on = usize::from(mask.get_pixel(x, y).0[0] != 0);
        sums[on] += colour(x, y);
        counts[on] += 1.0;
    }
    if counts.contains(&0.0) {
        return;
    }
    let [ground, garment] = [0, 1].map(|k| sums[k] / counts[k]);
    let is_ground = |x: u32, y: u32| (colour(x, y) - ground).norm() < (colour(x, y) - garment).norm();
    let (xs, ys) = square(end, FOLLOWED);
    let wide = xs.len();
    let square: Vec<(u32, u32)> = ys.flat_map(|y| xs.clone().map(move |x| (x, y))).collect();
    let flags = |of: &dyn Fn(u32, u32) -> bool| square.iter().map(|&(x, y)| of(x, y)).collect::<Vec<bool>>();
    let picture = |of: &[bool]| picture(of, wide, of.len() / wide);
    let on = flags(&|x, y| mask.get_pixel(x, y).0[0] != 0);
    let outside: Vec<bool> = on.iter().map(|on| !on).collect();
    let beside = bits(&dilate(&picture(&outside), 1));
    let goes_on = flags(&|x, y| f64::from(x.abs_diff(end[0]).max(y.abs_diff(end[1]))) < GOES_ON * side);
    // The rim of the garment, whose colours are mixed, is ground only where the inlet goes on.
    let like = flags(&is_ground);
    let like: Vec<bool> = (0..square.len()).map(|k| on[k] && like[k] && (goes_on[k] || !beside[k])).collect();
    let parts = Regions::of(&picture(&like));
    for (i, _) in parts.pieces.iter().enumerate().filter(|(_, p)| p.on) {
        let pixels = places(&bits(&parts.paint(|k, _| k == i)));
        if pixels.iter().any(|&k| goes_on[k] && beside[k]) && is_inlet(&pixels, &beside, wide) {
            pixels.into_iter().for_each(|k| mask.get_pixel_mut(square[k].0, square[k].1).0 = [0]);
        }
    }
}

/// The middle of some pixels.
fn middle(of: impl Iterator<Item = usize>, w: usize) -> [f64; 2] {
    let (sum, count) =
        of.fold(([0.0; 2], 0.0), |([x, y], n), k| ([x + (k % w) as f64, y + (k / w) as f64], n + 1.0));
    sum.map(|s| s / f64::max(count, 1.0))
}

/// Whether some pixels are long, lie beside the outside at one place only, and taper away from it.
fn is_inlet(pixels: &[usize], beside: &[bool], w: usize) -> bool {
    let mouth: Vec<usize> = pixels.iter().copied().filter(|&k| beside[k]).collect();
    let length = extent(pixels, w);
    let (a, b) = (middle(pixels.iter().copied(), w), middle(mouth.iter().copied(), w));
    !mouth.is_empty()
        && length * length > LONG * pixels.len() as f64
        && extent(&mouth, w) <= ONE_PLACE * length
        && (a[0] - b[0]).hypot(a[1] - b[1]) <= TAPERS * length
}

/// The mask with its wedges opened. `solid` is the mask with its holes filled, `raw` the mask with
/// its holes, both of `w` pixels across.
pub(super) fn with_wedges(solid: &[bool], raw: &[bool], w: usize) -> Vec<bool> {
    let mut mask = solid.to_vec();
    let h = solid.len() / w.max(1);
    let Some(axis) = symmetry(solid, w) else { return mask };
    let holes: Vec<bool> = solid.iter().zip(raw).map(|(solid, raw)| *solid && !raw).collect();
    let holes = Regions::of(&picture(&holes, w, h));
    let least = LEAST * solid.iter().filter(|on| **on).count() as f64;
    let bridge = (BRIDGE * w.max(h) as f64).ceil();
    let outside: Vec<bool> = solid.iter().map(|on| !on).collect();
    let near = bits(&dilate(&picture(&outside, w, h), bridge as u32));
    for (i, _) in holes.pieces.iter().enumerate().filter(|(_, p)| p.on && p.area as f64 >= least) {
        let pixels: Vec<usize> = places(&bits(&holes.paint(|k, _| k == i)));
        if let Some(at) = mouth(&pixels, &near, axis, w) {
            pixels.iter().for_each(|&k| mask[k] = false);
            slit(&mut mask, solid, at, bridge as usize, w);
        }
    }
    mask
}

fn places(mask: &[bool]) -> Vec<usize> {
    mask.iter().enumerate().filter_map(|(k, on)| on.then_some(k)).collect()
}

/// The pixels of a hole that lie near the outside, where the hole is a wedge.
fn mouth(pixels: &[usize], near: &[bool], axis: Symmetry, w: usize) -> Option<Vec<usize>> {
    let count = pixels.len() as f64;
    let left = pixels.iter().filter(|&&k| axis.side([(k % w) as f64, (k / w) as f64]) < 0.0).count() as f64;
    let length = extent(pixels, w);
    let mouth: Vec<usize> = pixels.iter().copied().filter(|&k| near[k]).collect();
    let is_wedge = left.max(count - left) >= ONE_SIDE * count
        && length * length > LONG * count
        && !mouth.is_empty()
        && extent(&mouth, w) <= ONE_PLACE * length;
    is_wedge.then_some(mouth)
}

/// The diagonal of the box around some pixels.
fn extent(pixels: &[usize], w: usize) -> f64 {
    let span = |of: &dyn Fn(usize) -> usize| {
        let values = || pixels.iter().map(|&k| of(k));
        (values().max().unwrap_or(0) + 1 - values().min().unwrap_or(0)) as f64
    };
    span(&|k| k % w).hypot(span(&|k| k / w))
}

/// Takes the pixels between a wedge's mouth and the outside off the mask, along the shortest line.
fn slit(mask: &mut [bool], solid: &[bool], mouth: Vec<usize>, reach: usize, w: usize) {
    let h = solid.len() / w.max(1);
    let outside = |k: usize| {
        let (x, y) = (k % w, k / w);
        let (xs, ys) = (
            x.saturating_sub(reach)..(x + reach + 1).min(w),
            y.saturating_sub(reach)..(y + reach + 1).min(h),
        );
        let around = ys.flat_map(|v| xs.clone().map(move |u| (u, v))).filter(|(u, v)| !solid[v * w + u]);
        let square = |(u, v): (usize, usize)| u.abs_diff(x).pow(2) + v.abs_diff(y).pow(2);
        around.map(|p| (square(p), (x, y), p)).min()
    };
    let Some((_, (ax, ay), (bx, by))) = mouth.into_iter().filter_map(outside).min() else { return };
    let steps = 2 * ax.abs_diff(bx).max(ay.abs_diff(by)).max(1);
    for i in 0..=steps {
        let along = |a: usize, b: usize| {
            (a as f64 + (b as f64 - a as f64) * i as f64 / steps as f64).round() as usize
        };
        let (x, y) = (along(ax, bx), along(ay, by));
        // Two pixels wide, so that ground meets ground across edges.
        for (u, v) in [(x, y), (x + 1, y), (x, y + 1)].into_iter().filter(|(u, v)| *u < w && *v < h) {
            mask[v * w + u] = false;
        }
    }
}

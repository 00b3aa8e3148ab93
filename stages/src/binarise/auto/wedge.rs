//! Wedges of ground between sleeve and side, or between two legs, that are closed at their wide end: where a cuff touches the
//! hem, the ground behind it is a hole of the mask, and holes are filled.
//!
//! A hole is such a wedge where it is long, lies on one side of the garment's axis, and comes near the outside at one place
//! only. A print crosses the axis or lies far from the outline; a stripe across a sleeve comes near it at both ends. The wedge
//! is opened by a slit at the place where it comes nearest to the outside.
//!
//! Cost: one labelling of the mask and a symmetry axis. Limits: a wedge on the axis, between two legs that touch at their
//! feet, stays filled.

use super::super::morphology::dilate;
use super::super::regions::Regions;
use super::grid::{bits, picture};
use super::symmetry::{Symmetry, symmetry};

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

/// The mask with its wedges opened. `solid` is the mask with its holes filled, `raw` the mask with its holes, both of `w` pixels
/// across.
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

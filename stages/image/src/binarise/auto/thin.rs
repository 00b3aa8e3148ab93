//! Thin parts without a mirror image: a cable that lies beside a shirt, and the ground that it
//! closes in.
//!
//! An opening takes off all that is thin. Straps are thin too, but come in pairs: what was taken
//! off and lies, mirrored, on the mask again stays. What has no counterpart is taken off, if it is
//! small.

use super::super::finish::fill_holes;
use super::super::morphology::{dilate, open};
use super::super::regions::Regions;
use super::grid::{bits, picture};
use super::symmetry::{Symmetry, at, symmetry};

/// Half the width of what is thin, as a share of the longer side.
const THIN: f64 = 0.01;
/// What is taken off holds at most this share of the mask, each piece.
const MOST: f64 = 0.05;
/// Pieces below this share of the mask are the contour's own unevenness.
const LEAST: f64 = 0.002;
/// A part stays from this share of its mirror image on.
const PAIRED: f64 = 0.5;
/// A part is added from this share of its mirror image on.
const SURELY_PAIRED: f64 = 0.8;

/// The mask without thin parts that have no mirror image. `raw` is what was found before holes were
/// filled, of the same size.
pub(super) fn without_lone_parts(mask: &[bool], raw: &[bool], w: usize) -> Vec<bool> {
    let h = mask.len() / w.max(1);
    let radius = ((THIN * w.max(h) as f64).round() as u32).max(1);
    let Some(axis) = symmetry(mask, w) else { return mask.to_vec() };
    // A cuff behind a gathered wrist is a piece of its own, and not thin.
    let solid = fill_holes(open(&picture(raw, w, h), radius), 1.0);
    let near = bits(&dilate(&solid, 1));
    let rest: Vec<bool> = mask.iter().zip(&near).map(|(on, near)| *on && !near).collect();
    // The axis is known to a pixel or two, which is half of a strap.
    let about = bits(&dilate(&picture(mask, w, h), radius));
    let mut kept = mask.to_vec();
    for part in parts(&rest, mask, w) {
        if mirrored(&part, &about, axis, w) < PAIRED {
            part.into_iter().for_each(|k| kept[k] = false);
        }
    }
    kept
}

/// The mask with thin parts of the mask before clean-up, where they come in pairs: straps that the
/// clean-up removed.
pub(super) fn with_pairs(mask: &[bool], raw: &[bool], w: usize) -> Vec<bool> {
    let h = mask.len() / w.max(1);
    let Some(axis) = symmetry(mask, w) else { return mask.to_vec() };
    let radius = ((THIN * w.max(h) as f64).round() as u32).max(1);
    let either: Vec<bool> = mask.iter().zip(raw).map(|(a, b)| *a || *b).collect();
    let about = bits(&dilate(&picture(&either, w, h), radius));
    let beside = bits(&dilate(&picture(mask, w, h), 1));
    let rest: Vec<bool> = raw.iter().zip(mask).map(|(raw, on)| *raw && !on).collect();
    let mut whole = mask.to_vec();
    for part in parts(&rest, mask, w) {
        if part.iter().any(|&k| beside[k]) && mirrored(&part, &about, axis, w) >= SURELY_PAIRED {
            part.into_iter().for_each(|k| whole[k] = true);
        }
    }
    whole
}

/// The connected pieces of `rest` that are small beside the mask, but no unevenness of its contour.
fn parts(rest: &[bool], mask: &[bool], w: usize) -> Vec<Vec<usize>> {
    let area = mask.iter().filter(|on| **on).count() as f64;
    let regions = Regions::of(&picture(rest, w, mask.len() / w.max(1)));
    let is_part = |area_px: u64| (LEAST..=MOST).contains(&(area_px as f64 / area.max(1.0)));
    let pieces = regions.pieces.iter().enumerate().filter(|(_, p)| p.on && is_part(p.area));
    pieces
        .map(|(i, _)| {
            let piece = bits(&regions.paint(|k, _| k == i));
            piece.iter().enumerate().filter_map(|(k, on)| on.then_some(k)).collect()
        })
        .collect()
}

/// The share of a part whose mirror image lies on `about`.
fn mirrored(part: &[usize], about: &[bool], axis: Symmetry, w: usize) -> f64 {
    let h = about.len() / w.max(1);
    let image = |k: &&usize| at(about, w, h, axis.mirror([(**k % w) as f64, (**k / w) as f64]));
    part.iter().filter(image).count() as f64 / part.len().max(1) as f64
}

//! Thin parts without a mirror image: a cable that lies beside a shirt, and the ground that it closes in.
//!
//! An opening takes off all that is thin. Straps are thin too, but come in pairs: what was taken off and lies, mirrored, on the
//! mask again stays. What has no counterpart is taken off, if it is small.

use super::super::finish::fill_holes;
use super::super::morphology::{dilate, open};
use super::super::regions::Regions;
use super::grid::{bits, picture};
use super::symmetry::{at, symmetry};

/// Half the width of what is thin, as a share of the longer side.
const THIN: f64 = 0.01;
/// What is taken off holds at most this share of the mask, each piece.
const MOST: f64 = 0.05;
/// Pieces below this share of the mask are the contour's own unevenness.
const LEAST: f64 = 0.002;
/// A part stays from this share of its mirror image on.
const PAIRED: f64 = 0.5;

/// The mask without thin parts that have no mirror image. `raw` is what was found before holes were filled, of the same size.
pub(super) fn without_lone_parts(mask: &[bool], raw: &[bool], w: usize) -> Vec<bool> {
    let h = mask.len() / w.max(1);
    let radius = ((THIN * w.max(h) as f64).round() as u32).max(1);
    let regions = Regions::of(&open(&picture(raw, w, h), radius));
    let (Some(&main), Some(axis)) = (regions.by_size().first(), symmetry(mask, w)) else {
        return mask.to_vec();
    };
    let solid = fill_holes(regions.paint(|i, _| i == main), 1.0);
    let near = bits(&dilate(&solid, 1));
    let area = mask.iter().filter(|on| **on).count() as f64;
    let rest: Vec<bool> = mask.iter().zip(&near).map(|(on, near)| *on && !near).collect();
    let rest = Regions::of(&picture(&rest, w, h));
    let mut kept = mask.to_vec();
    for (i, piece) in rest.pieces.iter().enumerate().filter(|(_, p)| p.on) {
        let share = piece.area as f64 / area.max(1.0);
        if !(LEAST..=MOST).contains(&share) {
            continue;
        }
        let pixels: Vec<usize> = bits(&rest.paint(|k, _| k == i))
            .iter()
            .enumerate()
            .filter_map(|(k, on)| on.then_some(k))
            .collect();
        let paired =
            pixels.iter().filter(|&&k| at(mask, w, h, axis.mirror([(k % w) as f64, (k / w) as f64])));
        if (paired.count() as f64) < PAIRED * pixels.len() as f64 {
            pixels.iter().for_each(|&k| kept[k] = false);
        }
    }
    kept
}

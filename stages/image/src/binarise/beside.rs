//! A thing that lies in a photo apart from others, and what is told of one beside the garment.

use super::marks::PhotoPlace;
use super::small::SmallPhoto;
use image::GrayImage;
use toile_core::prelude::*;

/// The longer side at which things are looked at, px.
pub(super) const SIDE: u32 = 300;
/// A second thing is one from this share of the first on: less is a shoe, a label, a tape measure.
pub(super) const SECOND: f64 = 0.25;
/// A thing is the garment that was taken, where that covers this share of it.
const SAME: f64 = 0.3;
/// What is left around a thing when it is looked at alone, as a share of its longer side.
const AROUND: f64 = 0.06;

/// A thing; places are shares of the photo's width and height, from the left upper corner.
#[derive(Debug, Clone)]
pub(super) struct Thing {
    mask: Vec<bool>,
    /// Small pixels across and down.
    size: [usize; 2],
    /// Its small pixels.
    pub(super) area: f64,
    /// The least rectangle that holds it: two opposite corners.
    bounds: [[f64; 2]; 2],
    /// A place on it.
    place: [f64; 2],
}

impl Thing {
    pub(super) fn of(mask: Vec<bool>, small: &SmallPhoto) -> Self {
        let (w, h) = (small.w as f64, small.h as f64);
        let on = || mask.iter().enumerate().filter(|(_, on)| **on).map(|(i, _)| (i % small.w, i / small.w));
        let span = |of: &dyn Fn((usize, usize)) -> usize| {
            on().map(of).fold((usize::MAX, 0), |(lo, hi), v| (lo.min(v), hi.max(v)))
        };
        let ((left, right), (top, bottom)) = (span(&|p| p.0), span(&|p| p.1));
        let area = on().count();
        // The middle of the longest stretch at the height of its middle: a place that is on it,
        // whatever its form.
        let row = on().map(|p| p.1).sum::<usize>() / area.max(1);
        let mut best = (0, 0);
        let mut from = None;
        for x in 0..=small.w {
            let is_on = x < small.w && mask[row * small.w + x];
            match (is_on, from) {
                (true, None) => from = Some(x),
                (false, Some(start)) => {
                    best = if x - start > best.1 - best.0 { (start, x) } else { best };
                    from = None;
                }
                _ => {}
            }
        }
        let place = [0.5 * (best.0 + best.1) as f64 / w, (row as f64 + 0.5) / h];
        let bounds = [[left as f64 / w, top as f64 / h], [(right + 1) as f64 / w, (bottom + 1) as f64 / h]];
        Thing { mask, size: [small.w, small.h], area: area as f64, bounds, place }
    }

    /// Whether a place lies on it.
    pub(super) fn holds(&self, (x, y): PhotoPlace) -> bool {
        let [w, h] = self.size;
        let (x, y) = ((x * w as f64) as usize, (y * h as f64) as usize);
        self.mask.get(y.min(h - 1) * w + x.min(w - 1)).copied().unwrap_or(false)
    }

    /// The rectangle in which it is looked at alone: with ground around, but nothing of the
    /// `others`. `ratio` is the photo's width over its height.
    pub(super) fn alone(&self, others: &[Thing], ratio: f64) -> [[f64; 2]; 2] {
        let [[left, top], [right, bottom]] = self.bounds;
        let around = AROUND * ((right - left) * ratio).max(bottom - top);
        let (mut low, mut high) = ([around / ratio, around], [around / ratio, around]);
        for other in others {
            let [[l, t], [r, b]] = other.bounds;
            for (k, (before, after)) in [(l - right, left - r), (t - bottom, top - b)].into_iter().enumerate()
            {
                high[k] = if before >= 0.0 { high[k].min(before / 2.0) } else { high[k] };
                low[k] = if after >= 0.0 { low[k].min(after / 2.0) } else { low[k] };
            }
        }
        [
            [(left - low[0]).max(0.0), (top - low[1]).max(0.0)],
            [(right + high[0]).min(1.0), (bottom + high[1]).min(1.0)],
        ]
    }

    /// Where it lies from the middle of another.
    fn side_of(&self, other: &Thing, ratio: f64) -> &'static str {
        let middle = |t: &Thing, k: usize| f64::midpoint(t.bounds[0][k], t.bounds[1][k]);
        let [x, y] = [0, 1].map(|k| middle(self, k) - middle(other, k));
        match ((x * ratio).abs() >= y.abs(), x > 0.0, y > 0.0) {
            (true, true, _) => "to the right of",
            (true, false, _) => "to the left of",
            (false, _, true) => "below",
            (false, _, false) => "above",
        }
    }
}

/// Tells of a thing that lies beside the garment which was taken, and how to take it instead: the
/// `second` piece of the mask, or one of the `things` that the mask leaves out.
pub(super) fn tell_beside(
    photo: &Photo,
    mask: &Mask,
    second: Option<&GrayImage>,
    things: impl FnOnce() -> Vec<Thing>,
    cx: &Context,
) {
    // Of a mirror image it was told of its photo.
    if photo.mirrored {
        return;
    }
    let small = SmallPhoto::of(photo, SIDE);
    let taken = Thing::of(at_size(&mask.pixels, &small), &small);
    let covered = |t: &Thing| {
        let both = t.mask.iter().zip(&taken.mask).filter(|(a, b)| **a && **b).count();
        both as f64 / t.area.max(1.0)
    };
    let is_other = |t: &Thing| covered(t) < SAME && t.area >= SECOND * taken.area;
    let other = match second {
        Some(second) => Some(Thing::of(at_size(second, &small), &small)),
        None => things().into_iter().find(is_other),
    };
    let Some(other) = other else { return };
    let [x, y] = other.place;
    let marks = format!("{{\"{}\": [({x:.2}, {y:.2})]}}", cx.entry());
    let set = match cx.stage() {
        "Auto" => format!("stages.Auto.garment={marks}"),
        stage => format!("stages.{stage}=Auto(garment: {marks})"),
    };
    cx.warn(format!(
        "a second thing lies in \"{}\" {} the garment, {:.0} % as large; it is left out, and the stated width is the garment's own. To take it instead: --set '{set}'",
        photo.file,
        other.side_of(&taken, f64::from(photo.pixels.width()) / f64::from(photo.pixels.height().max(1))),
        100.0 * other.area / taken.area.max(1.0),
    ));
}

/// A mask of the photo's size at a reduced one.
pub(super) fn at_size(mask: &GrayImage, small: &SmallPhoto) -> Vec<bool> {
    let (w, h) = (mask.width() as usize, mask.height() as usize);
    let at = |i: usize| mask.as_raw()[(i / small.w * h / small.h) * w + i % small.w * w / small.w] != 0;
    (0..small.lab.len()).map(at).collect()
}

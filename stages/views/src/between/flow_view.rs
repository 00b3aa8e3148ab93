//! `FlowView`: the view between two photos, by the motion between them.

use super::dense::{DenseMotion, dense};
use super::photos::{pair, view};
use crate::picture::{by_rows, cubic};
use image::RgbImage;
use toile_core::prelude::*;

/// A way there and back that ends farther away than this is none: the pixel is hidden in the other
/// photo, px.
const HIDDEN_PX: f32 = 1.5;

/// Makes the view from a place between two photos, by the motion of what is seen.
///
/// The motion is found in blocks from the first photo to the second and back (hierarchical block
/// matching), then for each pixel; pixels move by their share of it. What one photo alone shows is
/// taken from that one. No camera need be known; the photos must be near to each other: what moves
/// by more than an eighth of the photo's height is not followed. The result is a photo named
/// `view`.
#[stage(
    role = ViewInterpolator,
    source = "garment modelling thesis, 2012: optical flow in blocks; Chen, Williams 1993; Bierling 1988; Baker and others 2011",
    example = "FlowView(at: 0.5)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct FlowView {
    /// The place: 0 is that of the first photo in the order of their names, 1 that of the second.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    at: f64,
}

#[stage]
impl FlowView {
    pub(super) fn run(&self, photos: Set<Photo>, cx: &Context) -> Result<Set<Photo>, StageError> {
        let [a, b] = pair(&photos)?;
        cx.progress(0.0, "motion");
        let there = dense(&a, &b, cx)?;
        let back = dense(&b, &a, cx)?;
        cx.progress(0.8, "view");
        let size = [a.width(), a.height()];
        let colours = between([&a, &b], [&there, &back], self.at, cx)?;
        Ok(view(&colours, size))
    }
}

/// The motion at a pixel of the view: from the first photo to the second, and which of them show
/// it.
#[derive(Clone, Copy)]
struct MovedPixel {
    vector: [f32; 2],
    shown: [bool; 2],
    /// How much the photos differ there.
    off: f32,
}

/// The colours at a place between.
fn between(
    photos: [&RgbImage; 2],
    motions: [&DenseMotion; 2],
    at: f64,
    cx: &Context,
) -> Result<Vec<[f32; 3]>, StageError> {
    let (w, h) = photos[0].dimensions();
    let (w, h) = (w as usize, h as usize);
    let mut field: Vec<Option<MovedPixel>> = vec![None; w * h];
    // Of what one photo alone shows, that of the nearer one counts first.
    for side in if at <= 0.5 { [0, 1] } else { [1, 0] } {
        splat(photos, motions, side, at, &mut field, w, cx)?;
    }
    let mut hidden = 0usize;
    field.iter().flatten().for_each(|m| hidden += usize::from(m.shown != [true; 2]));
    let holes = field.iter().filter(|m| m.is_none()).count();
    cx.figure("one_photo_alone", hidden as f64 / field.len().max(1) as f64, "share of pixels");
    cx.figure("unseen", holes as f64 / field.len().max(1) as f64, "share of pixels");
    let field = filled(field, w, cx)?;
    let colour = |k: usize| {
        let m = field[k];
        let (x, y) = ((k % w) as f64, (k / w) as f64);
        let [vx, vy] = m.vector.map(f64::from);
        let of = |side: usize, share: f64| cubic(photos[side], x + share * vx, y + share * vy);
        let a = of(0, -at).filter(|_| m.shown[0]).map(|c| (c, (1.0 - at) as f32));
        let b = of(1, 1.0 - at).filter(|_| m.shown[1]).map(|c| (c, at as f32));
        mixed(a, b).or_else(|| of(0, 0.0)).unwrap_or_default()
    };
    by_rows(w, h, cx, colour)
}

/// The weighted mean of what there is; where the place is that of a photo, that one alone counts.
fn mixed(a: Option<([f32; 3], f32)>, b: Option<([f32; 3], f32)>) -> Option<[f32; 3]> {
    match (a, b) {
        (Some((a, wa)), Some((b, wb))) => {
            Some([0, 1, 2].map(|c| (wa * a[c] + wb * b[c]) / (wa + wb).max(1e-6)))
        }
        (one, other) => one.or(other).map(|(c, _)| c),
    }
}

/// Lays the motion of one photo's pixels where they are in the view.
fn splat(
    photos: [&RgbImage; 2],
    motions: [&DenseMotion; 2],
    side: usize,
    at: f64,
    field: &mut [Option<MovedPixel>],
    w: usize,
    cx: &Context,
) -> Result<(), StageError> {
    let share = if side == 0 { at } else { 1.0 - at };
    for (k, v) in motions[side].vectors.iter().enumerate() {
        if k % w == 0 {
            cx.check()?;
        }
        let (x, y) = ((k % w) as f64, (k / w) as f64);
        let (ox, oy) = (x + f64::from(v[0]), y + f64::from(v[1]));
        let back = motions[1 - side].near(ox, oy);
        let meets = back.is_some_and(|b| (b[0] + v[0]).hypot(b[1] + v[1]) <= HIDDEN_PX);
        let off = match (cubic(photos[side], x, y), cubic(photos[1 - side], ox, oy)) {
            (Some(a), Some(b)) if meets => (0..3).map(|c| (a[c] - b[c]).abs()).sum(),
            // What is hidden in the other photo gives way to what both show.
            _ => 1000.0,
        };
        let mut shown = [meets; 2];
        shown[side] = true;
        let vector = if side == 0 { *v } else { v.map(|c| -c) };
        let moved = MovedPixel { vector, shown, off };
        let (tx, ty) = (x + share * f64::from(v[0]), y + share * f64::from(v[1]));
        for (tx, ty) in [
            (tx.floor(), ty.floor()),
            (tx.ceil(), ty.floor()),
            (tx.floor(), ty.ceil()),
            (tx.ceil(), ty.ceil()),
        ] {
            if tx < 0.0 || ty < 0.0 || tx >= w as f64 {
                continue;
            }
            let Some(place) = field.get_mut(ty as usize * w + tx as usize) else { continue };
            if place.is_none_or(|p| off < p.off) {
                *place = Some(moved);
            }
        }
    }
    Ok(())
}

/// What no photo's pixel came to takes the motion beside it.
fn filled(mut field: Vec<Option<MovedPixel>>, w: usize, cx: &Context) -> Result<Vec<MovedPixel>, StageError> {
    let h = field.len() / w.max(1);
    let mut holes: Vec<usize> = (0..field.len()).filter(|k| field[*k].is_none()).collect();
    while !holes.is_empty() {
        cx.check()?;
        let beside = |k: usize| {
            let (x, y) = (k % w, k / w);
            let around = [
                (x > 0).then(|| k - 1),
                (x + 1 < w).then_some(k + 1),
                (y > 0).then(|| k - w),
                (y + 1 < h).then_some(k + w),
            ];
            around.into_iter().flatten().find_map(|n| field[n])
        };
        let found: Vec<(usize, MovedPixel)> = holes.iter().filter_map(|k| Some((*k, beside(*k)?))).collect();
        if found.is_empty() {
            break;
        }
        found.iter().for_each(|(k, m)| field[*k] = Some(*m));
        holes.retain(|k| field[*k].is_none());
    }
    let still = MovedPixel { vector: [0.0; 2], shown: [true; 2], off: 0.0 };
    Ok(field.into_iter().map(|m| m.unwrap_or(still)).collect())
}

//! A vector for each pixel, from those of the blocks.
//!
//! A pixel takes, of the vectors of its block and of the eight around it, the one with which a
//! small window around it differs least, its own block's before others; so the border of what moves
//! lies at pixels, not at blocks.
//! Cost: nine differences of each pixel.

use crate::flow::{BLOCK, FlowField, PARTS, Pyramid, motion};
use crate::picture::{GreyPlane, cubic};
use image::RgbImage;
use rayon::prelude::*;
use std::ops::Range;
use toile_core::{Context, StageError};

/// Half the side of the window, px.
const WINDOW: usize = 3;
/// What a pixel's vector costs that leaves its block's by a pixel, grey levels.
const STIFFNESS: f32 = 1.0;
/// The difference of what lies beyond the other picture, grey levels.
const BEYOND: f32 = 40.0;

/// Pixels across and down, row by row.
pub(super) struct DenseMotion {
    width: usize,
    pub(super) vectors: Vec<[f32; 2]>,
}

impl DenseMotion {
    /// Of a pixel, the nearest one to a place; none beyond the picture.
    pub(super) fn near(&self, x: f64, y: f64) -> Option<[f32; 2]> {
        let (x, y) = (x.round(), y.round());
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64;
        inside.then(|| self.vectors.get(y as usize * self.width + x as usize).copied()).flatten()
    }
}

/// Where each pixel of `from` is in `to`.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn dense(from: &RgbImage, to: &RgbImage, cx: &Context) -> Result<DenseMotion, StageError> {
    let [of_from, of_to] = [from, to].map(|p| Pyramid::of(&super::photos::opaque(p)));
    let blocks = motion(&of_from, &of_to, cx)?;
    let (width, height) = (from.width() as usize, from.height() as usize);
    let plane = GreyPlane::of(from, cx)?;
    let row = |row: usize| {
        cx.check()?;
        let mut lines = vec![[0f32; 2]; width * BLOCK.min(height - (row * BLOCK).min(height))];
        for column in 0..blocks.columns {
            block(&blocks, [column, row], &plane, to, &mut lines);
        }
        Ok(lines)
    };
    let rows: Vec<Result<Vec<[f32; 2]>, StageError>> = (0..blocks.rows).into_par_iter().map(row).collect();
    let vectors = rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    Ok(DenseMotion { width, vectors })
}

/// The pixels of one block, of the lines of its row.
fn block(
    blocks: &FlowField,
    [column, row]: [usize; 2],
    from: &GreyPlane,
    to: &RgbImage,
    lines: &mut [[f32; 2]],
) {
    let xs = column * BLOCK..((column + 1) * BLOCK).min(from.width);
    let ys = row * BLOCK..((row + 1) * BLOCK).min(from.height);
    let mut vectors: Vec<[i32; 2]> = blocks.near(column, row).collect();
    vectors.sort_unstable();
    vectors.dedup();
    let mut least = vec![f32::INFINITY; xs.len() * ys.len()];
    let own = blocks.vectors.get(row * blocks.columns + column).copied().flatten().unwrap_or_default();
    for v in vectors {
        let left = (v[0] - own[0]).abs() + (v[1] - own[1]).abs();
        let leaving = STIFFNESS * left as f32 / PARTS as f32;
        let v = v.map(|c| c as f32 / PARTS as f32);
        let differences = windows(from, to, &xs, &ys, v);
        for (k, difference) in differences.into_iter().enumerate() {
            if difference + leaving < least[k] {
                least[k] = difference + leaving;
                lines[k / xs.len() * from.width + xs.start + k % xs.len()] = v;
            }
        }
    }
}

/// The sum of differences in the window around each pixel of a block, with that vector.
fn windows(from: &GreyPlane, to: &RgbImage, xs: &Range<usize>, ys: &Range<usize>, v: [f32; 2]) -> Vec<f32> {
    let wide = xs.start.saturating_sub(WINDOW)..(xs.end + WINDOW).min(from.width);
    let high = ys.start.saturating_sub(WINDOW)..(ys.end + WINDOW).min(from.height);
    let one = |x: usize, y: usize| {
        let there = cubic(to, x as f64 + f64::from(v[0]), y as f64 + f64::from(v[1]));
        let light = |c: [f32; 3]| crate::picture::brightness(c);
        there.map_or(BEYOND, |c| (light(c) - from.levels[y * from.width + x]).abs().min(BEYOND))
    };
    let all: Vec<Vec<f32>> = high.clone().map(|y| wide.clone().map(|x| one(x, y)).collect()).collect();
    // Sums across, then down.
    let across = |line: &Vec<f32>| -> Vec<f32> {
        let sum = |x: usize| {
            let first = (x.saturating_sub(WINDOW)).max(wide.start) - wide.start;
            let last = (x + WINDOW + 1).min(wide.end) - wide.start;
            line.get(first..last).map_or(0.0, |w| w.iter().sum())
        };
        xs.clone().map(sum).collect()
    };
    let lines: Vec<Vec<f32>> = all.iter().map(across).collect();
    let mut out = Vec::with_capacity(xs.len() * ys.len());
    for y in ys.clone() {
        let first = y.saturating_sub(WINDOW).max(high.start) - high.start;
        let last = (y + WINDOW + 1).min(high.end) - high.start;
        let rows = lines.get(first..last).unwrap_or(&[]);
        let count = rows.len().max(1) as f32;
        out.extend((0..xs.len()).map(|k| rows.iter().map(|r| r[k]).sum::<f32>() / count));
    }
    out
}

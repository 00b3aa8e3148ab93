//! Colour bled past the outline.
//!
//! Every pixel that the panel does not surely cover takes the colour of the nearest one that it
//! does, found exactly by the separable distance transform (Felzenszwalb and Huttenlocher,
//! *Distance transforms of sampled functions*, 2012) which also keeps where the nearest was. So
//! neither a seam nor a reduced texture shows the ground on which the garment lay.
//!
//! One colour a ray would run out as a streak; so the picture beyond the outline is the rim inside
//! of it, mirrored there and back.
//!
//! Cost: linear in the number of pixels. Limit: across a print that ends at the outline the mirror
//! shows.

use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// Where a column has no marked pixel.
const NONE: u32 = u32::MAX;

/// For every pixel the nearest marked one (as an index), by exact Euclidean distance. `None` where
/// none is marked.
pub(super) fn nearest(
    marked: impl Fn(usize, usize) -> bool + Sync,
    width: usize,
    height: usize,
) -> Option<Vec<u32>> {
    let mut columns = vec![NONE; width * height];
    let column = |(x, rows): (usize, &mut [u32])| nearest_in_column(|y| marked(x, y), rows);
    columns.par_chunks_mut(height.max(1)).enumerate().for_each(column);
    if columns.iter().all(|y| *y == NONE) {
        return None;
    }
    let mut found = vec![0; width * height];
    let row = |hull: &mut Vec<Apex>, (y, row): (usize, &mut [u32])| {
        lower_envelope(|x| columns[x * height + y], y, width, hull);
        fill_row(row, hull, |x| columns[x * height + y]);
    };
    found.par_chunks_mut(width).enumerate().for_each_init(Vec::new, row);
    Some(found)
}

/// The row of the nearest marked pixel of one column, the upper of two.
fn nearest_in_column(marked: impl Fn(usize) -> bool, rows: &mut [u32]) {
    let mut last = NONE;
    for (y, row) in rows.iter_mut().enumerate() {
        last = if marked(y) { y as u32 } else { last };
        *row = last;
    }
    let mut next = NONE;
    for (y, row) in rows.iter_mut().enumerate().rev() {
        let y = y as u32;
        next = if *row == y { y } else { next };
        if next != NONE && (*row == NONE || next - y < y - *row) {
            *row = next;
        }
    }
}

/// A parabola on the lower envelope.
struct Apex {
    x: usize,
    height: f64,
    /// The place from which it is the lowest.
    from: f64,
}

/// The parabolas that are lowest somewhere in row `y`, from left to right: each has its apex at its
/// own x, as high as the square of the way to the nearest marked pixel of its column.
fn lower_envelope(nearest: impl Fn(usize) -> u32, y: usize, width: usize, hull: &mut Vec<Apex>) {
    hull.clear();
    for x in 0..width {
        let marked = nearest(x);
        if marked == NONE {
            continue;
        }
        let way = f64::from(marked) - y as f64;
        let height = way * way;
        let meets = |top: &Apex| {
            let (x, p) = (x as f64, top.x as f64);
            ((height + x * x) - (top.height + p * p)) / (2.0 * (x - p))
        };
        let mut from = f64::NEG_INFINITY;
        while let Some(top) = hull.last() {
            from = meets(top);
            if from > top.from {
                break;
            }
            hull.pop();
            from = f64::NEG_INFINITY;
        }
        hull.push(Apex { x, height, from });
    }
}

/// For every pixel of a row the marked one below its lowest parabola.
fn fill_row(row: &mut [u32], hull: &[Apex], nearest: impl Fn(usize) -> u32) {
    let width = row.len() as u32;
    let mut at = 0;
    for (x, slot) in row.iter_mut().enumerate() {
        while hull.get(at + 1).is_some_and(|next| next.from <= x as f64) {
            at += 1;
        }
        *slot = hull.get(at).map_or(0, |top| nearest(top.x) * width + top.x as u32);
    }
}

/// The inside without its rim of `depth` pixels. Beyond the picture counts as outside.
pub(super) fn eroded(inside: &GrayImage, depth: f64) -> GrayImage {
    let (w, h) = (inside.width() as usize, inside.height() as usize);
    let raw = inside.as_raw();
    // One pixel of outside is laid around the picture.
    let outside = |x: usize, y: usize| x == 0 || y == 0 || x > w || y > h || raw[(y - 1) * w + x - 1] == 0;
    let Some(near) = nearest(outside, w + 2, h + 2) else { return inside.clone() };
    // Half a pixel: the outline runs between the pixels' centres.
    let far = (depth + 0.5).max(0.0).powi(2);
    let keep = |y: usize, x: usize| {
        let n = near[(y + 1) * (w + 2) + x + 1] as usize;
        let (dx, dy) = ((n % (w + 2)).abs_diff(x + 1) as f64, (n / (w + 2)).abs_diff(y + 1) as f64);
        if dx * dx + dy * dy > far { 255 } else { 0 }
    };
    let mut kept = GrayImage::new(inside.width(), inside.height());
    let row = |(y, row): (usize, &mut [u8])| {
        row.iter_mut()
            .enumerate()
            .filter(|(x, _)| raw[y * w + x] != 0)
            .for_each(|(x, slot)| *slot = keep(y, x));
    };
    kept.par_chunks_mut(w.max(1)).enumerate().for_each(row);
    kept
}

/// Gives every pixel off `sure` a colour from the rim of `depth` pixels inside of the nearest pixel
/// on it: there and back again with growing distance, as in a mirror. False where there is no pixel
/// to take it from.
pub(super) fn bleed(pixels: &mut RgbImage, sure: &GrayImage, depth: f64) -> bool {
    let (w, h) = (sure.width() as usize, sure.height() as usize);
    let raw = sure.as_raw();
    let Some(near) = nearest(|x, y| raw[y * w + x] != 0, w, h) else { return false };
    let before = pixels.clone();
    let row = |(y, row): (usize, &mut [u8])| {
        let off = |(x, _): &(usize, &mut [u8])| raw[y * w + x] == 0;
        for (x, pixel) in row.chunks_exact_mut(3).enumerate().filter(off) {
            let from = mirrored([x, y], near[y * w + x] as usize, [w, h], depth);
            let from = 3 * from.filter(|i| raw[*i] != 0).unwrap_or(near[y * w + x] as usize);
            pixel.copy_from_slice(&before.as_raw()[from..from + 3]);
        }
    };
    pixels.par_chunks_mut(w * 3).enumerate().for_each(row);
    true
}

/// The pixel inside of `at`, which is the nearest sure one to `from`, as deep as `from` lies
/// outside, folded at `depth`.
fn mirrored(from: [usize; 2], at: usize, [w, h]: [usize; 2], depth: f64) -> Option<usize> {
    let (x, y) = ((at % w) as f64, (at / w) as f64);
    let (dx, dy) = (x - from[0] as f64, y - from[1] as f64);
    let distance = dx.hypot(dy);
    if depth < 1.0 || distance < 1.0 {
        return None;
    }
    let deep = (depth - (distance.rem_euclid(2.0 * depth) - depth).abs()) / distance;
    let (x, y) = ((x + dx * deep).round(), (y + dy * deep).round());
    let within = x >= 0.0 && y >= 0.0 && x < w as f64 && y < h as f64;
    within.then(|| y as usize * w + x as usize)
}

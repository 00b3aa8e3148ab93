//! Colour bled past the outline.
//!
//! Every pixel that the panel does not surely cover takes the colour of the nearest one that it does, found
//! exactly by the separable distance transform (Felzenszwalb and Huttenlocher, *Distance transforms of sampled
//! functions*, 2012) which also keeps where the nearest was. So neither a seam nor a reduced texture shows the
//! ground on which the garment lay.
//!
//! Cost: linear in the number of pixels. Limit: beyond the outline colours run out as streaks.

use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// For every pixel the nearest marked one (as an index), by exact Euclidean distance. `None` where none is marked.
pub(super) fn nearest(
    marked: impl Fn(usize, usize) -> bool + Sync,
    width: usize,
    height: usize,
) -> Option<Vec<u32>> {
    let columns: Vec<Vec<Option<u32>>> =
        (0..width).into_par_iter().map(|x| nearest_in_column(|y| marked(x, y), height)).collect();
    if columns.iter().flatten().all(Option::is_none) {
        return None;
    }
    let row = |y: usize| {
        let height_at = |x: usize| columns[x][y].map(|n| (f64::from(n) - y as f64).powi(2));
        lower_envelope(height_at, width).into_iter().map(move |x| (x, y)).collect::<Vec<_>>()
    };
    let found = (0..height).into_par_iter().flat_map_iter(row);
    Some(found.map(|(x, y)| columns[x][y].unwrap_or(0) * width as u32 + x as u32).collect())
}

/// The row of the nearest marked pixel of one column.
fn nearest_in_column(marked: impl Fn(usize) -> bool, height: usize) -> Vec<Option<u32>> {
    let mut nearest = vec![None; height];
    let mut last = None;
    for (y, slot) in nearest.iter_mut().enumerate() {
        last = if marked(y) { Some(y as u32) } else { last };
        *slot = last;
    }
    let mut next: Option<u32> = None;
    for (y, slot) in nearest.iter_mut().enumerate().rev() {
        next = if *slot == Some(y as u32) { *slot } else { next };
        let closer = |n: &u32| slot.is_none_or(|l| (*n as usize - y) < y - l as usize);
        *slot = next.filter(closer).or(*slot);
    }
    nearest
}

/// For every x the parabola (apex at its own x, at the given height) that is lowest there.
fn lower_envelope(height_at: impl Fn(usize) -> Option<f64>, width: usize) -> Vec<usize> {
    // Apexes on the envelope with the place from which each is lowest.
    let mut hull: Vec<(usize, f64, f64)> = Vec::new();
    for x in 0..width {
        let Some(h) = height_at(x) else { continue };
        let meets = |&(p, hp, _): &(usize, f64, f64)| {
            let (x, p) = (x as f64, p as f64);
            ((h + x * x) - (hp + p * p)) / (2.0 * (x - p))
        };
        while hull.last().is_some_and(|top| meets(top) <= top.2) {
            hull.pop();
        }
        let from = hull.last().map_or(f64::NEG_INFINITY, meets);
        hull.push((x, h, from));
    }
    let mut at = 0;
    let lowest = |x: usize| {
        while hull.get(at + 1).is_some_and(|next| next.2 <= x as f64) {
            at += 1;
        }
        hull.get(at).map_or(0, |top| top.0)
    };
    (0..width).map(lowest).collect()
}

/// The inside without its rim of `depth` pixels. Beyond the picture counts as outside.
pub(super) fn eroded(inside: &GrayImage, depth: f64) -> GrayImage {
    let (w, h) = (inside.width() as usize, inside.height() as usize);
    let raw = inside.as_raw();
    // One pixel of outside is laid around the picture.
    let outside = |x: usize, y: usize| x == 0 || y == 0 || x > w || y > h || raw[(y - 1) * w + x - 1] == 0;
    let Some(near) = nearest(outside, w + 2, h + 2) else { return inside.clone() };
    let keep = |i: usize| {
        let (x, y) = (i % w + 1, i / w + 1);
        let n = near[y * (w + 2) + x] as usize;
        let (dx, dy) = ((n % (w + 2)).abs_diff(x) as f64, (n / (w + 2)).abs_diff(y) as f64);
        // Half a pixel: the outline runs between the pixels' centres.
        if dx.hypot(dy) - 0.5 > depth { 255 } else { 0 }
    };
    let pixels = (0..w * h).into_par_iter().map(keep).collect();
    GrayImage::from_raw(inside.width(), inside.height(), pixels).unwrap_or_else(|| inside.clone())
}

/// Gives every pixel off `sure` the colour of the nearest pixel on it; false where there is none.
pub(super) fn bleed(pixels: &mut RgbImage, sure: &GrayImage) -> bool {
    let (w, h) = (sure.width() as usize, sure.height() as usize);
    let raw = sure.as_raw();
    let Some(near) = nearest(|x, y| raw[y * w + x] != 0, w, h) else { return false };
    let before = pixels.clone();
    let colour = |i: u32| before.get_pixel(i % w as u32, i / w as u32);
    pixels.par_chunks_mut(3).zip(&near).for_each(|(pixel, n)| pixel.copy_from_slice(&colour(*n).0));
    true
}

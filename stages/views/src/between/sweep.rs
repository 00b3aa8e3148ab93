//! Depth along the epipolar lines of two photos.
//!
//! Method: planes of equal inverse depth are swept through space (Collins 1996); the cost of a
//! pixel on a plane is the Hamming distance of the census of its surroundings (Zabih, Woodfill
//! 1994) and the difference of brightness; costs are summed along eight paths, with a penalty for
//! steps (semi-global matching: Hirschmuller 2008); between planes by a parabola. Cost: pixels
//! times planes times eight. Limit: photos are reduced to 640 px, so depth is no finer than that.

use super::orbit::OrbitCameras;
use crate::picture::{GreyPlane, by_rows};
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Penalty for a step of one plane, and for a longer one.
const STEP: u16 = 10;
const JUMP: u16 = 120;
/// The cost of what the other photo does not show.
const BEYOND: u16 = 40;
/// The most that a difference of brightness costs.
const BRIGHTNESS: f32 = 16.0;
/// The directions of the paths.
const PATHS: [[i64; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]];

/// Planes of equal steps in inverse depth.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweepPlanes {
    pub(super) first: f64,
    pub(super) step: f64,
    pub(super) count: usize,
}

impl SweepPlanes {
    /// From far to near (inverse depths), about a pixel of motion apart.
    pub(super) fn new(far: f64, near: f64, orbit: &OrbitCameras, turn: f64) -> SweepPlanes {
        let motion = orbit.focal * 2.0 * (turn.abs() / 2.0).sin() * (near - far);
        let count = (motion.ceil() as usize).clamp(12, 192);
        SweepPlanes { first: far, step: (near - far) / (count - 1) as f64, count }
    }
}

/// The inverse depth of each pixel of `a`; `b` is seen from a camera turned by `turn` radians.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn depths(
    a: &GreyPlane,
    b: &GreyPlane,
    orbit: &OrbitCameras,
    turn: f64,
    planes: SweepPlanes,
    cx: &Context,
) -> Result<Vec<f32>, StageError> {
    let costs = costs(a, b, orbit, turn, planes, cx)?;
    let mut sums = vec![0u16; costs.len()];
    for path in PATHS {
        along(&costs, &mut sums, a, path, planes.count, cx)?;
    }
    let best = |of: &[u16]| {
        let k = of.iter().enumerate().min_by_key(|(_, c)| **c).map_or(0, |(k, _)| k);
        let around = (k.checked_sub(1).and_then(|k| of.get(k)), of.get(k), of.get(k + 1));
        let part = match around {
            (Some(l), Some(m), Some(r)) => {
                let (l, m, r) = (f64::from(*l), f64::from(*m), f64::from(*r));
                let bend = l - 2.0 * m + r;
                if bend > 0.0 { ((l - r) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 }
            }
            _ => 0.0,
        };
        (planes.first + planes.step * (k as f64 + part)) as f32
    };
    let of_pixel = |k: usize| best(&sums[k * planes.count..(k + 1) * planes.count]);
    let raw = by_rows(a.width, a.height, cx, of_pixel)?;
    median(&raw, a.width, cx)
}

/// The cost of each pixel on each plane.
fn costs(
    a: &GreyPlane,
    b: &GreyPlane,
    orbit: &OrbitCameras,
    turn: f64,
    planes: SweepPlanes,
    cx: &Context,
) -> Result<Vec<u16>, StageError> {
    let (of_a, of_b) = (census(a, cx)?, census(b, cx)?);
    let pixel = |k: usize| {
        let place = [(k % a.width) as f64, (k / a.width) as f64];
        let (of_a, level) = (of_a[k], a.levels[k]);
        let of_b = &of_b;
        (0..planes.count).map(move |p| {
            let depth = planes.first + planes.step * p as f64;
            let Some(([x, y], _)) = orbit.seen(place, depth, turn) else { return BEYOND };
            let Some(there) = b.at(x, y) else { return BEYOND };
            let near =
                (y.round() as usize).min(b.height - 1) * b.width + (x.round() as usize).min(b.width - 1);
            let off = (there - level).abs().min(2.0 * BRIGHTNESS) / 2.0;
            (of_a ^ of_b[near]).count_ones() as u16 + off as u16
        })
    };
    let row = |y: usize| {
        cx.check()?;
        Ok((y * a.width..(y + 1) * a.width).flat_map(pixel).collect())
    };
    let rows: Vec<Result<Vec<u16>, StageError>> = (0..a.height).into_par_iter().map(row).collect();
    Ok(rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
}

/// Which of the pixels of the 5 x 5 around each are darker than it.
fn census(plane: &GreyPlane, cx: &Context) -> Result<Vec<u32>, StageError> {
    let at = |x: i64, y: i64| {
        let (x, y) = (x.clamp(0, plane.width as i64 - 1), y.clamp(0, plane.height as i64 - 1));
        plane.levels[y as usize * plane.width + x as usize]
    };
    let one = |k: usize| {
        let (x, y) = ((k % plane.width) as i64, (k / plane.width) as i64);
        let level = plane.levels[k];
        (0..25).fold(0u32, |bits, n| bits << 1 | u32::from(at(x + n % 5 - 2, y + n / 5 - 2) < level))
    };
    by_rows(plane.width, plane.height, cx, one)
}

/// Adds the costs summed along one path.
fn along(
    costs: &[u16],
    sums: &mut [u16],
    a: &GreyPlane,
    [dx, dy]: [i64; 2],
    planes: usize,
    cx: &Context,
) -> Result<(), StageError> {
    let (w, h) = (a.width as i64, a.height as i64);
    // Costs of the row before and of the row at work; along a row, of the pixel before.
    let mut before = vec![0u16; a.width * planes];
    let mut now = before.clone();
    for row in 0..h {
        cx.check()?;
        let y = if dy < 0 { h - 1 - row } else { row };
        for column in 0..w {
            let x = if dx < 0 { w - 1 - column } else { column };
            let k = (y * w + x) as usize;
            let own = &costs[k * planes..(k + 1) * planes];
            let (fx, fy) = (x - dx, y - dy);
            let inside = (0..w).contains(&fx) && (0..h).contains(&fy);
            let to = x as usize * planes;
            if !inside {
                now[to..to + planes].copy_from_slice(own);
            } else {
                let from = fx as usize * planes;
                let jump = jump(a, k, (fy * w + fx) as usize);
                if dy == 0 {
                    let last: Vec<u16> = now[from..from + planes].to_vec();
                    step(&last, own, jump, &mut now[to..to + planes]);
                } else {
                    step(&before[from..from + planes], own, jump, &mut now[to..to + planes]);
                }
            }
            sums[k * planes..(k + 1) * planes].iter_mut().zip(&now[to..]).for_each(|(s, c)| *s += c);
        }
        std::mem::swap(&mut before, &mut now);
    }
    Ok(())
}

/// A jump costs less where brightness jumps as well.
fn jump(a: &GreyPlane, k: usize, before: usize) -> u16 {
    let slope = (a.levels[k] - a.levels[before]).abs();
    ((f32::from(JUMP) / (1.0 + slope / 30.0)) as u16).max(STEP + 2)
}

fn step(before: &[u16], own: &[u16], jump: u16, to: &mut [u16]) {
    let least = before.iter().copied().min().unwrap_or(0);
    for (p, (out, cost)) in to.iter_mut().zip(own).enumerate() {
        let beside = |p: Option<usize>| p.and_then(|p| before.get(p)).map_or(u16::MAX, |c| c + STEP);
        let best = before[p].min(beside(p.checked_sub(1))).min(beside(Some(p + 1))).min(least + jump);
        *out = cost + best - least;
    }
}

/// The median of the 3 x 3 around each.
fn median(of: &[f32], w: usize, cx: &Context) -> Result<Vec<f32>, StageError> {
    let h = of.len() / w.max(1);
    let one = |k: usize| {
        let (x, y) = (k % w, k / w);
        let mut around = Vec::with_capacity(9);
        for y in y.saturating_sub(1)..(y + 2).min(h) {
            around.extend_from_slice(&of[y * w + x.saturating_sub(1)..y * w + (x + 2).min(w)]);
        }
        around.sort_by(f32::total_cmp);
        around[around.len() / 2]
    };
    by_rows(w, h, cx, one)
}

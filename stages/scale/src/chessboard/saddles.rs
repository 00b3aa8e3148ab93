//! Places where two dark and two light squares meet.
//!
//! A saddle of the smoothed grey levels, where the determinant of the second derivatives is most
//! negative, is kept if the grey levels on a ring around it change sides four times, and opposite
//! ones are alike (after Bennett and Lasenby, ChESS, CVIU 118, 2014).
//!
//! Cost: about 50 ns a pixel.

use crate::pixels::ReducedPhoto;
use nalgebra::{Point2, Vector2};
use rayon::prelude::*;

/// A corner at the reduced size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Saddle {
    pub(crate) at: Point2<f64>,
    /// The directions of the two edges, each up to its sign; the squares between the first and the
    /// second, turned clockwise, are dark.
    pub(crate) edges: [Vector2<f64>; 2],
    /// Contrast, grey levels.
    pub(crate) contrast: f32,
}

/// Saddles beyond this number are left out, those of least contrast first.
const MOST: usize = 3000;
/// Places on the ring.
const RING: usize = 32;
/// The ring's radius, pixels.
const RADIUS: f64 = 4.0;
/// The least contrast, grey levels.
const CONTRAST: f32 = 14.0;

/// Saddles that pass the ring's test, those of the largest contrast first.
pub(crate) fn saddles(small: &ReducedPhoto) -> Vec<Saddle> {
    let (w, h) = (small.w, small.h);
    let grey = smoothed(&small.rgb.iter().map(|c| (c[0] + c[1] + c[2]) / 3.0).collect::<Vec<f32>>(), w, h);
    let mut strength = vec![0f32; w * h];
    strength.par_chunks_mut(w.max(1)).enumerate().for_each(|(y, row)| {
        if y > 0 && y + 1 < h {
            (1..w.saturating_sub(1)).for_each(|x| row[x] = saddle(&grey, w, y * w + x));
        }
    });
    let rows = 6..h.saturating_sub(6);
    let lists: Vec<Vec<Saddle>> = rows
        .into_par_iter()
        .map(|y| (6..w.saturating_sub(6)).filter_map(|x| ring(&grey, &strength, w, h, x, y)).collect())
        .collect();
    let mut found: Vec<Saddle> = lists.into_iter().flatten().collect();
    found.sort_by(|a, b| b.contrast.total_cmp(&a.contrast));
    found.truncate(MOST);
    found
}

/// Smoothed twice by 1 2 1 in both directions.
fn smoothed(grey: &[f32], w: usize, h: usize) -> Vec<f32> {
    let pass = |from: &[f32], dx: usize, dy: usize| {
        let mut to = from.to_vec();
        to.par_chunks_mut(w.max(1)).enumerate().for_each(|(y, row)| {
            if y >= dy && y + dy < h {
                (dx..w.saturating_sub(dx)).for_each(|x| {
                    let (i, step) = (y * w + x, dy * w + dx);
                    row[x] = 0.25 * from[i - step] + 0.5 * from[i] + 0.25 * from[i + step];
                });
            }
        });
        to
    };
    (0..2).fold(grey.to_vec(), |g, _| pass(&pass(&g, 1, 0), 0, 1))
}

/// How much a pixel is a saddle: less the determinant of the second derivatives.
fn saddle(g: &[f32], w: usize, i: usize) -> f32 {
    let xx = g[i + 1] + g[i - 1] - 2.0 * g[i];
    let yy = g[i + w] + g[i - w] - 2.0 * g[i];
    let xy = 0.25 * (g[i + w + 1] + g[i - w - 1] - g[i + w - 1] - g[i - w + 1]);
    xy * xy - xx * yy
}

/// The saddle at a pixel, if it is the strongest around and its ring is that of a corner.
fn ring(grey: &[f32], strength: &[f32], w: usize, h: usize, x: usize, y: usize) -> Option<Saddle> {
    let i = y * w + x;
    let s = strength[i];
    // Squares that differ by 14 grey levels give 4 or more.
    if s < 2.0 {
        return None;
    }
    for v in y - 3..=y + 3 {
        for u in x - 3..=x + 3 {
            let j = v * w + u;
            if j != i && (strength[j] > s || (strength[j] == s && j < i)) {
                return None;
            }
        }
    }
    let at = centre(strength, w, x, y);
    let values: Vec<f32> = (0..RING).map(|n| bilinear(grey, w, h, at + turn(n as f64) * RADIUS)).collect();
    let (low, high) = values.iter().fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let half = RING / 2;
    let unlike = (0..half).map(|n| (values[n] - values[n + half]).abs()).fold(0.0, f32::max);
    if high - low < CONTRAST || unlike > 0.6 * (high - low) {
        return None;
    }
    let mean = values.iter().sum::<f32>() / RING as f32;
    let edges = changes(&values, mean)?;
    Some(Saddle { at, edges, contrast: high - low })
}

fn turn(n: f64) -> Vector2<f64> {
    let angle = n * std::f64::consts::TAU / RING as f64;
    Vector2::new(angle.cos(), angle.sin())
}

/// The top of the strength between pixels, by parabolas.
fn centre(s: &[f32], w: usize, x: usize, y: usize) -> Point2<f64> {
    let i = y * w + x;
    let top = |l: f32, m: f32, r: f32| {
        let bend = l - 2.0 * m + r;
        if bend < 0.0 { f64::from(0.5 * (l - r) / bend).clamp(-0.5, 0.5) } else { 0.0 }
    };
    Point2::new(x as f64 + top(s[i - 1], s[i], s[i + 1]), y as f64 + top(s[i - w], s[i], s[i + w]))
}

fn bilinear(g: &[f32], w: usize, h: usize, p: Point2<f64>) -> f32 {
    let (x, y) = (p.x.clamp(0.0, (w - 2) as f64), p.y.clamp(0.0, (h - 2) as f64));
    let (i, j) = (x as usize, y as usize);
    let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
    let k = j * w + i;
    (g[k] * (1.0 - u) + g[k + 1] * u) * (1.0 - v) + (g[k + w] * (1.0 - u) + g[k + w + 1] * u) * v
}

/// The two edges' directions, if the ring changes sides four times.
fn changes(values: &[f32], mean: f32) -> Option<[Vector2<f64>; 2]> {
    let mut to_dark = Vec::new();
    let mut to_light = Vec::new();
    for n in 0..RING {
        let (a, b) = (values[n] - mean, values[(n + 1) % RING] - mean);
        let place = n as f64 + f64::from(a / (a - b));
        if a > 0.0 && b <= 0.0 {
            to_dark.push(place);
        } else if a <= 0.0 && b > 0.0 {
            to_light.push(place);
        }
    }
    if to_dark.len() != 2 || to_light.len() != 2 {
        return None;
    }
    let line = |p: &[f64]| (turn(p[0]) - turn(p[1])).try_normalize(1e-6);
    let straight = |p: &[f64]| ((p[1] - p[0]) - RING as f64 / 2.0).abs() < 3.5;
    (straight(&to_dark) && straight(&to_light)).then(|| Some([line(&to_dark)?, line(&to_light)?]))?
}

//! What the garment lies on.

use crate::colour::{LinearColour, blend, scale, smoothstep, srgb};
use crate::garment::PlanePoint;
use crate::noise::{fractal, hash, value};

/// A ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ground {
    /// Boards of pale oak.
    Oak,
    /// A bed sheet of natural linen.
    Linen,
}

impl Ground {
    /// Its colour at a place, mm.
    pub(crate) fn at(self, seed: u64, p: PlanePoint) -> LinearColour {
        match self {
            Ground::Oak => oak(seed, p),
            Ground::Linen => linen(seed, p),
        }
    }
}

/// Width of a board, mm.
const BOARD: f64 = 118.0;

fn oak(seed: u64, p: PlanePoint) -> LinearColour {
    let row = (p[0] / BOARD).floor();
    let board = row as i64;
    let tone = hash(seed, board, 1);
    let (x, y) = (p[0] - row * BOARD, p[1] + 700.0 * hash(seed, board, 2));
    let s = seed + 40 * (board.unsigned_abs() + 1);
    // Growth rings: distance from the pith, cut lengthwise, warped by slow noise.
    let warp = 26.0 * fractal(s, x / 60.0, y / 420.0, 3);
    let ring = ((x - 50.0 + 40.0 * tone + warp) / (7.0 + 5.0 * tone)).sin();
    let fibre = fractal(s + 5, x / 0.9, y / 45.0, 3);
    let pore = smoothstep(0.42, 0.62, value(s + 9, x / 0.7, y / 7.0));
    let base = blend(srgb(214, 184, 142), srgb(226, 201, 164), tone);
    let light =
        1.0 + 0.045 * ring + 0.10 * fibre - 0.14 * pore + 0.05 * fractal(s + 12, x / 40.0, y / 200.0, 2);
    let gap = 1.0 - 0.34 * (-(x.min(BOARD - x) / 0.7).powi(2)).exp();
    scale(base, light * gap)
}

fn linen(seed: u64, p: PlanePoint) -> LinearColour {
    let tau = std::f64::consts::TAU;
    let thread = 1.45;
    let bow = 1.2 * value(seed, p[0] / 90.0, p[1] / 90.0);
    let weave = (tau * (p[0] + bow) / thread).sin() * (tau * (p[1] + bow) / thread).sin();
    let slub =
        0.09 * value(seed + 1, p[0] / 1.1, p[1] / 28.0) + 0.09 * value(seed + 2, p[0] / 28.0, p[1] / 1.1);
    let fold = sheet_folds(seed, p);
    scale(srgb(218, 209, 192), 1.0 + 0.05 * weave + slub + fold)
}

/// Long shallow folds of a sheet, lit from the upper left.
fn sheet_folds(seed: u64, p: PlanePoint) -> f64 {
    let e = 2.0;
    let h = |x: f64, y: f64| 9.0 * fractal(seed + 7, (x + 0.6 * y) / 160.0, (y - 0.35 * x) / 420.0, 3);
    let dx = (h(p[0] + e, p[1]) - h(p[0] - e, p[1])) / (2.0 * e);
    let dy = (h(p[0], p[1] + e) - h(p[0], p[1] - e)) / (2.0 * e);
    (0.9 * dx - 0.9 * dy).clamp(-0.16, 0.16)
}

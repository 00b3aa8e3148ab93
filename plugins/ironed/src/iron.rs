//! Takes slow shading out of a picture and leaves edges and grain.
//!
//! Method: of the logarithm of the light two means are taken at each pixel over cloth of about the
//! same level: a near one, as wide as the finest wrinkle, and a far one, wider than the widest.
//! Cloth of one colour has the same far mean everywhere, once it is asked at its own answer a few
//! times (mean shift, Comaniciu & Meer 2002), so near minus far is the shading, and is divided out
//! of the linear colours. Both means are bilateral filters (Tomasi & Manduchi 1998), made on a
//! coarse grid of place and level (Chen, Paris & Durand 2007). Cost: a few operations a pixel, and
//! the grid, some hundred thousand cells. Limits: one level is one colour: a soft gradient of the
//! dye is taken for shading.

use image::RgbImage;
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Cells of the grid that `contrast` spans.
const LEVELS: f64 = 4.0;
/// Half the width of the far mean's box in level, cells: three passes fall off with six tenths of
/// `contrast`.
const FAR_LEVELS: usize = 2;
/// How often the far mean is asked again at its own answer (mean shift): each leaves a quarter of
/// the shading.
const SHIFTS: usize = 3;
/// The darkest light that is told from black.
const BLACK: f64 = 1.0 / 2048.0;
/// The largest grid, cells: finer details are then taken for shading.
const MAX_CELLS: f64 = 8e6;

/// How to iron.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Share of the shading that is taken out.
    pub strength: f64,
    /// Levels that differ by more are another colour, natural logarithm.
    pub contrast: f64,
    /// Anything finer stays, px.
    pub detail: f64,
    /// How far equal cloth is looked for, px.
    pub reach: f64,
}

/// A grid cell: weight, and weighted sum of levels.
type WeightedLevel = [f64; 2];

/// Homogeneous values over place and level.
struct BilateralGrid {
    size: [usize; 3],
    /// Pixels a cell.
    cell: f64,
    /// Levels a cell.
    range: f64,
    cells: Vec<WeightedLevel>,
}

/// Irons the pixels that `inside` marks; gives the picture and the root mean square of what was
/// taken out, a share.
pub fn iron(
    pixels: &RgbImage,
    inside: &[bool],
    settings: &Settings,
    cx: &Context,
) -> Result<(RgbImage, f64), StageError> {
    let (w, h) = pixels.dimensions();
    let levels: Vec<f64> = pixels.pixels().map(|p| level(p.0)).collect();
    let fine = BilateralGrid::of(&levels, inside, (w as usize, h as usize), settings);
    cx.check()?;
    let near = fine.blurred(1, 1, 1, cx)?;
    let far = near.blurred(((settings.reach / near.cell).round() as usize).max(1), FAR_LEVELS, 3, cx)?;
    cx.check()?;
    let shade = |k: usize| {
        let (x, y) = ((k % w as usize) as f64, (k / w as usize) as f64);
        let own = near.at(x, y, levels[k]).filter(|_| inside[k]);
        let Some(own) = own else { return 0.0 };
        own - (0..SHIFTS).fold(levels[k], |at, _| far.at(x, y, at).unwrap_or(at))
    };
    let shades: Vec<f64> = (0..levels.len()).into_par_iter().map(shade).collect();
    cx.check()?;
    let mut out = pixels.clone();
    for (pixel, shade) in out.pixels_mut().zip(&shades).filter(|(_, s)| **s != 0.0) {
        let gain = (-settings.strength * shade).exp();
        pixel.0 = pixel.0.map(|v| encoded(linear(v) * gain));
    }
    let count = inside.iter().filter(|i| **i).count().max(1);
    let square: f64 = shades.iter().map(|s| s * s).sum();
    Ok((out, (square / count as f64).sqrt()))
}

/// Logarithm of the luminance.
fn level(rgb: [u8; 3]) -> f64 {
    let [r, g, b] = rgb.map(linear);
    (0.2126 * r + 0.7152 * g + 0.0722 * b).max(BLACK).ln()
}

/// sRGB to linear light.
pub(crate) fn linear(v: u8) -> f64 {
    let x = f64::from(v) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Linear light to sRGB.
pub(crate) fn encoded(x: f64) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let v = if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (v * 255.0).round() as u8
}

impl BilateralGrid {
    fn of(levels: &[f64], inside: &[bool], (w, h): (usize, usize), settings: &Settings) -> Self {
        let range = settings.contrast / LEVELS;
        let depth = ((-BLACK.ln()) / range).ceil() + 2.0;
        // A picture too large for the grid gets larger cells.
        let least = (w as f64 * h as f64 * depth / MAX_CELLS).sqrt();
        let cell = settings.detail.max(least).max(1.0);
        let count = |n: usize| (n as f64 / cell).ceil() as usize + 2;
        let size = [count(w), count(h), depth as usize];
        let mut grid = BilateralGrid { size, cell, range, cells: vec![[0.0; 2]; size.iter().product()] };
        for (k, &l) in levels.iter().enumerate().filter(|(k, _)| inside[*k]) {
            for (n, share) in grid.around((k % w) as f64, (k / w) as f64, l) {
                grid.cells[n][0] += share;
                grid.cells[n][1] += share * l;
            }
        }
        grid
    }

    /// The eight cells around a place and their shares.
    fn around(&self, x: f64, y: f64, level: f64) -> [(usize, f64); 8] {
        let q = [x / self.cell, y / self.cell, (level - BLACK.ln()) / self.range];
        let base = [0, 1, 2].map(|a| (q[a].max(0.0) as usize).min(self.size[a] - 2));
        let f = [0, 1, 2].map(|a| (q[a] - base[a] as f64).clamp(0.0, 1.0));
        std::array::from_fn(|k| {
            let bit = |a: usize| k >> a & 1;
            let share = |a: usize| if bit(a) == 1 { f[a] } else { 1.0 - f[a] };
            let at = |a: usize| base[a] + bit(a);
            (at(0) + self.size[0] * (at(1) + self.size[1] * at(2)), share(0) * share(1) * share(2))
        })
    }

    /// The mean of what is near a place and level.
    fn at(&self, x: f64, y: f64, level: f64) -> Option<f64> {
        let [weight, sum] = self.around(x, y, level).into_iter().fold([0.0; 2], |s, (n, share)| {
            [s[0] + share * self.cells[n][0], s[1] + share * self.cells[n][1]]
        });
        (weight > 0.0).then(|| sum / weight)
    }

    /// Boxes of `radius` cells in place and `levels` in level, `passes` times (three are nearly a
    /// Gaussian).
    fn blurred(
        &self,
        radius: usize,
        levels: usize,
        passes: usize,
        cx: &Context,
    ) -> Result<BilateralGrid, StageError> {
        let [nx, ny, nl] = self.size;
        let mut cells = self.cells.clone();
        for _ in 0..passes {
            cx.check()?;
            cells.par_chunks_exact_mut(nx).for_each(|row| boxed(row, radius));
            cells.par_chunks_exact_mut(nx * ny).for_each(|layer| {
                let mut column = vec![[0.0; 2]; ny];
                for x in 0..nx {
                    column.iter_mut().enumerate().for_each(|(y, c)| *c = layer[y * nx + x]);
                    boxed(&mut column, radius);
                    column.iter().enumerate().for_each(|(y, c)| layer[y * nx + x] = *c);
                }
            });
            let layer = nx * ny;
            let before = std::mem::replace(&mut cells, vec![[0.0; 2]; layer * nl]);
            cells.par_chunks_exact_mut(layer).enumerate().for_each(|(l, out)| {
                for m in l.saturating_sub(levels)..(l + levels + 1).min(nl) {
                    let from = &before[m * layer..(m + 1) * layer];
                    out.iter_mut().zip(from).for_each(|(o, c)| *o = [o[0] + c[0], o[1] + c[1]]);
                }
            });
        }
        Ok(BilateralGrid { cells, size: self.size, cell: self.cell, range: self.range })
    }
}

/// Sums over `radius` cells on both sides.
fn boxed(line: &mut [WeightedLevel], radius: usize) {
    let n = line.len();
    let mut sums = vec![[0.0; 2]; n + 1];
    for (i, cell) in line.iter().enumerate() {
        sums[i + 1] = [sums[i][0] + cell[0], sums[i][1] + cell[1]];
    }
    for (i, cell) in line.iter_mut().enumerate() {
        let (from, to) = (i.saturating_sub(radius), (i + radius + 1).min(n));
        // Differences of running sums can fall a rounding below zero.
        *cell = [(sums[to][0] - sums[from][0]).max(0.0), sums[to][1] - sums[from][1]];
    }
}

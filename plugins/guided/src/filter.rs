//! The guided filter, with the photo's own channels or a bilaterally smoothed photo as the guide.
//!
//! In every window the output is a line of the guide, q = a g + b, with a = cov(g, p) / (var(g) +
//! noise^2) and b = mean(p) - a mean(g); a pixel takes the mean of the lines of all windows that
//! hold it (He, Sun, Tang 2010, equations 5, 6 and 8). With the photo as its own guide grain near
//! an edge stays, because the guide has it too; a guide that a joint bilateral filter has cleaned
//! (Petschnigg et al. 2004) does not. Window means come from running sums, so the cost is the same
//! for every radius. The photo is worked on in strips of fixed height, in parallel, so that memory
//! stays small and the number of threads changes no bit. Limits: windows are cut off at the frame.

use crate::bilateral;
use image::RgbImage;
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Rows of a strip without its rim; more need more memory, fewer repeat more of the rim.
const STRIP: usize = 128;

/// What guides the filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuidedBy {
    /// Each channel by itself.
    Photo,
    /// Each channel by the same channel after a bilateral filter.
    Bilateral,
}

/// Filters a photo: windows of `radius` pixels, standard deviations below `noise` become flat.
pub fn guided(
    photo: &RgbImage,
    by: GuidedBy,
    radius: usize,
    noise: f64,
    cx: &Context,
) -> Result<RgbImage, StageError> {
    let (w, h) = (photo.width() as usize, photo.height() as usize);
    let mut out = photo.clone();
    if w == 0 || h == 0 {
        return Ok(out);
    }
    let strips: Vec<(usize, &mut [u8])> = out.chunks_mut(3 * w * STRIP).enumerate().collect();
    strips.into_par_iter().try_for_each(|(k, pixels)| {
        cx.check()?;
        let own = k * STRIP..(k * STRIP + STRIP).min(h);
        // A pixel needs the lines of the windows that hold it, and each of these its own pixels.
        let rows = own.start.saturating_sub(2 * radius)..(own.end + 2 * radius).min(h);
        let source = &photo.as_raw()[3 * w * rows.start..3 * w * rows.end];
        let height = rows.len();
        let guide = match by {
            GuidedBy::Photo => None,
            GuidedBy::Bilateral => Some(bilateral::smooth(photo, rows.clone(), noise, cx)?),
        };
        for c in 0..3 {
            let plane: Vec<f32> = source.iter().skip(c).step_by(3).map(|&v| f32::from(v)).collect();
            let guide: Option<Vec<f32>> =
                guide.as_ref().map(|g| g.iter().skip(c).step_by(3).copied().collect());
            let filtered = channel(&plane, guide.as_deref(), (w, height), radius, noise, cx)?;
            let from = (own.start - rows.start) * w;
            for (pixel, v) in pixels.chunks_exact_mut(3).zip(&filtered[from..]) {
                // A line through 8-bit levels may run past them.
                pixel[c] = v.round().clamp(0.0, 255.0) as u8;
            }
        }
        Ok(())
    })?;
    Ok(out)
}

/// Filters one channel; `guide` is the channel itself where it is not given.
fn channel(
    p: &[f32],
    guide: Option<&[f32]>,
    size: (usize, usize),
    radius: usize,
    noise: f64,
    cx: &Context,
) -> Result<Vec<f32>, StageError> {
    let means = |plane: Vec<f32>| -> Result<Vec<f32>, StageError> {
        cx.check()?;
        Ok(window_means(&plane, size, radius))
    };
    let flat = (noise * noise) as f32;
    let g = guide.unwrap_or(p);
    let mean_g = means(g.to_vec())?;
    let mean_gg = means(g.iter().map(|v| v * v).collect())?;
    let own = guide.is_none();
    let mean_p = if own { mean_g.clone() } else { means(p.to_vec())? };
    let mean_gp = if own { mean_gg.clone() } else { means(g.iter().zip(p).map(|(g, p)| g * p).collect())? };
    let line = |i: usize| {
        let variance = (mean_gg[i] - mean_g[i] * mean_g[i]).max(0.0);
        let slope = (mean_gp[i] - mean_g[i] * mean_p[i]) / (variance + flat);
        (slope, mean_p[i] - slope * mean_g[i])
    };
    let (a, b): (Vec<f32>, Vec<f32>) = (0..p.len()).map(line).unzip();
    let (a, b) = (means(a)?, means(b)?);
    Ok((0..p.len()).map(|i| a[i] * g[i] + b[i]).collect())
}

/// The mean over the window around every pixel, by running sums along rows, then down the columns
/// all at once.
fn window_means(plane: &[f32], (w, h): (usize, usize), radius: usize) -> Vec<f32> {
    let mut rows = vec![0.0f32; plane.len()];
    for (row, out) in plane.chunks_exact(w).zip(rows.chunks_exact_mut(w)) {
        running_means(row, out, radius);
    }
    let mut out = vec![0.0; plane.len()];
    let mut sums = vec![0.0f64; w];
    let row = |y: usize| &rows[y * w..(y + 1) * w];
    (0..radius.min(h)).for_each(|y| add(&mut sums, row(y), 1.0));
    for y in 0..h {
        if y + radius < h {
            add(&mut sums, row(y + radius), 1.0);
        }
        if y > radius {
            add(&mut sums, row(y - radius - 1), -1.0);
        }
        let count = (y + radius + 1).min(h) - y.saturating_sub(radius);
        let share = 1.0 / count as f64;
        out[y * w..(y + 1) * w].iter_mut().zip(&sums).for_each(|(o, s)| *o = (s * share) as f32);
    }
    out
}

fn add(sums: &mut [f64], row: &[f32], sign: f64) {
    sums.iter_mut().zip(row).for_each(|(s, v)| *s += sign * f64::from(*v));
}

/// Means over `radius` neighbours on both sides, fewer at the ends.
fn running_means(line: &[f32], out: &mut [f32], radius: usize) {
    let n = line.len();
    let mut sum: f64 = line.iter().take(radius).map(|v| f64::from(*v)).sum();
    for (i, o) in out.iter_mut().enumerate() {
        if i + radius < n {
            sum += f64::from(line[i + radius]);
        }
        if i > radius {
            sum -= f64::from(line[i - radius - 1]);
        }
        *o = (sum / ((i + radius + 1).min(n) - i.saturating_sub(radius)) as f64) as f32;
    }
}

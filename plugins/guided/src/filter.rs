//! The guided filter, each channel guided by itself.
//!
//! In every window the output is a line of the input, q = a p + b, with a = var / (var + noise^2) and
//! b = (1 - a) mean; a pixel takes the mean of the lines of all windows that hold it (He, Sun, Tang
//! 2010, equations 5, 6 and 8). Window means come from running sums, so the cost is the same for
//! every radius: about 60 operations a sample. Limits: windows are cut off at the frame.

use image::RgbImage;
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Filters a photo: windows of `radius` pixels, standard deviations below `noise` become flat.
pub fn guided(photo: &RgbImage, radius: usize, noise: f64, cx: &Context) -> Result<RgbImage, StageError> {
    let size = (photo.width() as usize, photo.height() as usize);
    let channels = (0..3).into_par_iter().map(|c| {
        let plane: Vec<f64> = photo.as_raw().iter().skip(c).step_by(3).map(|&v| f64::from(v)).collect();
        channel(&plane, size, radius, noise, cx)
    });
    let planes = channels.collect::<Result<Vec<_>, StageError>>()?;
    let mut out = photo.clone();
    for (i, pixel) in out.pixels_mut().enumerate() {
        // Means of 8-bit levels stay within 0 to 255.
        pixel.0 = [0, 1, 2].map(|c| planes[c][i].round().clamp(0.0, 255.0) as u8);
    }
    Ok(out)
}

fn channel(
    p: &[f64],
    size: (usize, usize),
    radius: usize,
    noise: f64,
    cx: &Context,
) -> Result<Vec<f64>, StageError> {
    let mean = window_means(p, size, radius, cx)?;
    let squares: Vec<f64> = p.iter().map(|v| v * v).collect();
    let mean_square = window_means(&squares, size, radius, cx)?;
    let slope = |(m, s): (&f64, &f64)| {
        let variance = (s - m * m).max(0.0);
        variance / (variance + noise * noise)
    };
    let a: Vec<f64> = mean.iter().zip(&mean_square).map(slope).collect();
    let b: Vec<f64> = a.iter().zip(&mean).map(|(a, m)| (1.0 - a) * m).collect();
    let (a, b) = (window_means(&a, size, radius, cx)?, window_means(&b, size, radius, cx)?);
    Ok(p.iter().zip(a.iter().zip(&b)).map(|(p, (a, b))| a * p + b).collect())
}

/// The mean over the window around every pixel.
fn window_means(
    plane: &[f64],
    (width, height): (usize, usize),
    radius: usize,
    cx: &Context,
) -> Result<Vec<f64>, StageError> {
    let along = |line: &[f64]| running_means(line, radius);
    let mut rows: Vec<f64> = Vec::with_capacity(plane.len());
    for row in plane.chunks_exact(width.max(1)) {
        cx.check()?;
        rows.extend(along(row));
    }
    let mut out = vec![0.0; plane.len()];
    for x in 0..width {
        cx.check()?;
        let column: Vec<f64> = (0..height).map(|y| rows[y * width + x]).collect();
        along(&column).into_iter().enumerate().for_each(|(y, v)| out[y * width + x] = v);
    }
    Ok(out)
}

/// Means over `radius` neighbours on both sides, fewer at the ends.
fn running_means(line: &[f64], radius: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(line.len() + 1);
    sums.push(0.0);
    line.iter().for_each(|v| sums.push(sums[sums.len() - 1] + v));
    let mean = |i: usize| {
        let (from, to) = (i.saturating_sub(radius), (i + radius + 1).min(line.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..line.len()).map(mean).collect()
}

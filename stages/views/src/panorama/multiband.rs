//! Blending in bands of frequency (Burt, Adelson 1983; of panoramas: Brown, Lowe 2007).
//!
//! A band is the difference of a photo smoothed a little and smoothed more; it is blended over a
//! seam as wide as what it holds is coarse. Smoothing: three means over a window, each in time
//! that does not depend on its width (Wells 1986). Cost: three smoothed copies of each photo.

use super::canvas::PanoramaCanvas;
use rayon::prelude::*;
use toile_core::{Context, StageError};

/// Standard deviations between the bands, px.
const SIGMAS: [f64; 3] = [1.5, 6.0, 24.0];

/// Red, green, blue, each times coverage; coverage.
type Covered = [f32; 4];

/// The colours of the panorama, where `owner` says which photo each pixel belongs to.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn blended(
    canvas: &PanoramaCanvas<'_>,
    owner: &[Option<usize>],
    cx: &Context,
) -> Result<Vec<[f32; 3]>, StageError> {
    let mut picture = vec![[0f32; 3]; owner.len()];
    for band in 0..SIGMAS.len() {
        let mut sums = vec![[0f32; 4]; owner.len()];
        for photo in 0..canvas.photos() {
            cx.check()?;
            add(canvas, photo, owner, band, &mut sums, cx)?;
        }
        for (pixel, [r, g, b, total]) in picture.iter_mut().zip(&sums) {
            if *total > 1e-6 {
                pixel.iter_mut().zip([r, g, b]).for_each(|(p, sum)| *p += sum / total);
            }
        }
    }
    Ok(picture)
}

/// Adds one photo's part of a band.
fn add(
    canvas: &PanoramaCanvas<'_>,
    photo: usize,
    owner: &[Option<usize>],
    band: usize,
    sums: &mut [Covered],
    cx: &Context,
) -> Result<(), StageError> {
    let columns = canvas.columns_of(photo);
    let [width, height] = [columns.len(), canvas.size[1]];
    if width == 0 {
        return Ok(());
    }
    let row = |y: usize| {
        columns.iter().map(move |x| match canvas.sample(photo, *x, y) {
            Some(([r, g, b], _)) => [r, g, b, 1.0],
            None => [0.0; 4],
        })
    };
    let layer: Vec<Covered> = (0..height).into_par_iter().flat_map_iter(row).collect();
    cx.check()?;
    let own = |k: usize| owner.get(k / width * canvas.size[0] + columns[k % width]) == Some(&Some(photo));
    let mask: Vec<[f32; 1]> = (0..width * height).map(|k| [f32::from(u8::from(own(k)))]).collect();
    let weights = smoothed(mask, width, SIGMAS[band]);
    cx.check()?;
    let coarser = SIGMAS.get(band).filter(|_| band + 1 < SIGMAS.len());
    let coarse = coarser.map(|sigma| smoothed(layer.clone(), width, *sigma));
    let fine = band.checked_sub(1).map(|finer| smoothed(layer.clone(), width, SIGMAS[finer]));
    cx.check()?;
    for (k, covered) in layer.iter().enumerate().filter(|(_, c)| c[3] > 0.0) {
        let weight = weights[k][0];
        let at = k / width * canvas.size[0] + columns[k % width];
        let Some(sum) = sums.get_mut(at).filter(|_| weight > 0.0) else { continue };
        let level = |of: &Option<Vec<Covered>>, c: usize| of.as_ref().map(|s| s[k][c] / s[k][3].max(1e-6));
        for (c, total) in sum.iter_mut().enumerate().take(3) {
            let detail = level(&fine, c).unwrap_or(covered[c]) - level(&coarse, c).unwrap_or(0.0);
            *total += weight * detail;
        }
        sum[3] += weight;
    }
    Ok(())
}

/// A picture smoothed, nothing beyond its border.
fn smoothed<const C: usize>(values: Vec<[f32; C]>, width: usize, sigma: f64) -> Vec<[f32; C]> {
    let height = values.len() / width.max(1);
    // Three windows of this width have that standard deviation.
    let radius = (((4.0 * sigma * sigma + 1.0).sqrt() - 1.0) / 2.0).round().max(1.0) as usize;
    let across = transposed(&rows(values, width, radius), width);
    transposed(&rows(across, height, radius), height)
}

/// Three means over a window, row by row.
fn rows<const C: usize>(mut values: Vec<[f32; C]>, width: usize, radius: usize) -> Vec<[f32; C]> {
    values.par_chunks_mut(width.max(1)).for_each(|row| {
        let mut before = row.to_vec();
        for _ in 0..3 {
            before.copy_from_slice(row);
            mean(&before, row, radius);
        }
    });
    values
}

fn mean<const C: usize>(from: &[[f32; C]], to: &mut [[f32; C]], radius: usize) {
    let share = 1.0 / (2 * radius + 1) as f64;
    let mut sum = [0f64; C];
    let mut add = |value: Option<&[f32; C]>, sign: f64| {
        value.into_iter().for_each(|v| (0..C).for_each(|c| sum[c] += sign * f64::from(v[c])));
        sum
    };
    for value in from.iter().take(radius) {
        add(Some(value), 1.0);
    }
    for (x, out) in to.iter_mut().enumerate() {
        add(from.get(x + radius), 1.0);
        *out = add(None, 1.0).map(|s| (s * share) as f32);
        add(x.checked_sub(radius).and_then(|x| from.get(x)), -1.0);
    }
}

fn transposed<const C: usize>(values: &[[f32; C]], width: usize) -> Vec<[f32; C]> {
    let height = values.len() / width.max(1);
    let column = |x: usize| (0..height).map(move |y| values[y * width + x]);
    (0..width).into_par_iter().flat_map_iter(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_becomes_a_bell_of_that_width() {
        let (w, h) = (81, 61);
        let mut point = vec![[0f32]; w * h];
        point[30 * w + 40] = [1.0];
        let bell = smoothed(point, w, 6.0);
        let total: f64 = bell.iter().map(|v| f64::from(v[0])).sum();
        let spread: f64 =
            bell.iter().enumerate().map(|(k, v)| f64::from(v[0]) * ((k % w) as f64 - 40.0).powi(2)).sum();
        assert!((total - 1.0).abs() < 1e-4, "{total}");
        assert!((spread.sqrt() - 6.0).abs() < 0.6, "{}", spread.sqrt());
    }
}

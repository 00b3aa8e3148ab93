//! The panorama's pixels: each photo seen from the cylinder, blended where photos overlap.
//!
//! *Feather*: a photo's weight falls from one in its middle to zero at its border (Szeliski 1996).
//! *Multiband*: each place belongs to the photo that weighs most; coarse detail is blended over
//! a wide seam, fine detail over a narrow one (Burt, Adelson 1983), so that nothing is double.

use super::canvas::{PanoramaCanvas, PhotoSample};
use super::multiband;
use crate::picture::psnr_of;
use image::RgbImage;
use rayon::prelude::*;
use toile_core::prelude::*;

/// How overlapping photos become one picture.
#[choice]
#[derive(Copy, Eq)]
pub enum Blend {
    /// Wide, soft seams: least noise; what moved between the photos is double.
    Feather,
    /// Coarse detail over wide seams, fine detail over narrow ones: nothing is double.
    Multiband,
}

/// A finished picture.
#[derive(Debug)]
pub(super) struct Blended {
    pub(super) pixels: RgbImage,
    pub(super) seen: Vec<bool>,
    /// Of photos against each other where two or more show a place, dB; none where none do.
    pub(super) overlap_psnr: Option<f64>,
}

/// The picture.
///
/// # Errors
/// When the run has been stopped.
pub(super) fn blended(
    canvas: &PanoramaCanvas<'_>,
    blend: Blend,
    cx: &Context,
) -> Result<Blended, StageError> {
    let columns: Vec<Vec<usize>> = (0..canvas.size[0]).map(|x| canvas.of_column(x)).collect();
    let one = |y: usize| {
        cx.check()?;
        Ok(row(canvas, y, &columns))
    };
    let rows: Vec<Result<PanoramaRow, StageError>> = (0..canvas.size[1]).into_par_iter().map(one).collect();
    let rows: Vec<PanoramaRow> = rows.into_iter().collect::<Result<_, _>>()?;
    let (square, n) = rows.iter().fold((0.0, 0), |(s, n), r| (s + r.square, n + r.compared));
    let seen: Vec<bool> = rows.iter().flat_map(|r| r.colours.iter().map(Option::is_some)).collect();
    let colours = match blend {
        Blend::Feather => rows.iter().flat_map(|r| r.colours.iter().map(|c| c.unwrap_or_default())).collect(),
        Blend::Multiband => {
            let owner: Vec<Option<usize>> = rows.iter().flat_map(|r| r.owner.iter().copied()).collect();
            multiband::blended(canvas, &owner, cx)?
        }
    };
    Ok(Blended {
        pixels: picture(&colours, canvas.size),
        seen,
        overlap_psnr: (n > 0).then(|| psnr_of(square / n as f64)),
    })
}

fn row(canvas: &PanoramaCanvas<'_>, y: usize, columns: &[Vec<usize>]) -> PanoramaRow {
    let mut row = PanoramaRow { colours: Vec::new(), owner: Vec::new(), square: 0.0, compared: 0 };
    for (x, photos) in columns.iter().enumerate() {
        let (mut sum, mut total) = ([0f32; 3], 0f32);
        let (mut most, mut second): (Option<(usize, PhotoSample)>, Option<PhotoSample>) = (None, None);
        for k in photos {
            let Some(sample) = canvas.sample(*k, x, y) else { continue };
            (0..3).for_each(|c| sum[c] += sample.0[c] * sample.1);
            total += sample.1;
            if most.is_none_or(|m| sample.1 > m.1.1) {
                second = most.map(|m| m.1);
                most = Some((*k, sample));
            } else if second.is_none_or(|s| sample.1 > s.1) {
                second = Some(sample);
            }
        }
        if let (Some((_, a)), Some(b)) = (most, second) {
            row.square += (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>() / 3.0;
            row.compared += 1;
        }
        row.colours.push((total > 0.0).then(|| sum.map(|s| s / total)));
        row.owner.push(most.map(|m| m.0));
    }
    row
}

/// A row of the panorama.
struct PanoramaRow {
    colours: Vec<Option<[f32; 3]>>,
    /// The photo that weighs most.
    owner: Vec<Option<usize>>,
    /// Sum of squared differences of the two photos that weigh most, and over how many pixels.
    square: f64,
    compared: usize,
}

fn picture(colours: &[[f32; 3]], [w, h]: [usize; 2]) -> RgbImage {
    let mut picture = RgbImage::new(w as u32, h as u32);
    for (pixel, colour) in picture.pixels_mut().zip(colours) {
        pixel.0 = colour.map(|c| (c + 0.5).clamp(0.0, 255.0) as u8);
    }
    picture
}

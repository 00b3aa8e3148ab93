//! The photo at a reduced size in CIE Lab, for methods that look at colours and neighbours.
//!
//! Every small pixel is the mean of its block, so that weave and sensor noise are averaged out.
//! Lab (CIE 15, 1976, white D65): equal distances are about equally visible; a difference of 2.3 is
//! just noticeable.
//!
//! Cost: one look at every pixel of the photo, 12 megapixels take about 15 ms on two cores.

use super::tone::OPAQUE;
use nalgebra::Vector3;
use rayon::prelude::*;
use toile_core::prelude::*;

/// A colour in CIE Lab.
pub type Lab = Vector3<f64>;

/// A photo at a reduced size.
#[derive(Debug, Clone)]
pub(super) struct SmallPhoto {
    /// Pixels across.
    pub w: usize,
    /// Pixels down.
    pub h: usize,
    /// Colours, row by row.
    pub lab: Vec<Lab>,
    /// False where most of the block is transparent.
    pub seen: Vec<bool>,
    /// What a user has marked: true for garment, false for ground.
    pub known: Vec<Option<bool>>,
    /// ln of the odds that each pixel is garment, whatever its colour, where something tells them.
    pub odds: Option<Vec<f64>>,
    /// Pixels of the photo to a pixel of this picture, across and down.
    pub scale: (f64, f64),
}

impl SmallPhoto {
    /// The photo reduced to at most `side` pixels on its longer side.
    pub(super) fn of(photo: &Photo, side: u32) -> SmallPhoto {
        let (pw, ph) = photo.pixels.dimensions();
        let factor = (f64::from(side) / f64::from(pw.max(ph))).min(1.0);
        let fit = |n: u32| ((f64::from(n) * factor).round() as usize).clamp(1, n.max(1) as usize);
        let (w, h) = (fit(pw), fit(ph));
        let rows = (0..h)
            .into_par_iter()
            .flat_map_iter(|y| (0..w).map(move |x| block(photo, cut(x, w, pw), cut(y, h, ph))));
        let (lab, seen) = rows.unzip();
        let known = vec![None; w * h];
        SmallPhoto {
            w,
            h,
            lab,
            seen,
            known,
            odds: None,
            scale: (f64::from(pw) / w as f64, f64::from(ph) / h as f64),
        }
    }

    /// The colours of the marked pixels that are not transparent.
    pub(super) fn colours(&self, marked: &[bool]) -> Vec<Lab> {
        let pixels = self.lab.iter().zip(marked).zip(&self.seen);
        pixels.filter(|((_, m), seen)| **m && **seen).map(|((c, _), _)| *c).collect()
    }

    /// How many pixels lie between a pixel and the frame.
    pub(super) fn depth(&self, i: usize) -> usize {
        let (x, y) = (i % self.w, i / self.w);
        x.min(y).min(self.w - 1 - x).min(self.h - 1 - y)
    }
}

/// The pixels of block `i` of `n` along a side of `size` pixels.
fn cut(i: usize, n: usize, size: u32) -> (u32, u32) {
    let at = |i: usize| (i as u64 * u64::from(size) / n as u64) as u32;
    (at(i), at(i + 1).max(at(i) + 1))
}

fn block(photo: &Photo, (x0, x1): (u32, u32), (y0, y1): (u32, u32)) -> (Lab, bool) {
    let stride = photo.pixels.width() as usize * 3;
    let data = photo.pixels.as_raw();
    let mut sums = [0u64; 3];
    for y in y0 as usize..y1 as usize {
        let row = &data[y * stride + x0 as usize * 3..y * stride + x1 as usize * 3];
        for p in row.chunks_exact(3) {
            (0..3).for_each(|c| sums[c] += u64::from(p[c]));
        }
    }
    let count = f64::from(x1 - x0) * f64::from(y1 - y0);
    let opaque = photo.alpha.as_ref().is_none_or(|a| {
        let pixels = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| a.get_pixel(x, y).0[0] >= OPAQUE).count() as f64 >= count / 2.0
    });
    (lab(sums.map(|s| s as f64 / count)), opaque)
}

/// sRGB (0 to 255) to CIE Lab.
pub fn lab(rgb: [f64; 3]) -> Lab {
    let [r, g, b] = rgb.map(|v| {
        let v = v / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    });
    let x = (0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047;
    let y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
    let z = (0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883;
    let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
    Lab::new(116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z)))
}

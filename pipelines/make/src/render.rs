//! From a garment to its photo: coverage, cloth, shadow, light, lens, sensor.

use crate::cloth::{self, RimFinish, Structure};
use crate::colour::{LinearColour, blend, encode, scale};
use crate::garment::{NamedOutline, PlanePoint};
use crate::ground::Ground;
use crate::near::{NearField, NearestEdge, OutlineRow};
use crate::noise::{fractal, gauss};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// Everything that makes one picture.
pub(crate) struct PhotoSetup {
    pub(crate) seed: u64,
    pub(crate) size: [u32; 2],
    pub(crate) px_per_mm: f64,
    /// Pixel under the pattern's origin; pixel centres lie at integer coordinates.
    pub(crate) origin: PlanePoint,
    pub(crate) ground: Ground,
    pub(crate) structure: Structure,
    pub(crate) base: LinearColour,
    pub(crate) thread: LinearColour,
    pub(crate) print: fn(LinearColour, PlanePoint) -> LinearColour,
    pub(crate) finish: fn(&str) -> RimFinish,
}

/// Blur of the lens, standard deviation in pixels.
const LENS_SIGMA: f64 = 0.75;
/// Sensor noise, standard deviation in sRGB levels at mid grey, before the camera smooths it.
const NOISE: f64 = 2.6;
/// How far the shadow falls to the right and down, mm.
const SHADOW_SHIFT: PlanePoint = [4.0, -6.0];

/// The photo and the true mask (255 where at least half of a pixel is garment).
pub(crate) fn render(shot: &PhotoSetup, outline: &NamedOutline) -> (RgbImage, GrayImage) {
    let field = NearField::new(outline);
    let [w, h] = shot.size;
    let rows: Vec<Vec<(LinearColour, bool)>> =
        (0..h).into_par_iter().map(|y| shot.row(outline, &field, w, y)).collect();
    let mask = GrayImage::from_fn(w, h, |x, y| image::Luma([255 * u8::from(rows[y as usize][x as usize].1)]));
    let light: Vec<Vec<LinearColour>> =
        rows.into_iter().map(|r| r.into_iter().map(|p| p.0).collect()).collect();
    (shot.develop(&blur(&light)), mask)
}

impl PhotoSetup {
    fn row(&self, outline: &NamedOutline, field: &NearField, w: u32, y: u32) -> Vec<(LinearColour, bool)> {
        let py = (self.origin[1] - f64::from(y)) / self.px_per_mm;
        let (here, shifted) = (field.row(py), field.row(py - SHADOW_SHIFT[1]));
        let at = |x: u32| {
            let px = (f64::from(x) - self.origin[0]) / self.px_per_mm;
            let near = here.at(px);
            // A straight rim covers half a pixel when it runs through its centre.
            let cover = (0.5 + near.depth * self.px_per_mm).clamp(0.0, 1.0);
            let ground = if cover < 1.0 { self.ground_at([px, py], &near, &shifted) } else { [0.0; 3] };
            let cloth = if cover > 0.0 { self.cloth_at(outline, [px, py], &near) } else { [0.0; 3] };
            (scale(blend(ground, cloth, cover), self.lamp(x, y)), cover >= 0.5)
        };
        (0..w).map(at).collect()
    }

    fn ground_at(&self, p: PlanePoint, near: &NearestEdge, shifted: &OutlineRow) -> LinearColour {
        let away = (-shifted.at(p[0] - SHADOW_SHIFT[0]).depth).max(0.0);
        let soft = 1.0 - 0.30 * (-away / 9.0).exp();
        let contact = 1.0 - 0.16 * (near.depth.min(0.0) / 2.0).exp();
        scale(self.ground.at(self.seed + 1000, p), soft * contact)
    }

    fn cloth_at(&self, outline: &NamedOutline, p: PlanePoint, near: &NearestEdge) -> LinearColour {
        // Cloth is never laid down quite straight: its print wanders by a millimetre or two.
        let wander = |k: u64| 1.6 * fractal(self.seed + 500 + k, p[0] / 75.0, p[1] / 75.0, 2);
        let printed = (self.print)(self.base, [p[0] + wander(0), p[1] + wander(1)]);
        let rim = (self.finish)(&outline.edges[near.edge].name);
        let finished = cloth::finish(printed, rim, near, self.thread);
        let light = cloth::yarns(self.structure, self.seed, p) * cloth::relief_light(self.seed, p);
        scale(finished, light)
    }

    /// Window light from the upper left, and the lens's darker corners.
    fn lamp(&self, x: u32, y: u32) -> f64 {
        let [u, v] =
            [f64::from(x) / f64::from(self.size[0]) - 0.5, f64::from(y) / f64::from(self.size[1]) - 0.5];
        1.03 - 0.16 * u - 0.18 * v - 0.28 * (u * u + v * v)
    }

    /// Sensor noise and eight bits. A camera averages its noise over neighbours, so it is grainy
    /// rather than salt and pepper.
    fn develop(&self, light: &[Vec<LinearColour>]) -> RgbImage {
        let [w, h] = self.size;
        let grain = |x: u32, y: u32, k: u64| {
            let at = |dx: i64, dy: i64| gauss(self.seed + 77 + k, i64::from(x) + dx, i64::from(y) + dy);
            0.5 * at(0, 0) + 0.25 * (at(1, 0) + at(0, 1)) + 0.2 * at(1, 1)
        };
        let bytes: Vec<u8> = (0..h)
            .into_par_iter()
            .flat_map_iter(|y| (0..w).map(move |x| (x, y)))
            .flat_map_iter(|(x, y)| {
                let luma = grain(x, y, 0);
                let rgb = light[y as usize][x as usize];
                [0, 1, 2].map(|k| {
                    let noise = NOISE * (luma + 0.35 * grain(x, y, 1 + k as u64));
                    (255.0 * encode(rgb[k]) + noise).round().clamp(0.0, 255.0) as u8
                })
            })
            .collect();
        RgbImage::from_raw(w, h, bytes).unwrap_or_default()
    }
}

/// Gaussian blur in linear light, rows then columns, clamped at the border.
fn blur(light: &[Vec<LinearColour>]) -> Vec<Vec<LinearColour>> {
    let weights: Vec<f64> =
        (-3..=3).map(|i| (-f64::from(i * i) / (2.0 * LENS_SIGMA * LENS_SIGMA)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let mean = |at: &dyn Fn(i64) -> LinearColour| {
        let mut sum = [0.0; 3];
        for (i, weight) in weights.iter().enumerate() {
            let v = at(i as i64 - 3);
            (0..3).for_each(|k| sum[k] += weight / total * v[k]);
        }
        sum
    };
    let clamp = |i: i64, n: usize| i.clamp(0, n as i64 - 1) as usize;
    let across: Vec<Vec<LinearColour>> = light
        .par_iter()
        .map(|row| (0..row.len()).map(|x| mean(&|d| row[clamp(x as i64 + d, row.len())])).collect())
        .collect();
    (0..across.len())
        .into_par_iter()
        .map(|y| {
            (0..across[y].len()).map(|x| mean(&|d| across[clamp(y as i64 + d, across.len())][x])).collect()
        })
        .collect()
}

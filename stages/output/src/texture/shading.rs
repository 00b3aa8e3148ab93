//! The light of a photo, apart from the cloth's own colour.
//!
//! A photo is taken as colour times light (the intrinsic images of Barrow and Tenenbaum, 1978).
//! Light changes the lightness of neighbours a little and their hue not at all; print changes hue,
//! or lightness by much. So every step of the logarithm of luminance between neighbours is given to
//! the one or the other (Retinex: Land and McCann, 1971; by hue: Grosse, Johnson, Adelson and
//! Freeman, 2009), and the steps of the light are summed to a picture by Poisson's equation.
//!
//! Light is found on cells of [`CELL`], so what is finer (threads, stitches, ribs) stays in the
//! colour. Its mean over the garment is one: a photo keeps its brightness. Cost: an average over
//! the photo and some hundred rounds on the cells. Limits: a pattern in soft shades of one hue,
//! such as worn denim, counts as light; a fold as steep as print counts as print.

use super::bleed::nearest;
use crate::render::{LINEAR, encode};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;
use toile_core::prelude::*;
use toile_image::grid::{Grid, Steps, StoppingRule};

/// Side of a cell, metres: wider than stitches, narrower than creases.
const CELL: f64 = 3e-3;
/// The most cells along the longer side.
const MOST_CELLS: f64 = 480.0;
/// A step between neighbours is print from this change of chromaticity.
const HUE: f64 = 0.012;
/// Or from this change of the logarithm of luminance, if it is as large between places [`BESIDE`]
/// cells before and behind: across a crease luminance comes back.
const LIGHT: f64 = 0.22;
const BESIDE: usize = 3;
/// From this change on it is print in any case.
const STEEP: f64 = 0.55;
/// Darker than this share of white, hue is noise of the camera.
const DARK: f64 = 0.02;
/// What joins cells beyond the garment: light goes on there evenly.
const BEYOND: f64 = 1e-3;
/// When the rounds end.
const END: StoppingRule = StoppingRule { residual: 1e-5, rounds: 80 };

/// The light of a photo on a grid of cells.
pub(super) struct Shading {
    cell: f64,
    width: usize,
    height: usize,
    /// Logarithm of the light, natural.
    light: Vec<f32>,
}

impl Shading {
    /// The light on the pixels that `inside` marks, in a photo with so many pixels a metre.
    ///
    /// Errors: the run was stopped.
    pub(super) fn of(
        photo: &RgbImage,
        inside: &GrayImage,
        px_per_metre: f64,
        cx: &Context,
    ) -> Result<Shading, StageError> {
        let (w, h) = photo.dimensions();
        let longer = f64::from(w.max(h));
        let cell = (CELL * px_per_metre).max(longer / MOST_CELLS).clamp(1.0, longer);
        let (width, height) = ((f64::from(w) / cell).ceil() as usize, (f64::from(h) / cell).ceil() as usize);
        let mut cells = cells(photo, inside, cell, [width, height]);
        let known: Vec<bool> = cells.iter().map(|c| c.share > 0.5).collect();
        let Some(next) = nearest(|x, y| known[y * width + x], width, height) else {
            return Ok(Shading { cell, width, height, light: vec![0.0; width * height] });
        };
        cells = next.iter().map(|&i| cells[i as usize]).collect();
        let (right, down) = (pairs(&cells, width, 1), pairs(&cells, width, width));
        let weights = |next: usize| -> Vec<f64> {
            let both = |i: usize| known[i] && known[i + next];
            let last = |i: usize| i + next >= known.len() || next == 1 && i % width + 1 == width;
            let weight = |i: usize| {
                if last(i) {
                    0.0
                } else if both(i) {
                    1.0
                } else {
                    BEYOND
                }
            };
            (0..known.len()).map(weight).collect()
        };
        let grid = Grid { width, right: weights(1), down: weights(width) };
        let steps = Steps { right: &right, down: &down };
        let light = grid.sum_of(&steps, &END, cx)?;
        let seen = || light.iter().zip(&known).filter(|(_, k)| **k).map(|(l, _)| *l);
        let mean = seen().sum::<f64>() / seen().count().max(1) as f64;
        Ok(Shading { cell, width, height, light: light.iter().map(|l| (l - mean) as f32).collect() })
    }

    /// Takes the light out of a picture that is a part of the photo: `origin` is the photo's place
    /// of its top left corner and `scale` photo pixels a pixel of it.
    pub(super) fn take_out(&self, part: &mut RgbImage, origin: [f64; 2], scale: [f64; 2]) {
        let width = part.width() as usize;
        part.par_chunks_mut(3 * width.max(1)).enumerate().for_each(|(y, row)| {
            let v = origin[1] + (y as f64 + 0.5) * scale[1];
            for (x, p) in row.chunks_exact_mut(3).enumerate() {
                let factor = (-self.at([origin[0] + (x as f64 + 0.5) * scale[0], v])).exp();
                p.iter_mut().for_each(|c| *c = encode((LINEAR[*c as usize] * factor).min(1.0)));
            }
        });
    }

    /// The logarithm of the light at a place of the photo, between the middles of four cells.
    fn at(&self, place: [f64; 2]) -> f32 {
        let along = |v: f64, count: usize| {
            let v = (v / self.cell - 0.5).clamp(0.0, (count - 1) as f64);
            let first = (v as usize).min(count.saturating_sub(2));
            (first, (v - first as f64) as f32)
        };
        let ((x, fx), (y, fy)) = (along(place[0], self.width), along(place[1], self.height));
        let get =
            |x: usize, y: usize| self.light[y.min(self.height - 1) * self.width + x.min(self.width - 1)];
        let row = |y: usize| get(x, y) * (1.0 - fx) + get(x + 1, y) * fx;
        row(y) * (1.0 - fy) + row(y + 1) * fy
    }
}

/// The mean of a cell's marked pixels.
#[derive(Clone, Copy, Default)]
struct Cell {
    /// Which share of its pixels is marked.
    share: f64,
    /// Logarithm of luminance.
    level: f64,
    /// Chromaticities: the shares of red and green.
    hue: [f64; 2],
}

/// Averages in linear light.
fn cells(photo: &RgbImage, inside: &GrayImage, cell: f64, [width, height]: [usize; 2]) -> Vec<Cell> {
    let (w, h) = (photo.width() as usize, photo.height() as usize);
    let span = |i: usize, most: usize| {
        let from = (i as f64 * cell) as usize;
        from..(((i + 1) as f64 * cell) as usize).clamp(from + 1, most.max(from + 1)).min(most)
    };
    let mean = |k: usize| {
        let (columns, rows) = (span(k % width, w), span(k / width, h));
        let all = columns.len() * rows.len();
        let (mut sum, mut count) = ([0.0_f64; 3], 0.0);
        for y in rows {
            for x in columns.clone() {
                if inside.as_raw()[y * w + x] != 0 {
                    let p = &photo.as_raw()[3 * (y * w + x)..][..3];
                    (0..3).for_each(|c| sum[c] += f64::from(LINEAR[p[c] as usize]));
                    count += 1.0;
                }
            }
        }
        let [r, g, b] = sum.map(|s| s / f64::max(count, 1.0));
        let total = r + g + b + 3.0 * DARK;
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        Cell {
            share: if all > 0 { count / all as f64 } else { 0.0 },
            level: (luminance + DARK / 4.0).ln(),
            hue: [(r + DARK) / total, (g + DARK) / total],
        }
    };
    (0..width * height).into_par_iter().map(mean).collect()
}

/// The step of light from every cell to the one `next` to it: that of luminance, or none where it
/// is print. The feet of a step of print are print as well, for a cell may show both sides of its
/// edge.
fn pairs(cells: &[Cell], width: usize, next: usize) -> Vec<f64> {
    let n = cells.len();
    let last = |i: usize| i + next >= n || next == 1 && i % width + 1 == width;
    let print = |i: usize| {
        if last(i) {
            return false;
        }
        let (a, b) = (&cells[i], &cells[i + next]);
        let hue = (a.hue[0] - b.hue[0]).hypot(a.hue[1] - b.hue[1]);
        let step = (a.level - b.level).abs();
        // Along one row or column, as far as it goes.
        let far = |from: usize, forward: bool| {
            let ahead = |k: usize| if forward { k.checked_add(next) } else { k.checked_sub(next) };
            let in_line = |k: &usize| *k < n && (next != 1 || *k / width == i / width);
            (0..BESIDE).fold(from, |k, _| ahead(k).filter(in_line).unwrap_or(k))
        };
        let stays = || (cells[far(i + next, true)].level - cells[far(i, false)].level).abs() > LIGHT;
        hue > HUE || step > STEEP || step > LIGHT && stays()
    };
    let print: Vec<bool> = (0..n).map(print).collect();
    let near = |i: usize| print[i] || i >= next && print[i - next] || i + next < n && print[i + next];
    let step = |i: usize| if last(i) || near(i) { 0.0 } else { cells[i + next].level - cells[i].level };
    (0..n).map(step).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use image::Rgb;

    /// A photo of 240 px for 24 cm: colours in linear light.
    fn photo(colour: impl Fn(f64, f64) -> [f64; 3]) -> RgbImage {
        RgbImage::from_fn(240, 240, |x, y| Rgb(colour(f64::from(x), f64::from(y)).map(|v| encode(v as f32))))
    }

    /// What is left of it without its light.
    fn without_light(photo: &RgbImage) -> RgbImage {
        let all = GrayImage::from_pixel(240, 240, image::Luma([255]));
        let shading = Shading::of(photo, &all, 1000.0, &Context::quiet()).unwrap();
        let mut part = photo.clone();
        shading.take_out(&mut part, [0.0; 2], [1.0; 2]);
        part
    }

    /// A crease from top to bottom: dark on one side, bright on the other.
    fn crease(x: f64) -> f64 {
        let d = (x - 120.0) / 8.0;
        1.0 - 0.35 * d * (-d * d).exp()
    }

    #[test]
    fn creases_and_uneven_light_leave_one_colour() {
        let creased = photo(|x, y| [0.05, 0.12, 0.3].map(|v| v * crease(x) * (0.8 + y / 600.0)));
        let even = without_light(&creased);
        let spread = |of: &RgbImage| {
            let blue = || of.pixels().map(|p| p.0[2]);
            blue().max().unwrap() - blue().min().unwrap()
        };
        assert!(spread(&creased) > 40, "{}", spread(&creased));
        assert!(spread(&even) < 8, "{}", spread(&even));
    }

    #[test]
    fn a_print_stays_and_the_crease_across_it_goes() {
        let print = |y: f64| if (80.0..160.0).contains(&y) { [0.5, 0.1, 0.05] } else { [0.05, 0.12, 0.3] };
        let even = without_light(&photo(|x, y| print(y).map(|v| v * crease(x))));
        for (y, right) in [(40, print(40.0)), (120, print(120.0)), (200, print(200.0))] {
            for x in [20, 112, 128, 220] {
                let (p, q) = (even.get_pixel(x, y).0, right.map(|v| encode(v as f32)));
                assert!((0..3).all(|c| p[c].abs_diff(q[c]) < 12), "{x} {y}: {p:?} {q:?}");
            }
        }
    }

    #[test]
    fn a_sharp_fold_from_side_to_side_leaves_both_halves_alike() {
        // Pressed into the cloth: bright above, dark below, in light that comes from above.
        let fold = |y: f64| {
            let d = (y - 121.0) / 5.0;
            1.0 - 0.55 * d * (-d * d).exp()
        };
        let even = without_light(&photo(|_, y| [0.12, 0.05, 0.14].map(|v| v * fold(y) * (1.2 - y / 600.0))));
        let red = |y: u32| even.get_pixel(120, y).0[0];
        let (above, below) = (red(60), red(180));
        assert!(above.abs_diff(below) <= 3 && red(110).abs_diff(red(132)) <= 8, "{above} {below}");
    }

    #[test]
    fn stitches_stay() {
        let line = |x: f64| if (119.0..121.0).contains(&x) { 0.7 } else { 1.0 };
        let even = without_light(&photo(|x, _| [0.2 * line(x); 3]));
        let (seam, beside) = (even.get_pixel(119, 120).0[0], even.get_pixel(140, 120).0[0]);
        assert!(beside - seam > 10, "{seam} {beside}");
    }

    #[test]
    fn a_photo_without_the_garment_is_left_as_it_is() {
        let grey = photo(|x, _| [0.2 + x / 1000.0; 3]);
        let none = GrayImage::new(240, 240);
        let shading = Shading::of(&grey, &none, 1000.0, &Context::quiet()).unwrap();
        let mut part = grey.clone();
        shading.take_out(&mut part, [0.0; 2], [1.0; 2]);
        assert_eq!(part, grey);
    }
}

//! Pictures of cloth that repeat: woven yarns and knitted stitches.
//!
//! A woven cloth is a grid of warp and weft yarns, of which the upper one shows (Adanur, *Handbook
//! of Weaving*, 2001); a yarn is a round thread that dives under its neighbour. The face of a knit
//! is columns (wales) of V-shaped stitches. Each yarn differs a little from the next, by numbers
//! that follow from its place alone. Colours are linear light; the mean of a cloth of one colour is
//! that colour.

use super::relief::Relief;
use crate::render::{LINEAR, encode};
use image::{Rgb, RgbImage};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Linear RGB.
pub(super) type Colour = [f32; 3];

/// What a cloth is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ClothKind {
    /// One over, one under.
    Plain(Colour),
    /// Two over, two under, each yarn one on from the last: diagonal ribs.
    Twill(Colour),
    /// Three over, one under: mostly the warp shows, on a weft of another colour.
    Denim { warp: Colour, weft: Colour },
    /// Two columns of stitches that stand out, two that lie back.
    Rib(Colour),
    /// Columns of stitches.
    Jersey(Colour),
    /// Bands of two colours in warp and weft, each half of the repeat wide.
    Check { first: Colour, second: Colour },
    /// Bands of two colours in the warp alone: they run along the grain.
    Stripe { first: Colour, second: Colour },
}

impl ClothKind {
    /// Its colour; the first of two.
    pub(super) fn first(self) -> Colour {
        match self {
            ClothKind::Plain(c) | ClothKind::Twill(c) | ClothKind::Rib(c) | ClothKind::Jersey(c) => c,
            ClothKind::Denim { warp: c, .. }
            | ClothKind::Check { first: c, .. }
            | ClothKind::Stripe { first: c, .. } => c,
        }
    }
}

/// A picture that repeats, and the cloth that it shows.
#[derive(Debug)]
pub(super) struct Tile {
    pub(super) pixels: RgbImage,
    /// Side of the square, metres.
    pub(super) side: f64,
    /// How bright every texel is, in rows: the height of its thread.
    heights: Vec<f32>,
    /// Distance of its yarns or stitches, metres.
    pitch: f64,
}

impl Tile {
    /// The normal map of the same threads: a thread is highest where it is brightest.
    pub(super) fn normal_map(&self, strength: f64) -> RgbImage {
        let (width, height) = (self.pixels.width() as usize, self.pixels.height() as usize);
        let metres = (THICKNESS * self.pitch) as f32;
        let heights = self.heights.iter().map(|h| h * metres).collect();
        Relief { heights, width, height, texel: self.side / width as f64, repeats: true }.normal_map(strength)
    }
}

/// The cloth of a tile in larger texels, of which a whole number makes a repeat.
#[derive(Debug)]
pub(super) struct Swatch {
    texels: Vec<(Colour, f32)>,
    count: usize,
    /// Side of a texel, metres.
    pub(super) texel: f64,
}

/// A swatch's texels are this large at least, metres: a thread of a seam is.
const SWATCH_TEXEL: f64 = 0.4e-3;

impl Tile {
    /// The mean of the threads over texels as near to 0.4 mm as a whole number in a repeat allows,
    /// or as near to `least`, metres, where that is more.
    pub(super) fn swatch(&self, least: f64) -> Swatch {
        let n = self.pixels.width() as usize;
        let count = ((self.side / SWATCH_TEXEL.max(least)).floor() as usize).clamp(1, n);
        let spans: Vec<Vec<(usize, f32)>> = (0..count).map(|k| shares(k, count, n)).collect();
        let metres = (THICKNESS * self.pitch) as f32;
        let mean = |k: usize| {
            let (mut colour, mut height) = ([0.0; 3], 0.0);
            for (j, of_row) in &spans[k / count] {
                for (i, of_column) in &spans[k % count] {
                    let share = of_row * of_column;
                    let own = self.pixels.get_pixel(*i as u32, *j as u32).0;
                    (0..3).for_each(|c| colour[c] += LINEAR[own[c] as usize] * share);
                    height += self.heights[j * n + i] * metres * share;
                }
            }
            (colour, height)
        };
        let texels = (0..count * count).into_par_iter().map(mean).collect();
        Swatch { texels, count, texel: self.side / count as f64 }
    }
}

/// The shares of `n` texels in the k-th of `count` equal parts of their row.
fn shares(k: usize, count: usize, n: usize) -> Vec<(usize, f32)> {
    let [from, to] = [k, k + 1].map(|k| (k * n) as f64 / count as f64);
    let share = |i: usize| ((to.min(i as f64 + 1.0) - from.max(i as f64)) / (to - from)) as f32;
    (from as usize..(to.ceil() as usize).min(n)).map(|i| (i, share(i))).collect()
}

impl Swatch {
    /// Colour and height, metres, of a texel of the plane that the cloth fills.
    pub(super) fn at(&self, i: i64, j: i64) -> (Colour, f32) {
        let [i, j] = [i, j].map(|k| k.rem_euclid(self.count as i64) as usize);
        self.texels[j * self.count + i]
    }
}

/// Width of a tile at least, metres: a repeat of two hand's breadths is not seen among folds.
const SIDE: f64 = 0.064;
/// Distance of yarns, metres: of a shirt, a pair of jeans; and of the wales and courses of a knit.
const YARN: f64 = 0.45e-3;
const HEAVY_YARN: f64 = 0.6e-3;
const STITCH: [f64; 2] = [1.0e-3, 0.8e-3];
/// Yarns that a weave takes to repeat, both ways.
const REPEAT: usize = 4;
/// How much yarns and the places along them differ in brightness, as a share.
const BETWEEN_YARNS: f64 = 0.05;
const ALONG_YARNS: f64 = 0.04;
/// Light at the side of a yarn, where its top has 1.
const SIDE_LIGHT: f64 = 0.55;
/// Light on the columns of a rib that lie back.
const BACK_LIGHT: f64 = 0.72;

/// Height of a thread where its light is 1, as a share of the distance of yarns: they are pressed
/// flat by each other.
const THICKNESS: f64 = 0.5;

/// A tile of `size` by `size` pixels; `repeat` is that of checks and stripes, metres.
pub(super) fn tile(cloth: ClothKind, repeat: f64, size: u32) -> Tile {
    let side = match cloth {
        ClothKind::Check { .. } | ClothKind::Stripe { .. } => (SIDE / repeat).ceil() * repeat,
        _ => SIDE,
    };
    let shade: Box<dyn Fn(f64, f64) -> (f64, Colour) + Sync> = match cloth {
        ClothKind::Plain(c) => woven(side, YARN, |i, j| (i + j) % 2 == 0, move |_| c, move |_| c),
        ClothKind::Twill(c) => woven(side, YARN, |i, j| (i + j) % 4 < 2, move |_| c, move |_| c),
        ClothKind::Denim { warp, weft } => {
            woven(side, HEAVY_YARN, |i, j| (i + j) % 4 != 0, move |_| warp, move |_| weft)
        }
        ClothKind::Rib(c) => knit(side, c, true),
        ClothKind::Jersey(c) => knit(side, c, false),
        ClothKind::Check { first, second } => {
            let band = move |s: f64| if (s * side / repeat).fract() < 0.5 { first } else { second };
            woven(side, YARN, |i, j| (i + j) % 2 == 0, band, band)
        }
        ClothKind::Stripe { first, second } => {
            let band = move |s: f64| if (s * side / repeat).fract() < 0.5 { first } else { second };
            // The weft goes under: its colour would show as dots.
            woven(side, YARN, |_, _| true, band, band)
        }
    };
    let n = size as usize;
    let at = |k: usize| shade(((k % n) as f64 + 0.5) / n as f64, ((k / n) as f64 + 0.5) / n as f64);
    let texels: Vec<(f64, Colour)> = (0..n * n).into_par_iter().map(at).collect();
    let mean = texels.iter().map(|t| t.0).sum::<f64>() / texels.len() as f64;
    let mut pixels = RgbImage::new(size, size);
    for (pixel, (light, colour)) in pixels.pixels_mut().zip(&texels) {
        *pixel = Rgb(colour.map(|c| encode(c * (light / mean) as f32)));
    }
    let pitch = match cloth {
        ClothKind::Denim { .. } => HEAVY_YARN,
        ClothKind::Rib(_) | ClothKind::Jersey(_) => STITCH[0],
        _ => YARN,
    };
    Tile { pixels, side, heights: texels.iter().map(|t| t.0 as f32).collect(), pitch }
}

/// A weave: which yarn is up where warp `i` meets weft `j`, and the colours of yarns by their
/// place, 0 to 1.
fn woven(
    side: f64,
    yarn: f64,
    warp_is_up: impl Fn(usize, usize) -> bool + Sync + 'static,
    warp: impl Fn(f64) -> Colour + Sync + 'static,
    weft: impl Fn(f64) -> Colour + Sync + 'static,
) -> Box<dyn Fn(f64, f64) -> (f64, Colour) + Sync> {
    let count = REPEAT * (side / yarn / REPEAT as f64).round().max(1.0) as usize;
    Box::new(move |x, y| {
        let (u, v) = (x * count as f64, y * count as f64);
        let (i, j) = (u as usize % count, v as usize % count);
        let is_warp = warp_is_up(i, j);
        // Across the yarn that shows, and along it.
        let ((across, k, along), colour) = match is_warp {
            true => ((u.fract(), i, y), warp((i as f64 + 0.5) / count as f64)),
            false => ((v.fract(), count + j, x), weft((j as f64 + 0.5) / count as f64)),
        };
        // It dives at the end of a float only.
        let lies_on = |towards_end: bool| match (is_warp, towards_end) {
            (true, false) => warp_is_up(i, (j + count - 1) % count),
            (true, true) => warp_is_up(i, (j + 1) % count),
            (false, false) => !warp_is_up((i + count - 1) % count, j),
            (false, true) => !warp_is_up((i + 1) % count, j),
        };
        let lengthwise = if is_warp { v.fract() } else { u.fract() };
        let dive = if lies_on(lengthwise > 0.5) { 1.0 } else { (PI * lengthwise).sin().sqrt() };
        (round(across) * (0.7 + 0.3 * dive) * uneven(k, along), colour)
    })
}

/// The face of a knit, with ribs of two columns or without.
fn knit(side: f64, colour: Colour, ribbed: bool) -> Box<dyn Fn(f64, f64) -> (f64, Colour) + Sync> {
    let count = |pitch: f64| REPEAT * (side / pitch / REPEAT as f64).round().max(1.0) as usize;
    let [wales, courses] = STITCH.map(count);
    Box::new(move |x, y| {
        let (u, v) = (x * wales as f64, y * courses as f64);
        let wale = u as usize % wales;
        // The legs of the V lean outwards and upwards from the middle of their column.
        let from_middle = (u.fract() - 0.5).abs() * 2.0;
        let leg = v + 0.75 * from_middle;
        let course = leg.floor() as usize % courses;
        let light =
            round(leg.fract()) * (0.55 + 0.45 * round(from_middle)) * uneven(wale * courses + course, x);
        let lies_back = ribbed && wale % 4 >= 2;
        (if lies_back { BACK_LIGHT * light } else { light }, colour)
    })
}

/// Light across a round thread, at its sides and on its top.
fn round(across: f64) -> f64 {
    SIDE_LIGHT + (1.0 - SIDE_LIGHT) * (PI * across).sin()
}

/// How bright yarn `k` is at a place along it, 0 to 1; the same at both ends.
fn uneven(k: usize, along: f64) -> f64 {
    const KNOTS: usize = 8;
    let at = along * KNOTS as f64;
    let knot = |n: usize| noise(k, 1 + n % KNOTS);
    let t = at.fract();
    let smooth = t * t * (3.0 - 2.0 * t);
    let place = knot(at as usize) * (1.0 - smooth) + knot(at as usize + 1) * smooth;
    1.0 + BETWEEN_YARNS * noise(k, 0) + ALONG_YARNS * place
}

/// A number from -1 to 1 that follows from two others (the finaliser of SplitMix64, Steele 2014).
fn noise(a: usize, b: usize) -> f64 {
    let mut z = (a as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add((b as u64) << 32 | 0x5bd1);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_swatch_is_the_mean_of_its_tile() {
        let tile = tile(ClothKind::Twill(BLUE), 0.02, 100);
        let swatch = tile.swatch(0.064 / 7.0);
        assert_eq!(swatch.count, 7);
        let sum: f32 = (0..49).map(|k| swatch.at(k % 7, k / 7).0[2]).sum();
        let whole: f32 = tile.pixels.pixels().map(|p| LINEAR[p.0[2] as usize]).sum();
        assert!((sum / 49.0 - whole / 1e4).abs() < 1e-4, "{} {}", sum / 49.0, whole / 1e4);
        assert_eq!(swatch.at(-1, 8), swatch.at(6, 1), "it repeats");
        assert!((0..7).all(|k| (shares(k, 7, 100).iter().map(|s| s.1).sum::<f32>() - 1.0).abs() < 1e-6));
    }

    const BLUE: Colour = [0.05, 0.1, 0.3];
    const WHITE: Colour = [0.8, 0.8, 0.8];

    fn mean(pixels: &RgbImage, over: impl Fn(u32, u32) -> bool) -> Colour {
        let picked: Vec<[u8; 3]> =
            pixels.enumerate_pixels().filter(|(x, y, _)| over(*x, *y)).map(|(_, _, p)| p.0).collect();
        [0, 1, 2].map(|c| picked.iter().map(|p| LINEAR[p[c] as usize]).sum::<f32>() / picked.len() as f32)
    }

    #[test]
    fn the_mean_of_a_cloth_of_one_colour_is_that_colour() {
        for cloth in
            [ClothKind::Plain(BLUE), ClothKind::Twill(BLUE), ClothKind::Rib(BLUE), ClothKind::Jersey(BLUE)]
        {
            let found = mean(&tile(cloth, 0.02, 512).pixels, |_, _| true);
            for c in 0..3 {
                assert!((found[c] / BLUE[c] - 1.0).abs() < 0.03, "{cloth:?}: {found:?}");
            }
        }
    }

    #[test]
    fn denim_shows_three_quarters_of_its_warp() {
        let tile = tile(ClothKind::Denim { warp: BLUE, weft: WHITE }, 0.02, 1024);
        let found = mean(&tile.pixels, |_, _| true);
        let blend = [0, 1, 2].map(|c| 0.75 * BLUE[c] + 0.25 * WHITE[c]);
        for c in 0..3 {
            assert!((found[c] / blend[c] - 1.0).abs() < 0.1, "{found:?} {blend:?}");
        }
    }

    #[test]
    fn stripes_run_along_the_grain_and_checks_both_ways() {
        let band = |cloth| {
            let tile = tile(cloth, 0.032, 512);
            assert_eq!(tile.side, 0.064);
            // Two repeats of 256 px: a band of each colour is 128 px wide.
            let part = |x0: u32, y0: u32| mean(&tile.pixels, |x, y| x / 128 == x0 && y / 128 == y0)[2];
            [part(0, 0), part(1, 0), part(0, 1), part(1, 1)]
        };
        let [a, b, c, d] = band(ClothKind::Stripe { first: BLUE, second: WHITE });
        assert!(b > 2.0 * a && (c / a - 1.0).abs() < 0.05 && (d / b - 1.0).abs() < 0.05, "{a} {b} {c} {d}");
        let [a, b, c, d] = band(ClothKind::Check { first: BLUE, second: WHITE });
        assert!(b > 1.3 * a && (c / b - 1.0).abs() < 0.05 && d > 1.3 * b, "{a} {b} {c} {d}");
    }

    #[test]
    fn threads_of_a_normal_map_lean_to_both_sides_alike_and_stand_upright_in_the_mean() {
        for cloth in
            [ClothKind::Plain(BLUE), ClothKind::Denim { warp: BLUE, weft: WHITE }, ClothKind::Rib(BLUE)]
        {
            let map = tile(cloth, 0.02, 512).normal_map(1.0);
            let mean = |c: usize| map.pixels().map(|p| f64::from(p.0[c])).sum::<f64>() / (512.0 * 512.0);
            assert!((mean(0) - 127.5).abs() < 2.0 && (mean(1) - 127.5).abs() < 4.0, "{cloth:?}");
            // Some 10 degrees on average, and nowhere beyond 60; this tile has but four texels a
            // yarn.
            assert!((230.0..253.0).contains(&mean(2)), "{cloth:?}: {}", mean(2));
            assert!(map.pixels().all(|p| p.0[2] > 191), "{cloth:?}");
        }
    }

    #[test]
    fn a_tile_goes_on_where_it_begins() {
        for cloth in
            [ClothKind::Twill(BLUE), ClothKind::Jersey(BLUE), ClothKind::Check { first: BLUE, second: WHITE }]
        {
            let pixels = tile(cloth, 0.02, 1024).pixels;
            let step = |a: u32, b: u32| -> f64 {
                let difference = |y: u32| pixels.get_pixel(a, y).0[2].abs_diff(pixels.get_pixel(b, y).0[2]);
                (0..1024).map(|y| f64::from(difference(y))).sum::<f64>() / 1024.0
            };
            // Over its edge it changes by no more than from one yarn to the next, in half of a
            // repeat.
            let most = (512..512 + 32).map(|x| step(x, x + 1)).fold(0.0, f64::max);
            assert!(step(1023, 0) <= 1.5 * most + 1.0, "{cloth:?}: {} {most}", step(1023, 0));
        }
    }
}

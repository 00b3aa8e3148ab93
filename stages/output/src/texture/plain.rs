//! A side that no photo shows: the other side's cloth, without print, label, fly, zip, pocket or
//! seam.
//!
//! The cloth's colour is the one that covers more than half of the picture, or else the commonest
//! one along the outline, where prints are rare. What differs from it in hue, or in lightness from
//! the cloth around it, is print. Without it the cloth's light and colour are averaged over wide
//! squares (a pyramid of averages: Gortler, Grzeszczuk, Szeliski and Cohen, The lumigraph, 1996),
//! and take the weave of the evenest square of plain cloth. A pattern all over the garment is the
//! cloth's own: then the picture stays as it is, with all that it shows.
//!
//! Cost: a few looks at every pixel. Limits: a garment of two colours keeps both only where each
//! has much of the outline.

use super::bleed::eroded;
use crate::render::LINEAR;
use image::imageops::{FilterType, resize};
use image::{GrayImage, Luma, RgbImage};
use nalgebra::Vector3;
use toile_image::binarise::{Regions, close, dilate, lab};

/// The longer side at which print is looked for, px.
const SMALL: u32 = 256;
/// Width of the band along the outline, as a share of the root of the garment's area.
const BAND: f64 = 0.12;
/// What covers more than this share of a picture is cloth: a print is smaller.
const HALF: f64 = 0.5;
/// Width of a bin of hues, Lab units.
const BIN: f64 = 4.0;
/// Cloth lies within this distance of its colour in hue.
const HUE: f64 = 12.0;
/// Cloth lies within these distances of a lightness: that of the whole cloth, and that of the cloth
/// around.
const LIGHT: [f64; 2] = [30.0, 10.0];
/// If more than this share of the band, or of the whole, differs, it is a pattern of the cloth.
const PATTERN: [f64; 2] = [0.2, 0.6];
/// Squares along the longer side in which marks are looked for, and the share of them with marks
/// from which these are a pattern.
const SQUARES: usize = 12;
const MOST_SPREAD: f64 = 0.9;
/// Cloth whose colours differ by less, Lab units, has no pattern: folds and uneven light do. Of 87
/// garments that were looked at, all that differed by less were plain but five with fine, faint or
/// wide patterns.
const CONTRAST: f64 = 3.4;
/// And a pattern differs everywhere by at least this share of what it differs by in a tenth of the
/// squares: of 250 garments 17 differ by enough and not so evenly, of which 14 have a print on
/// creased cloth, or are plain.
const EVEN: f64 = 0.45;
/// Pieces of fewer small pixels are no print.
const SPECK: u64 = 5;
/// How far print reaches beyond what is surely print, small pixels.
const AROUND: u32 = 3;
/// Light is averaged over squares of this share of the picture's shorter side: wider than a fly or
/// a zip.
const WIDE: f64 = 0.12;
/// Side of the square of weave, as a share of the picture's shorter side.
const SQUARE: f64 = 0.12;
/// The least side of the square of weave, px.
const LEAST_SQUARE: usize = 8;
/// The greatest side of the square of weave, px.
const GREATEST_SQUARE: usize = 128;

/// What a picture of cloth shows.
enum ShownCloth {
    /// A pattern all over, or no cloth.
    Pattern,
    /// Cloth, but where this is marked.
    Cloth(GrayImage),
}

/// Makes a picture of cloth plain; false where a pattern covers all of it, or where there is no
/// cloth: then it stays. `sure` marks the cloth.
pub(super) fn plain(pixels: &mut RgbImage, sure: &GrayImage) -> bool {
    let ShownCloth::Cloth(print) = shown(pixels, sure) else { return false };
    let keep = |x: u32, y: u32| sure.get_pixel(x, y).0[0] != 0 && print.get_pixel(x, y).0[0] == 0;
    let kept = GrayImage::from_fn(pixels.width(), pixels.height(), |x, y| Luma([u8::from(keep(x, y)) * 255]));
    let wide = f64::from(pixels.width().min(pixels.height())) * WIDE;
    let Some(light) = SpreadColours::from_level(pixels, &kept, wide.max(1.0).log2().round() as usize) else {
        return false;
    };
    let weave = Weave::of(pixels, &kept);
    for (x, y, p) in pixels.enumerate_pixels_mut() {
        let colour = light.at(x, y);
        let thread = weave.as_ref().map_or([0.0; 3], |w| w.at(x as usize, y as usize));
        p.0 = [0, 1, 2].map(|c| (colour[c] + thread[c]).round().clamp(0.0, 255.0) as u8);
    }
    true
}

/// The commonest colour of a picture that is cloth all over, linear light.
pub(super) fn cloth_colour(pixels: &RgbImage) -> Option<[f32; 3]> {
    let (w, h) = small_size(pixels);
    let small = resize(pixels, w, h, FilterType::Triangle);
    let colours: Vec<Vector3<f64>> = small.pixels().map(|p| lab(p.0.map(f64::from))).collect();
    let cloth = commonest(&colours, &vec![true; colours.len()])?;
    let far = |c: &Vector3<f64>| (c - cloth).norm() > HUE;
    let (mut sum, mut count) = ([0.0_f32; 3], 0.0_f32);
    for (p, _) in small.pixels().zip(&colours).filter(|(_, c)| !far(c)) {
        (0..3).for_each(|k| sum[k] += LINEAR[p.0[k] as usize]);
        count += 1.0;
    }
    (count > 0.0).then(|| sum.map(|s| s / count))
}

/// The size at which print is looked for.
fn small_size(pixels: &RgbImage) -> (u32, u32) {
    let (w, h) = pixels.dimensions();
    let scale = (f64::from(SMALL) / f64::from(w.max(h))).min(1.0);
    let size = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    (size(w), size(h))
}

/// What the picture shows, at its own size.
fn shown(pixels: &RgbImage, sure: &GrayImage) -> ShownCloth {
    let (w, h) = pixels.dimensions();
    let (small_w, small_h) = small_size(pixels);
    let small = resize(pixels, small_w, small_h, FilterType::Triangle);
    let inside = resize(sure, small_w, small_h, FilterType::Triangle);
    let inside = GrayImage::from_fn(small_w, small_h, |x, y| {
        Luma([u8::from(inside.get_pixel(x, y).0[0] == 255) * 255])
    });
    let Some(ShownCloth::Cloth(found)) = shown_in(&small, &inside) else { return ShownCloth::Pattern };
    let large = resize(&found, w, h, FilterType::Triangle);
    ShownCloth::Cloth(GrayImage::from_fn(w, h, |x, y| {
        Luma([u8::from(large.get_pixel(x, y).0[0] > 127) * 255])
    }))
}

/// `None` where there is no cloth.
fn shown_in(small: &RgbImage, inside: &GrayImage) -> Option<ShownCloth> {
    let on: Vec<bool> = inside.as_raw().iter().map(|v| *v != 0).collect();
    let area = on.iter().filter(|on| **on).count() as f64;
    let core = eroded(inside, BAND * area.sqrt());
    let band: Vec<bool> = on.iter().zip(core.as_raw()).map(|(on, core)| *on && *core == 0).collect();
    let colours: Vec<Vector3<f64>> = small.pixels().map(|p| lab(p.0.map(f64::from))).collect();
    let is_of = |cloth: &Vector3<f64>, i: usize| {
        let d = colours[i] - cloth;
        on[i] && d.y.hypot(d.z) < HUE && d.x.abs() < LIGHT[0]
    };
    let covers = |cloth: &Vector3<f64>| (0..on.len()).filter(|i| is_of(cloth, *i)).count() as f64;
    let most = commonest(&colours, &on)?;
    let cloth = if covers(&most) > HALF * area { most } else { commonest(&colours, &band)? };
    let like = |i: usize| is_of(&cloth, i);
    let (w, h) = small.dimensions();
    let alike = GrayImage::from_fn(w, h, |x, y| Luma([u8::from(like((y * w + x) as usize)) * 255]));
    // The lightness of the cloth around, as a picture of three equal channels.
    let grey =
        RgbImage::from_fn(w, h, |x, y| image::Rgb([(colours[(y * w + x) as usize].x * 2.55) as u8; 3]));
    let around = SpreadColours::blurred(&grey, &alike)?;
    let differs = |i: usize| {
        let here = around.at(i as u32 % w, i as u32 / w)[0] / 2.55;
        on[i] && (!like(i) || (colours[i].x - here).abs() > LIGHT[1])
    };
    let found = GrayImage::from_fn(w, h, |x, y| Luma([u8::from(differs((y * w + x) as usize)) * 255]));
    let found = without_specks(close(&found, 1));
    let marked =
        |of: &[bool]| found.as_raw().iter().zip(of).filter(|(v, of)| **v != 0 && **of).count() as f64;
    let share = |of: &[bool]| marked(of) / of.iter().filter(|on| **on).count().max(1) as f64;
    let is_marked = share(&on) > PATTERN[1] || share(&band) > PATTERN[0] || spread(&found, &on) > MOST_SPREAD;
    let [everywhere, most] = contrast(small, inside, &colours, &on)?;
    let is_pattern = is_marked && everywhere >= CONTRAST && everywhere >= EVEN * most;
    Some(match is_pattern {
        true => ShownCloth::Pattern,
        false => ShownCloth::Cloth(dilate(&close(&found, AROUND), AROUND)),
    })
}

/// The pixels of each square that cloth fills.
fn squares((w, h): (u32, u32), on: &[bool]) -> Vec<Vec<usize>> {
    let (w, h) = (w as usize, h as usize);
    let side = (w.max(h) / SQUARES).max(1);
    let corners = (0..h / side).flat_map(|r| (0..w / side).map(move |c| (r * side, c * side)));
    let pixels = |(top, left): (usize, usize)| -> Vec<usize> {
        (top..top + side).flat_map(|y| (left..left + side).map(move |x| y * w + x)).collect()
    };
    corners.map(pixels).filter(|square| square.iter().all(|i| on[*i])).collect()
}

/// In which share of the squares that cloth fills there is something marked: a print stands
/// somewhere, a pattern everywhere.
fn spread(found: &GrayImage, on: &[bool]) -> f64 {
    let filled = squares(found.dimensions(), on);
    let marked = filled.iter().filter(|square| square.iter().any(|i| found.as_raw()[*i] != 0)).count();
    if filled.is_empty() { 0.0 } else { marked as f64 / filled.len() as f64 }
}

/// How far colours differ from those around them, Lab units, in all but a quarter of the squares
/// that cloth fills, and in a tenth of them; `None` where there is no cloth.
fn contrast(small: &RgbImage, inside: &GrayImage, colours: &[Vector3<f64>], on: &[bool]) -> Option<[f64; 2]> {
    let around = SpreadColours::blurred(small, inside)?;
    let w = small.width();
    let differs = |i: usize| (colours[i] - lab(around.at(i as u32 % w, i as u32 / w))).norm();
    let filled = squares(small.dimensions(), on);
    let mean = |square: &Vec<usize>| square.iter().map(|i| differs(*i)).sum::<f64>() / square.len() as f64;
    let mut means: Vec<f64> = filled.iter().map(mean).collect();
    means.sort_by(f64::total_cmp);
    Some([means.len() / 4, means.len() * 9 / 10].map(|k| means.get(k).copied().unwrap_or(0.0)))
}

/// The mask without pieces too small for a letter: the weave's own.
fn without_specks(mask: GrayImage) -> GrayImage {
    Regions::of(&mask).paint(|_, piece| piece.on && piece.area >= SPECK)
}

/// The commonest hue of the marked pixels, with the mean colour of those that have it.
fn commonest(colours: &[Vector3<f64>], marked: &[bool]) -> Option<Vector3<f64>> {
    let bin = |v: f64| ((v / BIN).floor() as i32 + 32).clamp(1, 62) as usize;
    let mut bins = vec![0_u32; 64 * 64];
    let seen = || colours.iter().zip(marked).filter(|(_, on)| **on).map(|(c, _)| c);
    seen().for_each(|c| bins[bin(c.y) * 64 + bin(c.z)] += 1);
    let around =
        |i: usize| [0, 1, 63, 64, 65].iter().map(|d| bins[i + d] + bins[i.saturating_sub(*d)]).sum::<u32>();
    let best =
        (65..64 * 64 - 65).max_by_key(|&i| (around(i), std::cmp::Reverse(i))).filter(|&i| around(i) > 0)?;
    let (row, column) = (best / 64, best % 64);
    let near = |c: &&Vector3<f64>| bin(c.y).abs_diff(row) <= 1 && bin(c.z).abs_diff(column) <= 1;
    let (sum, count) = seen().filter(near).fold((Vector3::zeros(), 0.0), |(s, n), c| (s + c, n + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// Colours known at some pixels, carried on to all others by averages of ever larger squares.
struct SpreadColours {
    width: usize,
    colours: Vec<[f64; 3]>,
}

/// Pixels of a level: the sum of the colours known below it, and how many they are.
type ColourLevel = (usize, usize, Vec<([f64; 3], f64)>);

impl SpreadColours {
    /// The colours of the known, as averages of squares of 16 pixels.
    fn blurred(pixels: &RgbImage, known: &GrayImage) -> Option<SpreadColours> {
        Self::from_level(pixels, known, 4)
    }

    /// The same, as averages of squares of 2 to the power of `finest`; `None` where no pixel is
    /// known.
    fn from_level(pixels: &RgbImage, known: &GrayImage, finest: usize) -> Option<SpreadColours> {
        let (w, h) = (pixels.width() as usize, pixels.height() as usize);
        let first = pixels.pixels().zip(known.as_raw()).map(|(p, on)| match on {
            0 => ([0.0; 3], 0.0),
            _ => (p.0.map(f64::from), 1.0),
        });
        let mut levels: Vec<ColourLevel> = vec![(w, h, first.collect())];
        while levels[levels.len() - 1].0.max(levels[levels.len() - 1].1) > 1 {
            levels.push(halved(&levels[levels.len() - 1]));
        }
        let top = levels.len() - 1;
        if levels[top].2.first().is_none_or(|(_, n)| *n <= 0.0) {
            return None;
        }
        let mut colours = vec![mean(&levels[top].2[0])];
        let mut size = (1, 1);
        for (index, (w, h, sums)) in levels.iter().enumerate().rev().skip(1) {
            let finer = |i: usize| {
                let own = &sums[i];
                let above = between(&colours, size, (i % w) as f64 / 2.0 - 0.25, (i / w) as f64 / 2.0 - 0.25);
                match own.1 > 0.0 && index >= finest {
                    true => {
                        // A square that is half known is half its own.
                        let share = (own.1 / 4_f64.powi(index as i32)).min(1.0);
                        let own = mean(own);
                        [0, 1, 2].map(|c| share * own[c] + (1.0 - share) * above[c])
                    }
                    false => above,
                }
            };
            colours = (0..w * h).map(finer).collect();
            size = (*w, *h);
        }
        Some(SpreadColours { width: w, colours })
    }

    fn at(&self, x: u32, y: u32) -> [f64; 3] {
        self.colours[y as usize * self.width + x as usize]
    }
}

fn mean((sum, count): &([f64; 3], f64)) -> [f64; 3] {
    sum.map(|s| s / count.max(1.0))
}

fn halved((w, h, fine): &ColourLevel) -> ColourLevel {
    let (cw, ch) = (w.div_ceil(2), h.div_ceil(2));
    let mut coarse = vec![([0.0; 3], 0.0); cw * ch];
    for (i, (sum, count)) in fine.iter().enumerate() {
        let to = &mut coarse[(i / w / 2) * cw + i % w / 2];
        (0..3).for_each(|c| to.0[c] += sum[c]);
        to.1 += count;
    }
    (cw, ch, coarse)
}

/// A colour between pixels' centres; beyond the border that of the border.
fn between(colours: &[[f64; 3]], (w, h): (usize, usize), x: f64, y: f64) -> [f64; 3] {
    let (x, y) = (x.clamp(0.0, (w - 1) as f64), y.clamp(0.0, (h - 1) as f64));
    let (x0, y0) = (x.floor() as usize, y.floor() as usize);
    let (x1, y1) = ((x0 + 1).min(w - 1), (y0 + 1).min(h - 1));
    let (fx, fy) = (x - x0 as f64, y - y0 as f64);
    let at = |x: usize, y: usize| colours[y * w + x];
    [0, 1, 2].map(|c| {
        let above = at(x0, y0)[c] * (1.0 - fx) + at(x1, y0)[c] * fx;
        let below = at(x0, y1)[c] * (1.0 - fx) + at(x1, y1)[c] * fx;
        above * (1.0 - fy) + below * fy
    })
}

/// What a square of plain cloth has beyond its own light: its threads and its grain.
struct Weave {
    side: usize,
    threads: Vec<[f64; 3]>,
}

impl Weave {
    /// `None` where no square of plain cloth is large enough to show a weave.
    fn of(pixels: &RgbImage, kept: &GrayImage) -> Option<Weave> {
        let (w, h) = (pixels.width() as usize, pixels.height() as usize);
        let side = ((w.min(h) as f64 * SQUARE) as usize).clamp(LEAST_SQUARE, GREATEST_SQUARE);
        let step = (side / 2).max(w.min(h) / 12).max(1);
        let starts = |n: usize| (0..=n.saturating_sub(side)).step_by(step);
        let corners = starts(h).flat_map(|top| starts(w).map(move |left| [left, top]));
        let is_kept = |[left, top]: &[usize; 2]| {
            top + side <= h
                && left + side <= w
                && (*top..top + side)
                    .all(|y| kept.as_raw()[y * w + left..y * w + left + side].iter().all(|v| *v != 0))
        };
        // The evenest: a seam or a crease would be laid out all over.
        let found = corners.filter(is_kept).filter_map(|at| Weave::at_place(pixels, at, side));
        found.min_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))
    }

    fn at_place(pixels: &RgbImage, [left, top]: [usize; 2], side: usize) -> Option<Weave> {
        let cut =
            image::imageops::crop_imm(pixels, left as u32, top as u32, side as u32, side as u32).to_image();
        let all = GrayImage::from_pixel(side as u32, side as u32, Luma([255]));
        let light = SpreadColours::from_level(&cut, &all, 3)?;
        let thread = |(x, y, p): (u32, u32, &image::Rgb<u8>)| {
            let light = light.at(x, y);
            [0, 1, 2].map(|c| f64::from(p.0[c]) - light[c])
        };
        Some(Weave { side, threads: cut.enumerate_pixels().map(thread).collect() })
    }

    /// The mean square of what its threads differ by from their light, the highest of its quarters.
    fn unevenness(&self) -> f64 {
        let half = self.side.div_ceil(2);
        let mut sums = [(0.0, 0.0); 4];
        for (i, t) in self.threads.iter().enumerate() {
            let quarter = &mut sums[(i / self.side / half) * 2 + i % self.side / half];
            quarter.0 += t.iter().map(|v| v * v).sum::<f64>();
            quarter.1 += 1.0;
        }
        sums.iter().map(|(sum, n)| sum / f64::max(*n, 1.0)).fold(0.0, f64::max)
    }

    /// Threads at any place: the square is laid out again and again, each time seen in a mirror, so
    /// that its borders meet.
    fn at(&self, x: usize, y: usize) -> [f64; 3] {
        let fold = |v: usize| match v % (2 * self.side) {
            v if v < self.side => v,
            v => 2 * self.side - 1 - v,
        };
        self.threads[fold(y) * self.side + fold(x)]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use image::Rgb;
    use proptest::prelude::*;

    /// Blue cloth in uneven light with a grain of a few levels.
    fn cloth(x: u32, y: u32) -> [u8; 3] {
        let grain = (x * 7 + y * 13) % 5;
        [40 + (x / 8 + grain) as u8, 60 + (x / 8 + grain) as u8, 140 + (x / 8 + grain) as u8]
    }

    fn is_print(x: u32, y: u32) -> bool {
        (70..130).contains(&x) && (80..120).contains(&y) && (x / 6).is_multiple_of(2)
    }

    fn picture(colour: impl Fn(u32, u32) -> [u8; 3]) -> (RgbImage, GrayImage) {
        let pixels = RgbImage::from_fn(200, 240, |x, y| Rgb(colour(x, y)));
        (pixels, GrayImage::from_pixel(200, 240, Luma([255])))
    }

    #[test]
    fn a_print_becomes_cloth_in_the_light_around_it() {
        let (mut pixels, sure) = picture(|x, y| if is_print(x, y) { [250, 240, 60] } else { cloth(x, y) });
        assert!(plain(&mut pixels, &sure));
        for (x, y, p) in pixels.enumerate_pixels() {
            let off = [0, 1, 2].map(|c| p.0[c].abs_diff(cloth(x, y)[c]));
            // Light is averaged over wide squares: at the rim it lags behind the steep light of
            // this picture.
            assert!(off.iter().all(|d| *d <= 10), "{x} {y}: {:?} for {:?}", p.0, cloth(x, y));
        }
    }

    #[test]
    fn stripes_all_over_are_the_cloths_own() {
        let (mut pixels, sure) =
            picture(|x, y| if (y / 10).is_multiple_of(2) { [250; 3] } else { cloth(x, y) });
        let before = pixels.clone();
        assert!(!plain(&mut pixels, &sure));
        assert_eq!(pixels, before);
    }

    #[test]
    fn piping_along_the_outline_is_not_the_cloth() {
        let inner = |x: u32, y: u32| (24..176).contains(&x) && (24..216).contains(&y);
        let (mut pixels, sure) = picture(|x, y| if inner(x, y) { cloth(x, y) } else { [230, 220, 90] });
        assert!(plain(&mut pixels, &sure));
        assert!(pixels.pixels().all(|p| p.0[2] > p.0[0] + 60));
    }

    #[test]
    fn a_print_on_creased_cloth_is_no_pattern() {
        let crease = |x: u32, y: u32| cloth(x, y).map(|v| v - 14 * u8::from((x + 2 * y) % 24 < 8));
        let letters =
            |x: u32, y: u32| (50..150).contains(&x) && (60..180).contains(&y) && (x / 9).is_multiple_of(2);
        let (mut pixels, sure) = picture(|x, y| if letters(x, y) { [250; 3] } else { crease(x, y) });
        assert!(plain(&mut pixels, &sure));
        assert!(pixels.pixels().all(|p| p.0[0] < 120));
    }

    #[test]
    fn dots_all_over_are_the_cloths_own() {
        let dot = |x: u32, y: u32| x % 14 < 5 && (y + x / 14 % 2 * 7) % 14 < 5;
        let (mut pixels, sure) = picture(|x, y| if dot(x, y) { [230, 210, 160] } else { cloth(x, y) });
        let before = pixels.clone();
        assert!(!plain(&mut pixels, &sure));
        assert_eq!(pixels, before);
    }

    #[test]
    fn a_fly_and_a_seam_in_a_shade_of_the_cloth_become_cloth() {
        let darker = |x: u32, y: u32| cloth(x, y).map(|v| v - 12);
        let (mut pixels, sure) = picture(|x, y| match (98..102).contains(&x) && y < 120 || y == 60 {
            true => darker(x, y),
            false => cloth(x, y),
        });
        assert!(plain(&mut pixels, &sure));
        for (x, y, p) in pixels.enumerate_pixels() {
            let off = [0, 1, 2].map(|c| p.0[c].abs_diff(cloth(x, y)[c]));
            assert!(off.iter().all(|d| *d <= 10), "{x} {y}: {:?} for {:?}", p.0, cloth(x, y));
        }
    }

    #[test]
    fn without_cloth_there_is_nothing_to_make_plain() {
        let (mut pixels, _) = picture(cloth);
        let before = pixels.clone();
        assert!(!plain(&mut pixels, &GrayImage::new(200, 240)));
        assert_eq!(pixels, before);
    }

    proptest! {
        #[test]
        fn any_picture_keeps_what_is_not_taken_for_print((w, h) in (1u32..40, 1u32..40), seed in any::<u32>()) {
            let noise = |x: u32, y: u32, c: u32| {
                let v = (x ^ seed).wrapping_mul(0x9E37_79B1) ^ (y + c * 77).wrapping_mul(0x85EB_CA77);
                (v.wrapping_mul(0x2C1B_3C6D) >> 24) as u8
            };
            let mut pixels = RgbImage::from_fn(w, h, |x, y| Rgb([0, 1, 2].map(|c| noise(x, y, c))));
            let sure = GrayImage::from_fn(w, h, |x, y| Luma([noise(x, y, 3) / 128 * 255]));
            let before = pixels.clone();
            let changed = plain(&mut pixels, &sure);
            prop_assert!(changed || pixels == before);
        }
    }
}

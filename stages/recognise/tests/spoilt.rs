//! Spoilt pictures: noise, stripes, black, and what is left of a garment after them.

use crate::kit::check;
use image::{Rgb, RgbImage};
use toile_recognise::see;

/// SplitMix64 (Steele, Lea, Flood 2014): a case is made from its number alone.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: u32) -> u32 {
        (self.next() % u64::from(n)) as u32
    }

    fn colour(&mut self) -> Rgb<u8> {
        let bits = self.next();
        Rgb([bits as u8, (bits >> 8) as u8, (bits >> 16) as u8])
    }
}

/// The spoilt picture of a case, of 1 to 400 pixels a side.
pub(crate) fn picture(case: u64) -> RgbImage {
    let mut dice = Dice(case.wrapping_mul(0xCBF2_9CE4_8422_2325));
    let (width, height) = (dice.below(400) + 1, dice.below(400) + 1);
    let mut photo = RgbImage::from_pixel(width, height, dice.colour());
    let (light, dark, step) = (dice.colour(), dice.colour(), dice.below(40) + 1);
    match case % 6 {
        0 => photo.pixels_mut().for_each(|pixel| *pixel = dice.colour()),
        1 => photo.enumerate_pixels_mut().for_each(|(x, y, pixel)| {
            *pixel = if (x + y * (step % 3)) / step % 2 == 0 { light } else { dark };
        }),
        2 => photo
            .pixels_mut()
            .for_each(|pixel| *pixel = Rgb([if case.is_multiple_of(4) { 0 } else { 255 }; 3])),
        3 => photo.enumerate_pixels_mut().for_each(|(x, y, pixel)| {
            let is_on = x.abs_diff(width / 2) * 3 < width && y.abs_diff(height / 2) * 3 < height;
            *pixel = if is_on { light } else { dark };
        }),
        4 => photo.enumerate_pixels_mut().for_each(|(x, y, pixel)| {
            *pixel = Rgb([(x * 255 / width) as u8, (y * 255 / height) as u8, light.0[0]]);
        }),
        _ => photo.pixels_mut().for_each(|pixel| *pixel = if dice.below(step) == 0 { light } else { dark }),
    }
    photo
}

fn is_answered(case: u64) {
    let photo = picture(case);
    let seen = see(&photo, 1).unwrap_or_else(|e| panic!("case {case}: {e}"));
    assert_eq!(check(&seen, photo.dimensions()), Ok(()), "case {case}");
}

/// On all cores: the network takes a quarter of a second a picture.
fn all_are_answered(cases: u64) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for first in 0..threads as u64 {
            scope.spawn(move || (first..cases).step_by(threads).for_each(is_answered));
        }
    });
}

#[test]
fn spoilt_pictures_are_answered() {
    all_are_answered(60);
}

#[test]
#[ignore = "slow: .ci/wide"]
fn ten_thousand_spoilt_pictures_are_answered() {
    all_are_answered(10_000);
}

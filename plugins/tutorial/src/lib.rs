//! Takes dust off photos: a small stage with all that a stage has.

use image::{Rgb, RgbImage};
use toile_core::prelude::*;

/// Removes single pixels that stand out from everything around them.
///
/// A speck of dust or a dead sensor pixel differs from all eight neighbours in the same direction;
/// it takes the nearest of their levels. Edges and weave stay, since there some neighbour is alike.
#[stage(
    role = Denoiser,
    source = "the tutorial, 2026",
    example = "Dust(step: 30)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct Dust {
    /// A pixel must differ from every neighbour by more than this.
    #[param(default = 30, min = 1, max = 255, unit = "grey levels")]
    pub step: u8,
    /// Which specks go.
    #[param(default = Specks::Both)]
    pub specks: Specks,
}

/// Kinds of specks.
#[choice]
#[derive(Copy)]
pub enum Specks {
    /// Light and dark ones.
    Both,
    /// Dust on a dark garment, stuck pixels.
    Light,
    /// Dust on a light garment, dead pixels.
    Dark,
}

#[stage]
impl Dust {
    fn run(&self, photo: &Photo, cx: &Context) -> Result<Photo, StageError> {
        let before = photo.pixels.as_ref();
        let mut after = before.clone();
        for y in 0..before.height() {
            cx.check()?;
            for x in 0..before.width() {
                after.put_pixel(x, y, cleaned(before, x, y, self));
            }
        }
        Ok(photo.with_pixels(after))
    }
}

/// The pixel, each channel held between the levels of its neighbours where it leaves them by more
/// than the step.
fn cleaned(photo: &RgbImage, x: u32, y: u32, dust: &Dust) -> Rgb<u8> {
    let around = |v: u32, size: u32| v.saturating_sub(1)..(v + 2).min(size);
    let mut range = [[u8::MAX, 0]; 3];
    for v in around(y, photo.height()) {
        for u in around(x, photo.width()).filter(|&u| (u, v) != (x, y)) {
            for (range, level) in range.iter_mut().zip(photo.get_pixel(u, v).0) {
                *range = [range[0].min(level), range[1].max(level)];
            }
        }
    }
    let mut pixel = *photo.get_pixel(x, y);
    for (level, [least, most]) in pixel.0.iter_mut().zip(range) {
        let light = dust.specks != Specks::Dark && level.saturating_sub(most) > dust.step;
        let dark = dust.specks != Specks::Light && least.saturating_sub(*level) > dust.step;
        // A photo of one pixel has no neighbours, and then least is above most.
        if least <= most && (light || dark) {
            *level = (*level).clamp(least, most);
        }
    }
    pixel
}

toile_core::plugin!(Dust);

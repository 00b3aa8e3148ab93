//! The words and the picture of a doubt.

use super::super::small::Small;
use super::choose::Choice;
use super::methods::Found;
use image::imageops::{FilterType, resize, thumbnail};
use image::{GrayImage, ImageFormat, RgbImage};
use std::io::Cursor;
use toile_core::prelude::*;

/// The longer side of the picture, pixels.
const PICTURE: u32 = 800;

/// The largest share of the frame that `touch` may allow.
const MAX_TOUCH: f64 = 4.0;

/// The refusal of a mask that leaves doubt: what was seen, and one thing to try.
pub(super) fn refuse(
    photo: &Photo,
    small: &Small,
    found: &[Found],
    choice: &Choice,
    confidence: f64,
    cx: &Context,
) -> StageError {
    let (seen, advice) = words(choice, &photo.file);
    let take = format!("--set stages.{}.confidence={}", cx.stage(), (confidence * 100.0).floor() / 100.0);
    let votes: Vec<f64> = (0..small.lab.len())
        .map(|i| found.iter().filter(|f| f.mask[i]).count() as f64 / found.len() as f64)
        .collect();
    let error = StageError::invalid(seen)
        .hint(format!("{advice}; where the picture of the doubt outlines the garment, take it by `{take}`"));
    with_picture(error, photo, &votes, &choice.coarse.mask, small.w, small.h)
}

/// What is least sure, and what would help.
fn words(choice: &Choice, file: &str) -> (String, &'static str) {
    if let Some(times) = choice.larger {
        let seen = format!(
            "what stands out in \"{file}\" may be a print: an outline around it holds {times:.1} times its area"
        );
        return (seen, "lay the garment on a ground of another colour");
    }
    let e = &choice.evidence;
    let [agree, edges, alike] = e.parts();
    if agree <= edges && agree <= alike {
        let share = 100.0 * (1.0 - e.agreement);
        let seen = format!(
            "it is not sure where the garment in \"{file}\" ends: the methods differ in {share:.0} % of it"
        );
        return (seen, "lay it on a plain ground of another colour");
    }
    if edges <= alike {
        let share = 100.0 * (1.0 - e.support);
        let seen =
            format!("{share:.0} % of the outline found in \"{file}\" lies where the photo shows no edge");
        return (seen, "use a ground of another colour, or light from both sides");
    }
    let share = 100.0 * e.symmetry;
    let seen = format!("the two halves of what was found in \"{file}\" are alike to {share:.0} % only");
    (seen, "spread both halves alike, with nothing beside the garment")
}

/// The refusal of a garment that the frame cuts.
pub(super) fn cut_by_frame(photo: &Photo, mask: &GrayImage, share: f64, cx: &Context) -> StageError {
    let error = StageError::invalid(format!(
        "the garment in \"{}\" is cut by the frame: it lies along it over {:.0} % of the photo's shorter side",
        photo.file,
        100.0 * share
    ));
    let touch = (share * 10.0).ceil() / 10.0;
    let anyway = match touch <= MAX_TOUCH {
        true => format!("; to sew what the photo shows, `--set stages.{}.touch={touch}`", cx.stage()),
        false => String::new(),
    };
    let error = error.hint(format!("leave a margin of ground on all sides{anyway}"));
    let flags: Vec<bool> = mask.as_raw().iter().map(|v| *v != 0).collect();
    with_picture(error, photo, &[], &flags, mask.width() as usize, mask.height() as usize)
}

/// Adds the picture: the photo with what methods disagree about in red, and the outline in yellow. `votes` is the share of
/// the methods that take a pixel for garment; none for no red.
fn with_picture(
    error: StageError,
    photo: &Photo,
    votes: &[f64],
    mask: &[bool],
    w: usize,
    h: usize,
) -> StageError {
    let (pw, ph) = photo.pixels.dimensions();
    let scale = (f64::from(PICTURE) / f64::from(pw.max(ph))).min(1.0);
    let size = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    let mut shown: RgbImage =
        if scale < 1.0 { thumbnail(&*photo.pixels, size(pw), size(ph)) } else { (*photo.pixels).clone() };
    let at_size = |value: &dyn Fn(usize) -> u8| {
        let mut grey = GrayImage::new(w as u32, h as u32);
        grey.iter_mut().enumerate().for_each(|(i, v)| *v = value(i));
        resize(&grey, shown.width(), shown.height(), FilterType::Triangle)
    };
    let inside = at_size(&|i| if mask[i] { 255 } else { 0 });
    let split = at_size(&|i| votes.get(i).map_or(0, |v| (4.0 * v * (1.0 - v) * 255.0).min(255.0) as u8));
    let on = |x: u32, y: u32| inside.get_pixel(x, y).0[0] >= 128;
    let (sw, sh) = shown.dimensions();
    for (x, y, p) in shown.enumerate_pixels_mut() {
        let red = f64::from(split.get_pixel(x, y).0[0]) / 255.0 * 0.6;
        let toward = |v: u8, to: f64| (f64::from(v) * (1.0 - red) + to * red) as u8;
        p.0 = [toward(p.0[0], 255.0), toward(p.0[1], 0.0), toward(p.0[2], 0.0)];
        let ends = |u: u32, v: u32| u < sw && v < sh && !on(u, v);
        if on(x, y)
            && (ends(x + 1, y) || ends(x, y + 1) || ends(x.wrapping_sub(1), y) || ends(x, y.wrapping_sub(1)))
        {
            p.0 = [255, 255, 0];
        }
    }
    let mut png = Cursor::new(Vec::new());
    match shown.write_to(&mut png, ImageFormat::Png) {
        Ok(()) => error.picture(png.into_inner()),
        Err(_) => error,
    }
}

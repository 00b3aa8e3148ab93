//! What every binariser does at its end: clean the mask, keep one garment, and say so when there is
//! none, more than one, one in parts, or half of one.

use super::beside::tell_beside;
use super::cut_out::{CutOut, cut_out};
use super::marked::marked;
use super::morphology::{MAX_RADIUS, close, open};
use super::regions::{MaskPiece, Regions};
use super::tone::OPAQUE;
use image::GrayImage;
use rayon::prelude::*;
use toile_core::prelude::*;

/// Settings of the clean-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CleanUp {
    /// Radius of the opening, pixels; 0 for none.
    pub open: u32,
    /// Radius of the closing, pixels; 0 for none.
    pub close: u32,
    /// Holes up to this share of the garment's area are filled.
    pub holes: f64,
    /// The garment may touch the frame over this share of the photo's shorter side; where it
    /// touches more, it is cut.
    pub touch: f64,
    /// The binariser to try where this one is wrong, as it is written in a pipeline.
    pub next: &'static str,
}

/// The least share of the photo that a garment covers: anything smaller is a speck.
const LEAST_AREA: f64 = 0.005;
/// From this share of the largest piece on, a second piece is no stain: another part of the
/// garment, or another garment.
const SECOND: f64 = 0.5;
/// Parts of a garment lie no farther apart than this share of its size (the root of its area): a
/// stripe in the ground's tone.
const GAP: f64 = 0.08;
/// What is smaller than this share of the largest piece is no part.
const PART: f64 = 0.02;

/// The mask of a photo: its opacity where that is a mask already, else what `method` finds,
/// finished.
///
/// # Errors
/// Those of [`finish`] and of the method; a garment whose ground was cut away is not cut by the
/// frame.
pub fn mask_of(
    photo: &Photo,
    settings: CleanUp,
    cx: &Context,
    method: impl FnOnce() -> Result<GrayImage, StageError>,
) -> Result<Mask, StageError> {
    has_pixels(photo)?;
    let Some(CutOut { mask, sure }) = cut_out(photo) else {
        return finish(method()?, photo, settings, cx);
    };
    if !sure && !photo.mirrored {
        cx.warn(format!(
            "what is opaque in \"{}\" is taken for the garment, and the rest for its ground",
            photo.file
        ));
    }
    finish(mask, photo, CleanUp { touch: f64::INFINITY, ..settings }, cx)
}

/// Cleans a raw mask and checks that it shows one whole garment.
///
/// Transparent pixels are ground. Then opening, closing, choice of the largest piece, filling of
/// its small holes. Where a second piece is nearly as large, pieces that lie near each other are
/// joined, with a warning.
///
/// # Errors
/// [`ErrorCode::InvalidInput`] for no garment, and a garment cut by the frame.
pub fn finish(mask: GrayImage, photo: &Photo, settings: CleanUp, cx: &Context) -> Result<Mask, StageError> {
    let (mask, second) = finished(mask, photo, settings, cx)?;
    if second.is_some() {
        tell_beside(photo, &mask, second.as_ref(), Vec::new, cx);
    }
    Ok(mask)
}

/// The finished mask, and the second piece where that is nearly as large as the garment.
fn finished(
    mask: GrayImage,
    photo: &Photo,
    settings: CleanUp,
    cx: &Context,
) -> Result<(Mask, Option<GrayImage>), StageError> {
    cx.check()?;
    let mask = without_transparent(mask, photo);
    let mask = close(&open(&mask, settings.open), settings.close);
    cx.check()?;
    let mut pieces = Regions::of(&mask);
    if is_in_parts(&pieces) {
        let whole = joined(&mask, &pieces);
        if whole != mask {
            pieces = Regions::of(&whole);
            tell_joined(photo, settings.next, cx);
        }
    }
    let kept =
        one_garment(&pieces, photo, settings, cx.stage()).inspect_err(|_| cx.so_far(marked(photo, &mask)))?;
    cx.check()?;
    let second = pieces.by_size().get(1).copied().filter(|_| is_in_parts(&pieces));
    let second = second.map(|second| pieces.paint(|i, _| i == second));
    let mask = fill_holes(pieces.paint(|i, _| i == kept), settings.holes);
    let mask = Mask { pixels: mask.into() };
    cx.figure("garment", 100.0 * mask.area_px() as f64 / frame_area(photo), "% of the photo");
    Ok((mask, second))
}

fn frame_area(photo: &Photo) -> f64 {
    let (w, h) = photo.pixels.dimensions();
    f64::from(w) * f64::from(h)
}

fn without_transparent(mut mask: GrayImage, photo: &Photo) -> GrayImage {
    if let Some(alpha) = &photo.alpha {
        let pairs = mask.par_iter_mut().zip(alpha.as_raw());
        pairs.for_each(|(m, a)| *m = if *a < OPAQUE { 0 } else { *m });
    }
    mask
}

/// Fills the holes of a single piece that are no larger than a share of it.
pub fn fill_holes(mask: GrayImage, share: f64) -> GrayImage {
    let regions = Regions::of(&mask);
    let area: u64 = regions.pieces.iter().filter(|p| p.on).map(|p| p.area).sum();
    let is_hole = |p: &MaskPiece| !p.on && p.frame == 0 && p.area as f64 <= share * area as f64;
    match regions.pieces.iter().any(is_hole) {
        true => regions.paint(|_, p| p.on || is_hole(p)),
        false => mask,
    }
}

/// The one garment among the pieces.
fn one_garment(
    regions: &Regions,
    photo: &Photo,
    settings: CleanUp,
    stage: &str,
) -> Result<usize, StageError> {
    let order = regions.by_size();
    let least = LEAST_AREA * frame_area(photo);
    let Some(&largest) = order.first().filter(|&&i| regions.pieces[i].area as f64 >= least) else {
        return Err(no_garment(photo, "nothing stands out from the ground along the frame", settings.next));
    };
    let garment = regions.pieces[largest];
    let (w, h) = photo.pixels.dimensions();
    let touch = garment.frame as f64 / f64::from(w.min(h));
    if touch > settings.touch {
        return Err(cut_by_frame(photo, garment.frame as f64, stage, settings.next));
    }
    Ok(largest)
}

/// Whether a second piece is nearly as large as the first.
fn is_in_parts(regions: &Regions) -> bool {
    match regions.by_size()[..] {
        [first, second, ..] => {
            regions.pieces[second].area as f64 >= SECOND * regions.pieces[first].area as f64
        }
        _ => false,
    }
}

/// The mask with bridges between pieces that lie near each other.
fn joined(mask: &GrayImage, pieces: &Regions) -> GrayImage {
    let largest = pieces.pieces.iter().filter(|p| p.on).map(|p| p.area).max().unwrap_or(0) as f64;
    let radius = ((0.5 * GAP * largest.sqrt()).ceil() as u32).min(MAX_RADIUS);
    let closed = close(mask, radius);
    let mut between = closed.clone();
    between.iter_mut().zip(mask.iter()).filter(|(_, on)| **on != 0).for_each(|(v, _)| *v = 0);
    let between = Regions::of(&between);
    let is_part: Vec<bool> = pieces.pieces.iter().map(|p| p.on && p.area as f64 >= PART * largest).collect();
    // Which parts each stretch between them touches.
    let (own, gap) = (pieces.labels(), between.labels());
    let mut touched = vec![[None; 2]; between.pieces.len()];
    let width = mask.width() as usize;
    let mut meet = |i: usize, j: usize| {
        let (stretch, part) = (gap[i] as usize, own[j] as usize);
        if between.pieces[stretch].on && is_part[part] {
            let both = &mut touched[stretch];
            match both {
                [None, _] => both[0] = Some(part),
                [Some(first), None] if *first != part => both[1] = Some(part),
                _ => {}
            }
        }
    };
    for i in 0..own.len() {
        let (right, below) = (i + 1, i + width);
        if right % width != 0 {
            meet(i, right);
            meet(right, i);
        }
        if below < own.len() {
            meet(i, below);
            meet(below, i);
        }
    }
    let bridges = between.paint(|k, p| p.on && touched[k][1].is_some());
    let mut whole = mask.clone();
    whole.iter_mut().zip(bridges.iter()).filter(|(_, on)| **on != 0).for_each(|(v, _)| *v = 255);
    whole
}

fn tell_joined(photo: &Photo, next: &str, cx: &Context) {
    if !photo.mirrored {
        cx.warn(format!(
            "the garment in \"{}\" was found in several parts, which are joined: look at the outline; if it is not right, take --set 'stages.{}={}'",
            photo.file,
            cx.stage(),
            next.trim_matches('`')
        ));
    }
}

/// The error for a garment that touches the frame over so many pixels, with the binariser to try.
pub(super) fn cut_by_frame(photo: &Photo, pixels: f64, stage: &str, next: &str) -> StageError {
    let (w, h) = photo.pixels.dimensions();
    StageError::invalid(format!(
        "the garment in \"{}\" is cut by the frame: it touches it over {pixels:.0} px",
        photo.file
    ))
    .hint(cut_hint(stage, pixels / f64::from(w.min(h)), next))
}

/// What may help a garment that touches the frame over a share of the photo's shorter side.
fn cut_hint(stage: &str, touch: f64, next: &str) -> String {
    // The next tenth, so that the option holds for a photo a little different.
    let enough = (touch * 10.0).floor() / 10.0 + 0.1;
    format!(
        "leave a margin of ground on all sides; if nothing of it is cut off, or one half is whole, let it \
         touch the frame: --set 'stages.{stage}.touch={enough:.1}'; if there is a margin, ground was taken for garment: try {next}"
    )
}

/// The error for a photo that shows no garment, with the reason and the binariser to try.
pub fn no_garment(photo: &Photo, reason: &str, next: &str) -> StageError {
    StageError::invalid(format!("no garment found in \"{}\": {reason}", photo.file))
        .hint(format!("lay the garment on a ground of another colour, or try {next}"))
}

/// Refuses photos of no pixels, which no method can work on.
fn has_pixels(photo: &Photo) -> Result<(), StageError> {
    match photo.pixels.dimensions() {
        (0, _) | (_, 0) => Err(StageError::invalid(format!("photo \"{}\" has no pixels", photo.file))),
        _ => Ok(()),
    }
}

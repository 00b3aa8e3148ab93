//! What the stages of this folder ask of photos, and the view that they make.

use crate::picture::{flipped, in_order};
use image::{RgbImage, RgbaImage};
use std::borrow::Cow;
use toile_core::prelude::*;

/// The shortest side of a photo, px.
const MIN_SIDE_PX: u32 = 32;
/// The name of what is made.
const NAME: &str = "view";

/// The two photos, in the order of their names.
///
/// # Errors
/// For another number of photos, for sizes that differ, and for photos that are too small.
pub(super) fn pair(photos: &Set<Photo>) -> Result<[Cow<'_, RgbImage>; 2], StageError> {
    let names = in_order(photos.iter().map(|(name, _)| name));
    let [first, second] = names[..] else {
        let have = match names.len() {
            0 => "there are none".to_owned(),
            1 => "there is 1".to_owned(),
            n => format!("there are {n}"),
        };
        return Err(StageError::invalid(format!("a view between two photos needs two, and {have}"))
            .hint("give two entries of `photos`, the left one first in the order of their names"));
    };
    one_size(photos, &names)?;
    let get = |name: &str| photos.get(name).ok_or_else(|| StageError::internal("a photo is lost"));
    Ok([flipped(get(first)?), flipped(get(second)?)])
}

/// Refuses photos of several sizes, and small ones.
///
/// # Errors
/// For those.
pub(super) fn one_size(photos: &Set<Photo>, names: &[&str]) -> Result<[u32; 2], StageError> {
    let sizes: Vec<(&str, (u32, u32))> =
        names.iter().filter_map(|n| Some((*n, photos.get(n)?.pixels.dimensions()))).collect();
    let Some((first, (w, h))) = sizes.first().copied() else {
        return Err(StageError::invalid("there are no photos").hint("add `photos` to the pipeline"));
    };
    if let Some((name, (pw, ph))) = sizes.iter().find(|(_, size)| *size != (w, h)) {
        let text = format!("photo \"{name}\" is {pw} x {ph} px, and photo \"{first}\" {w} x {h} px");
        return Err(
            StageError::invalid(text).hint("give uncut photos of one camera, all upright or all across")
        );
    }
    if w.min(h) < MIN_SIDE_PX {
        let text = format!("the photos are {w} x {h} px, too small for a view between them");
        return Err(
            StageError::invalid(text).hint(format!("give photos of at least {MIN_SIDE_PX} px a side"))
        );
    }
    Ok([w, h])
}

/// A photo as block matching reads it.
pub(super) fn opaque(photo: &RgbImage) -> RgbaImage {
    let mut out = RgbaImage::new(photo.width(), photo.height());
    for (to, p) in out.pixels_mut().zip(photo.pixels()) {
        to.0 = [p.0[0], p.0[1], p.0[2], 255];
    }
    out
}

/// The view as the only photo.
pub(super) fn view(colours: &[[f32; 3]], [w, h]: [u32; 2]) -> Set<Photo> {
    let mut pixels = RgbImage::new(w, h);
    for (pixel, colour) in pixels.pixels_mut().zip(colours) {
        pixel.0 = colour.map(|c| (c + 0.5).clamp(0.0, 255.0) as u8);
    }
    let photo = Photo {
        pixels: Shared::new(pixels),
        alpha: None,
        px_per_metre: None,
        garment_width: None,
        mirrored: false,
        joined: 1,
        file: NAME.to_owned(),
    };
    [(NAME.to_owned(), photo)].into_iter().collect()
}

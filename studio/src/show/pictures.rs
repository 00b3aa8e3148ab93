//! Photos, masks and textures as pictures for a page.

use crate::fault::StudioFault;
use crate::live::shown::ShownArtifacts;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops::{self, resize};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use toile_core::artifact::{Mask, Photo};

/// The longest side of a photo on a page, pixels.
const LONGEST: u32 = 1600;
/// The longest side of a texture, pixels.
const LONGEST_TEXTURE: u32 = 2048;
/// Quality of a texture, of 100.
const QUALITY: u8 = 88;

/// The size of a picture for a photo of that size, and how many of its pixels are one of the
/// photo's.
fn size(photo: &Photo, longest: u32) -> ([u32; 2], f64) {
    let (width, height) = photo.pixels.dimensions();
    let scale = (f64::from(longest) / f64::from(width.max(height))).min(1.0);
    let side = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    ([side(width), side(height)], scale / f64::from(photo.joined))
}

/// A photo as PNG, and its scale: pixels of the picture a pixel of the photo.
///
/// Errors: there is no photo of that name.
pub(crate) fn photo(shown: &ShownArtifacts, name: &str) -> Result<(Vec<u8>, f64), StudioFault> {
    let photo = named(shown, name)?;
    let ([width, height], scale) = size(photo, LONGEST);
    let pixels = smaller(&photo.pixels, width, height);
    Ok((png(pixels.as_raw(), width, height, ExtendedColorType::Rgb8)?, scale))
}

/// The mask of a photo as PNG: black, opaque on the garment; of the size of [`photo`].
///
/// Errors: there is no mask of that name.
pub(crate) fn mask(shown: &ShownArtifacts, name: &str) -> Result<Vec<u8>, StudioFault> {
    let photo = named(shown, name)?;
    let none = || StudioFault::not_found(format!("there is no mask of the photo \"{name}\" yet"));
    let mask: &Mask = shown.masks.get(name).ok_or_else(none)?;
    let ([width, height], _) = size(photo, LONGEST);
    let (w, h) = mask.pixels.dimensions();
    let of = |n: u32, to: u32, from: u32| (u64::from(n) * u64::from(from) / u64::from(to.max(1))) as usize;
    let raw = mask.pixels.as_raw();
    let row = |y: u32| {
        let from = of(y, height, h) * w as usize;
        (0..width).flat_map(move |x| [0, raw.get(from + of(x, width, w)).copied().unwrap_or(0)])
    };
    let pixels: Vec<u8> = (0..height).flat_map(row).collect();
    png(&pixels, width, height, ExtendedColorType::La8)
}

/// The N-th picture that the garment is textured with, as JPEG: of the model where it is there,
/// else the photos by name.
///
/// Errors: there are not so many.
pub(crate) fn texture(shown: &ShownArtifacts, n: usize) -> Result<Vec<u8>, StudioFault> {
    let none = || StudioFault::not_found(format!("there is no texture {n}"));
    let pixels: &RgbImage = match &shown.model {
        Some(model) => &model.textures.get(n).ok_or_else(none)?.pixels,
        None => &shown.photos.values().nth(n).ok_or_else(none)?.pixels,
    };
    let scale = (f64::from(LONGEST_TEXTURE) / f64::from(pixels.width().max(pixels.height()))).min(1.0);
    let side = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    let (width, height) = (side(pixels.width()), side(pixels.height()));
    let pixels = smaller(pixels, width, height);
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, QUALITY);
    let written = encoder.write_image(pixels.as_raw(), width, height, ExtendedColorType::Rgb8);
    written.map_err(|e| unwritable(&e))?;
    Ok(bytes)
}

fn named<'a>(shown: &'a ShownArtifacts, name: &str) -> Result<&'a Photo, StudioFault> {
    let none = || StudioFault::not_found(format!("there is no photo \"{name}\" yet"));
    Ok(shown.photos.get(name).ok_or_else(none)?)
}

fn smaller(pixels: &RgbImage, width: u32, height: u32) -> std::borrow::Cow<'_, RgbImage> {
    match pixels.dimensions() == (width, height) {
        true => std::borrow::Cow::Borrowed(pixels),
        false => std::borrow::Cow::Owned(resize(pixels, width, height, imageops::FilterType::Triangle)),
    }
}

/// Quickly, since it goes a short way.
fn png(pixels: &[u8], width: u32, height: u32, colour: ExtendedColorType) -> Result<Vec<u8>, StudioFault> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Sub);
    encoder.write_image(pixels, width, height, colour).map_err(|e| unwritable(&e))?;
    Ok(bytes)
}

fn unwritable(e: &image::ImageError) -> StudioFault {
    StudioFault::new("internal", format!("the picture cannot be written: {e}"))
}

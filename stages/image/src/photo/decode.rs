//! Bytes of a JPEG, PNG, WebP or TIFF to upright 8-bit sRGB pixels.
//!
//! The size is read from the header and checked first, so that a small file cannot claim more
//! memory than the machine has. Then: decode, 16 bits down to 8, grey to RGB, turn upright by the
//! EXIF orientation. An alpha channel that is opaque everywhere is dropped.
//!
//! Cost: 12 megapixels of JPEG take about 0.1 s. Limits: no colour management (the pixels are taken
//! as sRGB); of an animation and of a file of several pictures the first counts.

use super::form::{PictureFormat, form};
use super::header::{self, Header};
use image::{DynamicImage, GrayImage, ImageDecoder, ImageError, ImageFormat, ImageReader, RgbImage};
use std::io::{Cursor, ErrorKind};
use toile_core::{ErrorCode, StageError};

/// The longest side of a photo, pixels. Phones and cameras give up to 12,000, scanners 20,000.
pub const MAX_SIDE_PX: u64 = 30_000;
/// The most pixels of a photo. 200-megapixel phones are the largest sold.
pub const MAX_PIXELS: u64 = 200_000_000;
/// The most memory that a decoded photo may take, before it is brought down to 8 bits a channel.
pub const MAX_DECODED_BYTES: u64 = 1 << 30;

/// A decoded photo.
#[derive(Debug, Clone, PartialEq)]
pub struct Decoded {
    /// Upright pixels.
    pub pixels: RgbImage,
    /// Opacity, where it is not full everywhere.
    pub alpha: Option<GrayImage>,
}

/// Decodes the bytes of the file `name`, which stands in the errors' texts.
///
/// # Errors
/// [`ErrorCode::PatternLoading`] for what is no picture, is damaged or ends early;
/// [`ErrorCode::InvalidInput`] for a picture of no pixels or beyond the limits.
pub fn decode(bytes: &[u8], name: &str) -> Result<Decoded, StageError> {
    let (kind, head) = check_header(bytes, name)?;
    let fail = |e: ImageError| match &e {
        ImageError::IoError(io) if io.kind() == ErrorKind::UnexpectedEof => ends_early(name),
        ImageError::Limits(_) => too_large(name, &head),
        ImageError::Unsupported(_) => unreadable(name, "is of a kind that is not read", &e),
        _ => unreadable(name, "is damaged", &e),
    };
    let bytes = header::without_extras(kind, bytes);
    let mut reader = reader(kind, &bytes);
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(fail)?;
    if decoder.total_bytes() > MAX_DECODED_BYTES {
        return Err(too_large(name, &head));
    }
    // A photo without EXIF, or with a damaged one, is taken as upright.
    let turn = decoder.orientation().unwrap_or(image::metadata::Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(fail)?;
    image.apply_orientation(turn);
    Ok(split(image))
}

/// Pixels across and down once it is upright, from the header alone; none for what [`decode`] would
/// refuse.
pub(super) fn upright_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let (kind, _) = check_header(bytes, "").ok()?;
    let bytes = header::without_extras(kind, bytes);
    let mut decoder = reader(kind, &bytes).into_decoder().ok()?;
    let (w, h) = decoder.dimensions();
    use image::metadata::Orientation::{Rotate90, Rotate90FlipH, Rotate270, Rotate270FlipH};
    match decoder.orientation() {
        Ok(Rotate90 | Rotate270 | Rotate90FlipH | Rotate270FlipH) => Some((h, w)),
        _ => Some((w, h)),
    }
}

/// A reader of a kind that is read.
fn reader(kind: PictureFormat, bytes: &[u8]) -> ImageReader<Cursor<&[u8]>> {
    let format = match kind {
        PictureFormat::Png => ImageFormat::Png,
        PictureFormat::WebP => ImageFormat::WebP,
        PictureFormat::Tiff => ImageFormat::Tiff,
        PictureFormat::Jpeg | PictureFormat::Other(_) => ImageFormat::Jpeg,
    };
    ImageReader::with_format(Cursor::new(bytes), format)
}

/// Refuses what [`decode`] would refuse by the header alone.
pub(super) fn check(bytes: &[u8], name: &str) -> Result<(), StageError> {
    check_header(bytes, name).map(|_| ())
}

fn check_header(bytes: &[u8], name: &str) -> Result<(PictureFormat, Header), StageError> {
    if bytes.is_empty() {
        return Err(damaged(name, "is empty"));
    }
    let kind = match form(bytes) {
        Some(PictureFormat::Other(words)) => {
            return Err(damaged(name, &format!("is {words}, which is not read")).hint(EXPORT));
        }
        Some(kind) => kind,
        None => return Err(damaged(name, "is not a JPEG, PNG, WebP or TIFF picture").hint(EXPORT)),
    };
    let head = header::read(kind, bytes).ok_or_else(|| ends_early(name))?;
    let Header { width, height, complete } = head;
    if width == 0 || height == 0 {
        return Err(StageError::invalid(format!("photo \"{name}\" has no pixels ({width} x {height})")));
    }
    if width > MAX_SIDE_PX || height > MAX_SIDE_PX || width * height > MAX_PIXELS {
        return Err(too_large(name, &head));
    }
    if !complete {
        return Err(ends_early(name));
    }
    Ok((kind, head))
}

/// What to do with a picture of another kind.
const EXPORT: &str = "photos are read from JPEG, PNG, WebP and TIFF files; export it as JPEG";

fn ends_early(name: &str) -> StageError {
    damaged(name, "ends before its picture does").hint("copy it again: it was cut short")
}

fn unreadable(name: &str, what: &str, e: &ImageError) -> StageError {
    damaged(name, &format!("{what} ({})", plain(&e.to_string()))).hint("export it again as JPEG or PNG")
}

fn damaged(name: &str, what: &str) -> StageError {
    StageError::new(ErrorCode::PatternLoading, format!("photo \"{name}\" {what}"))
}

fn too_large(name: &str, head: &Header) -> StageError {
    StageError::invalid(format!("photo \"{name}\" is too large: {} x {} px", head.width, head.height)).hint(
        format!(
            "at most {MAX_SIDE_PX} px a side, {} megapixels and {} MiB decoded; scale it down first",
            MAX_PIXELS / 1_000_000,
            MAX_DECODED_BYTES >> 20
        ),
    )
}

/// A decoder's message as part of a sentence.
fn plain(message: &str) -> String {
    let line = message.lines().next().unwrap_or("").trim_end_matches('.');
    let mut chars = line.chars();
    chars.next().map(|c| c.to_lowercase().chain(chars).collect()).unwrap_or_default()
}

/// Colour and opacity apart.
fn split(image: DynamicImage) -> Decoded {
    if !image.color().has_alpha() {
        return Decoded { pixels: image.into_rgb8(), alpha: None };
    }
    let rgba = image.into_rgba8();
    let (w, h) = rgba.dimensions();
    let mut pixels = RgbImage::new(w, h);
    let mut alpha = GrayImage::new(w, h);
    for ((from, to), a) in rgba.pixels().zip(pixels.pixels_mut()).zip(alpha.pixels_mut()) {
        let [r, g, b, opacity] = from.0;
        to.0 = [r, g, b];
        a.0 = [opacity];
    }
    if alpha.as_raw().iter().all(|&a| a == 255) {
        return Decoded { pixels, alpha: None };
    }
    composite(&mut pixels, &alpha);
    Decoded { pixels, alpha: Some(alpha) }
}

/// Lays the opaque part on plain black or white, whichever lies further from its mean tone.
///
/// What stands under transparent pixels is arbitrary, often black; an edge detector or a threshold
/// needs a ground that differs from the garment.
fn composite(pixels: &mut RgbImage, alpha: &GrayImage) {
    let (mut tone, mut weight) = (0u64, 0u64);
    for (p, a) in pixels.pixels().zip(alpha.as_raw()) {
        tone += p.0.iter().map(|&v| u64::from(v)).sum::<u64>() * u64::from(*a);
        weight += u64::from(*a) * 3;
    }
    let ground = if tone * 2 > weight * 255 { 0 } else { 255u32 };
    for (p, a) in pixels.pixels_mut().zip(alpha.as_raw()) {
        let a = u32::from(*a);
        p.0 = p.0.map(|v| ((u32::from(v) * a + ground * (255 - a) + 127) / 255) as u8);
    }
}

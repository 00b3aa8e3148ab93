//! The way in: checks what was given and hands it to the finder of the object's kind.

use crate::{Found, KnownObject, ScaleError, ScaleOptions, chessboard, rectangle, ruler};
use image::RgbImage;

/// Sides of a photo that is looked at, pixels, and its most pixels.
pub(crate) const SIDES: std::ops::RangeInclusive<u32> = 32..=30_000;
pub(crate) const MOST_PIXELS: u64 = 200_000_000;

/// Finds an object of known size in a photo.
///
/// # Errors
/// See [`ScaleError`].
pub fn find(photo: &RgbImage, object: KnownObject) -> Result<Found, ScaleError> {
    find_with(photo, object, &ScaleOptions::default())
}

/// Finds an object of known size in a photo of which more is known.
///
/// # Errors
/// See [`ScaleError`].
pub fn find_with(photo: &RgbImage, object: KnownObject, options: &ScaleOptions) -> Result<Found, ScaleError> {
    check(photo, options)?;
    object.check()?;
    match object.rectangle() {
        Some(shape) => rectangle::find(photo, object, &shape, options),
        None => marked(photo, object, options),
    }
}

/// Finds an object that is told by its marks.
fn marked(photo: &RgbImage, object: KnownObject, options: &ScaleOptions) -> Result<Found, ScaleError> {
    match object {
        KnownObject::Chessboard { square_um, corners } => {
            chessboard::find(photo, object, f64::from(square_um) * 1e-6, corners, options)
        }
        _ => ruler::find(photo, object),
    }
}

/// Refuses photos and options that are out of range.
fn check(photo: &RgbImage, options: &ScaleOptions) -> Result<(), ScaleError> {
    check_size(photo)?;
    match options.focal_35mm {
        Some(focal) if !(8.0..=400.0).contains(&focal) => Err(ScaleError::Focal { focal }),
        _ => Ok(()),
    }
}

/// Refuses photos that are too small or too large.
pub(crate) fn check_size(photo: &RgbImage) -> Result<(), ScaleError> {
    let (width, height) = photo.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    let good = SIDES.contains(&width) && SIDES.contains(&height) && pixels <= MOST_PIXELS;
    if good { Ok(()) } else { Err(ScaleError::Size { width, height }) }
}

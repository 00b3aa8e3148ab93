//! The scale of a photo from an object of known size that lies beside the garment.
//!
//! What finds and measures it stands in the crate `toile-scale`. Cards, sheets and chessboards give
//! the plane of the ground: the photo is drawn anew as if taken from straight above, and what it
//! does not show is transparent. A ruler gives the scale along itself alone.

use super::Decoded;
use image::{GrayImage, Luma, Rgb, RgbImage};
use serde::{Deserialize, Serialize};
use toile_core::prelude::*;
use toile_scale::{Found, KnownObject, RectifyOptions, ScaleKind, find, rectify};

/// An object of known size beside the garment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ScaleObject {
    /// A bank card: 85.60 x 53.98 mm (ISO/IEC 7810 ID-1).
    BankCard,
    /// A sheet of paper of 210 x 297 mm (ISO 216).
    A4,
    /// A sheet of US Letter paper: 215.9 x 279.4 mm.
    Letter,
    /// A ruler with millimetres or centimetres. It tells no tilt: photograph from straight above.
    Ruler,
    /// A chessboard.
    Chessboard {
        /// The side of a square, micrometres.
        #[serde(with = "micrometres")]
        square: u32,
    },
}

/// A length in the file, whole micrometres in memory, by which objects are told apart.
mod micrometres {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use toile_core::Length;

    pub(super) fn serialize<S: Serializer>(um: &u32, s: S) -> Result<S::Ok, S::Error> {
        Length::mm(f64::from(*um) / 1e3).serialize(s)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<u32, D::Error> {
        let um = (Length::deserialize(d)?.metres() * 1e6).round();
        match (1.0..=f64::from(u32::MAX)).contains(&um) {
            true => Ok(um as u32),
            false => {
                Err(serde::de::Error::custom("the side of a chessboard's square is not a length above 0"))
            }
        }
    }
}

impl ScaleObject {
    fn object(self) -> KnownObject {
        match self {
            ScaleObject::BankCard => KnownObject::BankCard,
            ScaleObject::A4 => KnownObject::A4,
            ScaleObject::Letter => KnownObject::Letter,
            ScaleObject::Ruler => KnownObject::Ruler,
            ScaleObject::Chessboard { square } => {
                KnownObject::Chessboard { square_um: square, corners: None }
            }
        }
    }
}

/// The photo as if taken from straight above, and its pixels a metre.
///
/// # Errors
/// The object is not found, or not for sure; a photo whose ground was cut away shows none.
pub(super) fn from_above(
    decoded: Decoded,
    object: ScaleObject,
    file: &str,
    cx: &Context,
) -> Result<(Decoded, f64), StageError> {
    if decoded.alpha.is_some() {
        return Err(StageError::invalid(format!(
            "\"{file}\" has transparent pixels, and no ground on which an object lies"
        ))
        .hint("give the photo as it was taken, or the garment's `width`"));
    }
    let named = |e: toile_scale::ScaleError| StageError::invalid(format!("\"{file}\": {e}"));
    let found = find(&decoded.pixels, object.object()).map_err(named)?;
    cx.check()?;
    tell(&found, file, cx);
    if found.kind == ScaleKind::Line {
        return Ok((decoded, found.px_per_metre));
    }
    let above = rectify(&decoded.pixels, &found, &RectifyOptions::default()).map_err(named)?;
    let (w, h) = above.image.dimensions();
    let pixel = |x, y| above.image.get_pixel(x, y).0;
    let pixels = RgbImage::from_fn(w, h, |x, y| {
        let [r, g, b, _] = pixel(x, y);
        Rgb([r, g, b])
    });
    let alpha = GrayImage::from_fn(w, h, |x, y| Luma([pixel(x, y)[3]]));
    let alpha = alpha.iter().any(|a| *a < 255).then_some(alpha);
    Ok((Decoded { pixels, alpha }, above.px_per_metre))
}

/// Says where the object lies, so that one who looks can see whether it is the right one.
fn tell(found: &Found, file: &str, cx: &Context) {
    let [x, y] = [0, 1].map(|k| found.corners.iter().map(|c| c[k]).sum::<f64>() / 4.0);
    let tilt = found.tilt.map_or_else(String::new, |t| format!(", seen {t:.0} degrees from straight above"));
    cx.note(format!(
        "the scale of \"{file}\" is that of what lies at ({x:.0}, {y:.0}) px: {:.2} px a millimetre{tilt}",
        found.px_per_metre / 1e3
    ));
    cx.figure("scale", found.px_per_metre / 1e3, "px/mm");
    cx.figure("scale_residual", found.residual, "px");
}

//! The objects of known size that may lie beside a garment.

use crate::ScaleError;
use nalgebra::Point2;

/// An object of known size, laid flat on the garment's ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KnownObject {
    /// A bank card, ISO/IEC 7810 ID-1: 85.60 x 53.98 mm, corners of 3.18 mm radius, of any colour
    /// and print.
    BankCard,
    /// A sheet of A4 paper (ISO 216): 210 x 297 mm.
    A4,
    /// A sheet of US Letter paper (ANSI Y14.1): 215.9 x 279.4 mm.
    Letter,
    /// A chessboard of squares of two tones.
    Chessboard {
        /// Side of a square, micrometres; 1000 to 1 000 000.
        square_um: u32,
        /// Inner corners along the two directions, each 3 to 60; `None` to count them.
        corners: Option<(u32, u32)>,
    },
    /// A straight ruler with marks each millimetre, or each centimetre at least. It gives no tilt.
    Ruler,
}

/// A rectangle's sides and corners, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RoundedRectangle {
    pub(crate) long: f64,
    pub(crate) short: f64,
    /// Radius of the corners; 0 for sharp ones.
    pub(crate) radius: f64,
}

impl RoundedRectangle {
    /// The corners around the middle, clockwise where y grows downwards; the first side is the long
    /// one.
    pub(crate) fn corners(&self) -> [Point2<f64>; 4] {
        let (x, y) = (self.long / 2.0, self.short / 2.0);
        [Point2::new(-x, -y), Point2::new(x, -y), Point2::new(x, y), Point2::new(-x, y)]
    }
}

impl KnownObject {
    /// What the object is called in messages.
    pub fn name(&self) -> &'static str {
        match self {
            KnownObject::BankCard => "bank card",
            KnownObject::A4 => "A4 sheet",
            KnownObject::Letter => "Letter sheet",
            KnownObject::Chessboard { .. } => "chessboard",
            KnownObject::Ruler => "ruler",
        }
    }

    pub(crate) fn rectangle(&self) -> Option<RoundedRectangle> {
        match self {
            KnownObject::BankCard => Some(RoundedRectangle { long: 0.0856, short: 0.05398, radius: 0.00318 }),
            KnownObject::A4 => Some(RoundedRectangle { long: 0.297, short: 0.21, radius: 0.0 }),
            KnownObject::Letter => Some(RoundedRectangle { long: 0.2794, short: 0.2159, radius: 0.0 }),
            KnownObject::Chessboard { .. } | KnownObject::Ruler => None,
        }
    }

    /// Refuses sizes that no chessboard has.
    pub(crate) fn check(&self) -> Result<(), ScaleError> {
        let KnownObject::Chessboard { square_um, corners } = self else { return Ok(()) };
        if !(1000..=1_000_000).contains(square_um) {
            return Err(ScaleError::Square { square_um: *square_um });
        }
        match corners {
            Some((m, n)) if !(3..=60).contains(m) || !(3..=60).contains(n) => {
                Err(ScaleError::Corners { m: *m, n: *n })
            }
            _ => Ok(()),
        }
    }
}

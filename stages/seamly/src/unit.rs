//! The units of length in which patterns and measurements are written.

use super::fault::SeamlyFault;
use super::source::{short, words};
use roxmltree::Node;

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Inches.
    Inch,
}

impl LengthUnit {
    /// Its length, metres.
    pub fn metres(self) -> f64 {
        match self {
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Centimetre => 1e-2,
            LengthUnit::Inch => 0.0254,
        }
    }

    /// How many of another unit one of this is.
    pub(crate) fn in_units_of(self, other: LengthUnit) -> f64 {
        if self == other { 1.0 } else { self.metres() / other.metres() }
    }

    /// The unit that a file says; centimetres where it says none.
    pub(crate) fn of(root: Node<'_, '_>) -> Result<Self, SeamlyFault> {
        match words(root, "unit").as_deref() {
            Some("mm") => Ok(LengthUnit::Millimetre),
            Some("cm") | None => Ok(LengthUnit::Centimetre),
            Some("inch" | "in") => Ok(LengthUnit::Inch),
            Some(other) => Err(SeamlyFault::Unit { word: short(other) }),
        }
    }
}

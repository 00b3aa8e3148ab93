//! Sizes of pages.
//!
//! Source: ISO 216 (A0 to A4), ANSI/ASME Y14.1 (Letter, Tabloid, which it calls A and B); Legal is
//! 8.5 by 14 inches.

use super::LONGEST;
use crate::error::WriteError;

/// Millimetres of an inch.
const INCH: f64 = 25.4;
/// No page is smaller, mm: its margins, the test square and the legend beside it need as much, and
/// the map of the pages below them.
const LEAST: [f64; 2] = [200.0, 210.0];

/// What a pattern is printed on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Paper {
    /// Pages of 841 mm by 1189 mm, joined.
    A0,
    /// Pages of 594 mm by 841 mm, joined.
    A1,
    /// Pages of 420 mm by 594 mm, joined.
    A2,
    /// Pages of 297 mm by 420 mm, joined.
    A3,
    /// Pages of 210 mm by 297 mm, joined.
    A4,
    /// Pages of 8.5 inches by 11 inches, joined.
    Letter,
    /// Pages of 8.5 inches by 14 inches, joined.
    Legal,
    /// Pages of 11 inches by 17 inches, joined.
    Tabloid,
    /// Pages of any width and height, metres, joined.
    Custom(f64, f64),
    /// One sheet as large as it must be, after pages of A4 with what is written.
    OnePiece,
}

impl Paper {
    /// Width and height of its pages with words, mm.
    pub(super) fn size(self) -> [f64; 2] {
        match self {
            Paper::A0 => [841.0, 1189.0],
            Paper::A1 => [594.0, 841.0],
            Paper::A2 => [420.0, 594.0],
            Paper::A3 => [297.0, 420.0],
            Paper::A4 | Paper::OnePiece => [210.0, 297.0],
            Paper::Letter => [8.5 * INCH, 11.0 * INCH],
            Paper::Legal => [8.5 * INCH, 14.0 * INCH],
            Paper::Tabloid => [11.0 * INCH, 17.0 * INCH],
            Paper::Custom(width, height) => [width * 1e3, height * 1e3],
        }
    }

    /// Errors: a page that is too small for what stands on it, or larger than a page of a PDF may
    /// be.
    pub fn check(self) -> Result<(), WriteError> {
        let [width, height] = self.size();
        // A size that is no number is too small.
        let is_enough = width >= LEAST[0] && height >= LEAST[1];
        if !is_enough {
            return Err(WriteError::SmallPage { width, height, least: LEAST });
        }
        if width.max(height) > LONGEST {
            return Err(WriteError::LargePage { width, height, most: LONGEST });
        }
        Ok(())
    }
}

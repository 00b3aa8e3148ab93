//! What pictures are made of.

use crate::digits::to_digits;

/// Size of a picture, px.
pub const SIZE: [u32; 2] = [960, 640];
/// Grey of axes and text.
pub const INK: [u8; 3] = [52, 56, 64];
/// Grey of the grid.
pub const GRID: [u8; 3] = [226, 229, 233];
/// Grey of what does not count.
pub const PALE: [u8; 3] = [150, 156, 164];

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum PlotMark {
    /// A line; dashed or not.
    Line {
        /// px.
        ends: [[f64; 2]; 2],
        /// px.
        width: f64,
        /// Red, green, blue.
        colour: [u8; 3],
        /// Whether it is dashed.
        dashed: bool,
    },
    /// A filled rectangle: two opposite corners.
    Rect {
        /// px.
        corners: [[f64; 2]; 2],
        /// Red, green, blue.
        colour: [u8; 3],
    },
    /// A dot; a ring where it is hollow.
    Dot {
        /// px.
        at: [f64; 2],
        /// px.
        radius: f64,
        /// Red, green, blue.
        colour: [u8; 3],
        /// Whether it is a ring.
        hollow: bool,
    },
    /// A text whose left end, middle or right end is at a place.
    Text {
        /// px.
        at: [f64; 2],
        /// What of the text is there.
        anchor: Anchor,
        /// The words.
        text: String,
        /// Red, green, blue.
        colour: [u8; 3],
        /// Whether it is a title.
        large: bool,
    },
}

/// Which part of a text is at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// A line.
pub fn line(a: [f64; 2], b: [f64; 2], width: f64, colour: [u8; 3], dashed: bool) -> PlotMark {
    PlotMark::Line { ends: [a, b], width, colour, dashed }
}

/// A text of the usual size.
pub fn text(at: [f64; 2], anchor: Anchor, text: &str, colour: [u8; 3]) -> PlotMark {
    PlotMark::Text { at, anchor, text: text.to_owned(), colour, large: false }
}

/// A tick's number without needless digits.
pub fn plain(t: f64) -> String {
    format!("{}", to_digits(t, 3))
}

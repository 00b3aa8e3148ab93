//! Pieces as the drawings for people show them, on pages and on plots: cut and sewn lines, marks,
//! numbers of seams, words.
//!
//! - `laid`: a piece with its marks, and where each stands; `words`: what is written on it;
//!   `surface`: what a format must be able to draw.

mod laid;
mod surface;
mod words;

pub(crate) use laid::{CUT, DOTTED, FOLD, LaidPiece, SEW, THIN, laid};
pub(crate) use surface::{DrawingSurface, Style, TextAnchor, Type};
pub(crate) use words::{allowance, unknown_letters};

//! Where each block of a picture is in another one, by block matching.
//!
//! The page of the turntable and the view between two photos take it from here.

mod field;
mod level;
mod matching;

pub use field::{FlowField, Vector};
pub use level::Pyramid;
pub use matching::{BLOCK, PARTS, motion};

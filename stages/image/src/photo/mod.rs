//! Readers of photos.
//!
//! | file | what it holds |
//! |---|---|
//! | `photos` | the stage `Photos`: reads all photos of a pipeline in parallel |
//! | `entry` | how a photo is written in a pipeline file |
//! | `decode` | bytes to upright 8-bit sRGB pixels, with limits against decompression bombs |
//! | `given` | photos whose pixels a program gives |
//! | `expected` | how much the photos are, for what a run will take |
//! | `scale` | the scale and the plane of the ground from an object of known size |
//! | `form`, `tiff` | what kind of picture a file is |
//! | `side_names` | whether the style takes photos of these names |
//! | `header` | size and completeness of a picture before anything is decoded |

mod decode;
mod entry;
mod expected;
mod form;
mod frames;
mod given;
mod header;
mod photos;
mod resolve;
mod scale;
mod side_names;
#[cfg(test)]
mod tests;
mod tiff;

pub use decode::{Decoded, MAX_DECODED_BYTES, MAX_PIXELS, MAX_SIDE_PX, decode};
pub use entry::{MAX_PX_PER_METRE, MAX_WIDTH_M, MIN_PX_PER_METRE, MIN_WIDTH_M, PhotoEntry, PhotoFile};
pub use frames::frames;
pub use given::given_photos;
pub use photos::sides;
pub use photos::{Photos, read_photos};
pub use scale::ScaleObject;
pub use side_names::{Needs, needs};

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Photos>();
}

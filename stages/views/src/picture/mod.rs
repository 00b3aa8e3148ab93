//! Pictures as numbers.

mod order;
mod plane;
mod psnr;
mod rows;
mod sample;

pub use order::in_order;
pub use plane::GreyPlane;
pub(crate) use plane::brightness;
pub use psnr::{PSNR_OF_EQUAL, psnr, psnr_of};
pub(crate) use rows::by_rows;
pub use sample::{cubic, flipped};

//! True scale from a photo: an object of known size beside a garment, the plane that both lie on,
//! and the photo rectified.
//!
//! ```text
//! photo --find--> Found (corners, homography, px_per_metre) --rectify--> the ground from straight above
//!                   |
//!                   +--draw--> the photo with the object outlined
//! ```
//!
//! Cards, sheets and chessboards give the ground's plane, so that lengths hold all over it under
//! any tilt up to 35 degrees (60 for chessboards, and where the focal length is given). A ruler
//! gives a scale along itself alone. What is not sure is refused with a [`ScaleError`].
//!
//! ```
//! use image::{Rgb, RgbImage};
//! use toile_scale::{KnownObject, RectifyOptions, find, rectify};
//!
//! // White paper on a dark ground from straight above, 1000 pixels per metre.
//! let mut photo = RgbImage::from_pixel(800, 600, Rgb([70, 60, 50]));
//! for (x, y) in (200..497).flat_map(|x| (150..360).map(move |y| (x, y))) {
//!     photo.put_pixel(x, y, Rgb([235, 235, 230]));
//! }
//! let found = find(&photo, KnownObject::A4)?;
//! assert!((found.px_per_metre - 1000.0).abs() < 3.0);
//! let above = rectify(&photo, &found, &RectifyOptions::default())?;
//! assert!(above.px_per_metre > 950.0 && above.image.width() > 780);
//! # Ok::<(), toile_scale::ScaleError>(())
//! ```
//!
//! The same photo gives the same bits for any number of threads.
//!
//! Limits: the lens is taken for a pin-hole whose axis meets the photo's middle; distortion is not
//! corrected, and a photo that was cropped to one side gives a wrong tilt of small objects. The
//! object must lie flat on the garment's ground, whole in the frame. A rectangle of the object's
//! proportions is taken for it (a postcard of the paper's proportions, a board of two tones).
//! Without a focal length, that of a phone's main lens is assumed (26.5 mm on 35 mm film, 15 %
//! doubt).

mod chessboard;
mod draw;
mod error;
mod find;
mod found;
mod judge;
mod object;
mod options;
mod pixels;
mod pose;
mod quads;
mod rectangle;
mod rectify;
mod ridges;
mod ruler;
mod segments;
mod side;

pub use draw::draw;
pub use error::ScaleError;
pub use find::{find, find_with};
pub use found::{Found, ScaleKind};
pub use object::KnownObject;
pub use options::ScaleOptions;
pub use rectify::{Rectified, RectifyOptions, Sampling, rectify};

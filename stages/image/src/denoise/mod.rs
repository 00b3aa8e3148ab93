//! Denoisers: photo to photo.
//!
//! All work on the three sRGB channels alike, treat what lies past the frame as the nearest pixel
//! of the frame (clamped), and give the same bits for any number of threads: the image is cut into
//! bands of rows, every output pixel is computed by one thread.
//!
//! | stage | keeps edges | 12 megapixels on 2 cores |
//! |---|---|---|
//! | `NeighbourhoodMean` | no | 20 ms at radius 1 |
//! | `Median` | yes | 70 ms at radius 1, 0.4 s to 0.7 s above |
//! | `Gaussian` | no | 60 ms at sigma 1 |
//! | `Bilateral` | yes | 0.7 s at radius 3 |

mod bands;
mod bilateral;
mod gaussian;
mod join;
mod joined_pixels;
mod mean;
mod median;
#[cfg(test)]
mod tests;

pub use bilateral::{Bilateral, bilateral};
pub use gaussian::{Gaussian, gaussian};
pub use mean::{NeighbourhoodMean, Neighbours, neighbourhood_mean};
pub use median::{Median, median};

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<NeighbourhoodMean>().add::<Median>().add::<Gaussian>().add::<Bilateral>();
}

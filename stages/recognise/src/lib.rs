//! What a garment in a photo is: its parts, landmarks, kind, and how its limbs lie, by a small
//! network of our own.
//!
//! ```text
//! photo --letterbox--> square --network--> logits --seen--> probabilities in the photo's pixels
//! ```
//!
//! | file | what it holds |
//! |---|---|
//! | `words` | parts, kinds, landmarks, limbs and lies, by name |
//! | `weights` | the network's file, a part of the program, and its digest |
//! | `letterbox` | how a photo lies in the square that the network takes |
//! | `area` | a photo at another size |
//! | `network` | the network, from the file's bytes to lists of values |
//! | `maps` | maps of cells, read at places of the photo |
//! | `landmarks` | places of landmarks, finer than cells |
//! | `seen` | what it all means, as probabilities |
//! | `error` | why a photo is not recognised, in words |
//!
//! ```
//! use image::{Rgb, RgbImage};
//! use toile_recognise::{Part, see};
//!
//! let photo = RgbImage::from_pixel(80, 60, Rgb([200; 3]));
//! let seen = see(&photo, 1)?;
//! let sum: f64 = Part::ALL.iter().map(|part| seen.probability(*part, 40.0, 30.0)).sum();
//! assert!((sum - 1.0).abs() < 1e-5);
//! assert_eq!(seen.mask(8, 6).len(), 48);
//! # Ok::<(), toile_recognise::RecogniseError>(())
//! ```
//!
//! Cost: 40 ms a photo on one thread, 15 ms more where it has 12 megapixels; the file adds 5.3 MB
//! to the program.
//!
//! The same photo gives the same bits for any number of threads.
//!
//! Left and right are sides of the picture: where the garment shows its front, the wearer's left
//! sleeve is on the right.

mod area;
mod error;
mod fields;
mod landmarks;
mod letterbox;
mod maps;
mod network;
mod seen;
mod weights;
mod words;

pub use error::RecogniseError;
pub use landmarks::SeenLandmark;
pub use network::{GRID, PartsNetwork, SIDE, STRIDE};
pub use seen::SeenGarment;
pub use weights::{DIGEST, FILE};
pub use words::{GarmentKind, Landmark, Lie, Limb, Part};

use image::RgbImage;
use letterbox::Letterbox;
use std::sync::OnceLock;

/// The network of the program's own file, read when it is first needed.
static NETWORK: OnceLock<Result<PartsNetwork, RecogniseError>> = OnceLock::new();

/// What the program's own network sees in a photo, on so many threads, at least one.
///
/// # Errors
/// The photo has no pixels; the network's file is not the one that the program was built for; or
/// those of [`PartsNetwork::see`].
pub fn see(photo: &RgbImage, threads: usize) -> Result<SeenGarment, RecogniseError> {
    // Read outside of the lock: a thread that waits for its helpers there may take up another
    // photo, which would then wait for this one.
    let network = match NETWORK.get() {
        Some(network) => network,
        None => {
            let read = PartsNetwork::load(FILE);
            NETWORK.get_or_init(|| read)
        }
    };
    network.as_ref().map_err(RecogniseError::clone)?.see(photo, threads)
}

impl PartsNetwork {
    /// What the network sees in a photo, on so many threads, at least one.
    ///
    /// # Errors
    /// The photo has no pixels; the network breaks off, gives another shape than it said, or values
    /// that are no numbers.
    pub fn see(&self, photo: &RgbImage, threads: usize) -> Result<SeenGarment, RecogniseError> {
        let letterbox = Letterbox::of(photo.dimensions()).ok_or(RecogniseError::NoPixels)?;
        let logits = self.logits(&letterbox.levels(photo), threads)?;
        Ok(SeenGarment::of(&logits, letterbox))
    }
}

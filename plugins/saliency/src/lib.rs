//! A binariser by a small network for salient objects.
//!
//! | file | what it holds |
//! |---|---|
//! | `weights` | the file of the network: named, read, and compared with its digest |
//! | `network` | the network, from the file's bytes to a map of the photo |
//! | `border` | the map at the photo's size, its border drawn to the photo's edges |
//! | `holes` | holes of the mask, filled |
//! | `apart` | work on a thread of its own, so that a run can be stopped |
//! | `fault` | why a file is refused, in words |

mod apart;
mod border;
mod fault;
mod holes;
mod network;
mod weights;

pub use border::mask;
pub use fault::Unfit;
pub use network::{Guide, Map, Network, SIDE};

use toile_core::prelude::*;

/// Takes what a network for salient objects sees in the photo.
///
/// One more voice for `Auto()`, which takes the mask of a binariser before it. The network knows
/// objects, not garments: prints, cloth of two colours and patterned grounds mislead it less than
/// they mislead methods of colour, but it may leave out a sleeve, and takes a hanger in. Its
/// weights are a file of 4.6 MB that is not part of the program; plugins/saliency/README.md says
/// where it comes from. Holes are filled; transparent pixels are ground. A photo in which it sees
/// nothing gives an empty mask and a warning. Takes about 0.7 s per photo.
#[stage(
    role = Binariser,
    source = "Qin, Zhang, Huang, Dehghan, Zaiane, Jagersand 2020; He, Sun 2015",
    example = "Saliency(weights: \"u2netp.onnx\", digest: \"8b4bde6560ee1edb10b48184ecad7895a61aa8ebfd7c651089a7990172eb7b74\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty, Cancellable)
)]
pub struct Saliency {
    /// The network's file, ONNX, relative to the pipeline.
    #[param(default = String::new())]
    pub weights: String,
    /// The BLAKE3 digest of that file, 64 hexadecimal digits.
    #[param(default = String::new())]
    pub digest: String,
    /// How sure the network must be of a pixel of the garment.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    pub threshold: f64,
}

#[stage]
impl Saliency {
    /// Whether the file is there; what stands in it is looked at by the run.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let there = weights::named(&self.weights).and_then(|()| weights::there(&self.weights, placed.cx));
        there.err().into_iter().collect()
    }

    fn run(&self, photo: &Photo, cx: &Context) -> Result<Mask, StageError> {
        has_pixels(photo)?;
        cx.check()?;
        let bytes = weights::read(&self.weights, &self.digest, cx)?;
        let (seen, threshold, threads) = (photo.clone(), self.threshold, rayon::current_num_threads());
        let found = apart::apart(cx, move || found(bytes, &seen, threshold, threads))?;
        let pixels = found.map_err(|unfit| unfit.of(&self.weights))?;
        let mask = Mask { pixels: Shared::new(pixels) };
        tell(&mask, photo, cx);
        Ok(mask)
    }
}

/// The mask of a photo by the network of a file's bytes.
fn found(bytes: Vec<u8>, photo: &Photo, threshold: f64, threads: usize) -> Result<image::GrayImage, Unfit> {
    let network = Network::load(bytes)?;
    let guide = Guide::of(&photo.pixels);
    let map = network.map(&guide, threads)?;
    Ok(holes::filled(mask(&map, &guide, photo, threshold)))
}

/// Refuses photos of no pixels.
fn has_pixels(photo: &Photo) -> Result<(), StageError> {
    match photo.pixels.dimensions() {
        (0, _) | (_, 0) => Err(StageError::invalid(format!("photo \"{}\" has no pixels", photo.file))),
        _ => Ok(()),
    }
}

/// How much of the photo the mask covers, and a warning where it is nothing.
fn tell(mask: &Mask, photo: &Photo, cx: &Context) {
    let area = mask.area_px() as f64;
    cx.figure("garment", 100.0 * area / mask.pixels.as_raw().len() as f64, "% of the photo");
    if area == 0.0 {
        cx.warn(format!("the network sees nothing in \"{}\": its mask is empty", photo.file));
    }
}

toile_core::plugin!(Saliency);

//! Pictures of models without a window or a graphics card.
//!
//! A z-buffer rasteriser with four samples per pixel, mip-mapped textures and a soft studio light
//! whose shadows come from depth maps. [`render`] makes one picture; a [`ModelScene`] prepared once
//! makes several of the same model, which saves the part of the light that no view changes.
//!
//! Every picture is the same to the last bit for any number of threads: rows are shared out in
//! bands, and no band reads what another writes.

mod camera;
mod cover;
mod light;
mod mips;
mod orbit;
mod overlay;
pub(crate) mod parts;
mod photo_camera;
mod pictures;
mod remember;
mod scene;
mod shade;
mod surroundings;
pub(crate) mod tangents;
#[cfg(test)]
mod tests;

pub use camera::{Frame, View};
pub(crate) use mips::{Coding, LINEAR, Mips, encode};
pub use orbit::Orbit;
pub use overlay::OverlayLine;
pub(crate) use photo_camera::{PhotoCamera, PhotoShot};
pub use pictures::{ArtifactPicture, PANEL_COLOURS, PictureForm, garment_model, pictures_of};
pub(crate) use pictures::{escaped, jpeg, thumbnail};
pub use scene::ModelScene;
pub use surroundings::Surroundings;

use image::RgbImage;
use toile_core::artifact::Model;

/// The name of the mesh that is the body.
const BODY: &str = "body";

/// One picture of a model.
///
/// An empty model gives the bare background; triangles that are degenerate or not finite are left
/// out.
pub fn render(model: &Model, view: &View) -> RgbImage {
    ModelScene::new(model).render(view)
}

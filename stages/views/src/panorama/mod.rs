//! Photos of a camera that turns to one panorama.
//!
//! | file | what it holds |
//! |---|---|
//! | `cylinder` | the stage `Cylinder` |
//! | `lens` | the focal length as a user gives it |
//! | `camera` | a photo unrolled from the cylinder around its camera |
//! | `phase` | shifts that two photos may have, by phase correlation |
//! | `align` | the shift to a fraction of a pixel |
//! | `pair` | one photo registered with the next |
//! | `focal` | the focal length, from the photos |
//! | `layout` | all photos around the camera, the ring closed |
//! | `exposure` | a gain for each photo |
//! | `canvas` | what each photo shows of the panorama |
//! | `blend`, `multiband` | the panorama's pixels |

mod align;
mod blend;
mod camera;
mod canvas;
mod cylinder;
mod exposure;
mod focal;
mod layout;
mod lens;
mod multiband;
mod pair;
mod phase;
#[cfg(test)]
mod tests;

pub use blend::Blend;
pub use cylinder::{Cylinder, MAX_PHOTOS, MIN_SIDE_PX};
pub use layout::CameraTurn;
pub use lens::Lens;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Cylinder>();
}

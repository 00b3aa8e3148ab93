//! Pictures from pictures, without geometry between them or with as much of it as they show.
//!
//! ```text
//! photos of a camera that turns --Cylinder--> one panorama
//! photos from several places    --FlowView, DepthView, LightField--> the view from another place
//! ```
//!
//! | folder | what it holds |
//! |---|---|
//! | `panorama` | the stage `Cylinder`: warp, registration, closing of the ring, blending |
//! | `between` | views between views: `FlowView` by motion, `DepthView` by depth, `LightField` by rays |
//! | `flow` | block matching, which the turntable's page uses as well |
//! | `picture` | pictures as numbers: sampling, reduction, likeness, names in order |

pub mod between;
pub mod flow;
pub mod panorama;
pub mod picture;

use toile_core::Registry;

/// Adds this crate's stages.
pub fn register(registry: &mut Registry) {
    panorama::register(registry);
    between::register(registry);
}

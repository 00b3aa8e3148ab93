//! Bodies: made from measurements or read from a file.

mod body_obj;
mod bridge;
mod estimate;
mod field;
mod figure;
mod isosurface;
mod landmarks;
mod limb;
mod mannequin;
mod slice;
mod spline;
mod thin;
mod topology;

pub use body_obj::{BodyObj, Units, Up};
pub(crate) use bridge::bridged;
pub use mannequin::Mannequin;
pub(crate) use slice::{convex_hull, slice, trunk};
pub(crate) use thin::grown;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Mannequin>();
    registry.add::<BodyObj>();
}

#[cfg(test)]
pub(crate) mod tests;

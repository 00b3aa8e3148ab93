//! Bodies: made from measurements or read from a file.

mod body_obj;
mod estimate;
mod field;
mod figure;
mod isosurface;
mod landmarks;
mod limb;
mod mannequin;
mod slice;
mod spline;
mod topology;

pub use body_obj::{BodyObj, Units, Up};
pub use mannequin::Mannequin;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Mannequin>();
    registry.add::<BodyObj>();
}

#[cfg(test)]
pub(crate) mod tests;

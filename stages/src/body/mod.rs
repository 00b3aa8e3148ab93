//! Bodies: made from measurements or read from a file.

mod field;
mod figure;
mod isosurface;
mod landmarks;
mod mannequin;
mod slice;
mod spline;
mod topology;

pub use mannequin::Mannequin;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Mannequin>();
}

#[cfg(test)]
pub(crate) mod tests;

//! Fabrics: presets and measured values.

mod curve;
mod kes;
mod preset;
mod sheet;
#[cfg(test)]
mod tests;

pub use curve::tensile_curve;
pub use kes::Kes;
pub use preset::Preset;
pub use sheet::Cloth;
use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Preset>().add::<Kes>().add::<Cloth>();
}

/// Velocity damping of a fabric that is not measured, 1/s: air and inner friction stop a swinging
/// hem within a second.
pub(crate) const AIR_DAMPING: f64 = 1.0;

//! The judgement of a finished garment, behind `metrics.json`, and its fit.

mod fit;
pub(crate) mod girth;
mod looks;
mod on_body;
mod quality;
mod tight;

pub use fit::Fit;
pub use quality::Measure;

use toile_core::Registry;

/// Adds the judgement to every pipeline that makes a garment.
pub fn register(registry: &mut Registry) {
    registry.add::<Fit>();
    registry.add_implicit::<Measure>();
}

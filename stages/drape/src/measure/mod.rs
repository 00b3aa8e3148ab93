//! The judgement of a finished garment, behind `metrics.json`.

pub mod girth;
mod looks;
mod on_body;
mod parts;
mod quality;
mod shortfalls;
pub mod tight;
mod volume_table;

pub use quality::{Measure, panel_figures};
pub use volume_table::VolumeTable;

use toile_core::Registry;
use toile_core::artifact::Garment;

/// Adds the judgement to every pipeline that makes a garment, and the table of volumes.
pub fn register(registry: &mut Registry) {
    registry.add_implicit::<Measure>();
    registry.add::<VolumeTable>();
}

/// The garment by the pattern that it was sewn from; one from a 3D file has no pattern before it is
/// laid flat.
pub fn with_pattern<'a>(sewn: &'a Garment, flat: Option<&'a Garment>) -> &'a Garment {
    let first = sewn.rest.first();
    let is_known = sewn.rest.iter().any(|p| Some(p) != first);
    flat.filter(|_| !is_known).unwrap_or(sewn)
}

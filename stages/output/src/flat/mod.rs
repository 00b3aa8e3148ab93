//! Back to the flat pattern: garments from 3D files, and flatteners, which make a sewing pattern of
//! a garment.
//!
//! ```text
//! Garment3d (file) --> garment --sheet--> pieces --flattener--> flat pieces --care--> pattern, and the garment with its flat places
//! ```
//!
//! The work is that of `toile-flatten`; here stand what goes between garments and pieces (`sheet`),
//! what makes a pattern of flat pieces (`drawn`), and the table by which a flattening is judged
//! (`table`).

mod arap;
mod dart;
mod drawn;
mod fault;
mod file;
mod flattened;
mod garment3d;
mod lscm;
mod overlay;
mod sheet;
mod spring_flatten;
mod strain_svg;
mod symmetric_dirichlet;
mod table;
#[cfg(test)]
mod tests;
mod woven;

pub use arap::Arap;
pub use dart::Darts;
pub use file::{FileMeshes, PiecesBy, file_meshes};
pub use flattened::Care;
pub use garment3d::{FileUnit, FlatShape, Garment3d};
pub use lscm::Lscm;
pub use spring_flatten::SpringFlatten;
pub use symmetric_dirichlet::SymmetricDirichlet;
pub use table::FlatTable;
pub use woven::Woven;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<Garment3d>();
    registry.add::<Arap>();
    registry.add::<Lscm>();
    registry.add::<SpringFlatten>();
    registry.add::<SymmetricDirichlet>();
    registry.add::<Woven>();
    registry.add::<FlatTable>();
}

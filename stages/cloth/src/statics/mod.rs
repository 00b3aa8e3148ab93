//! The static solver: brings a garment to static equilibrium on a multilevel mesh.
//!
//! Folders in the order in which they depend on each other: `forces`, `factor`, `levels`, `newton`,
//! `report`, `drive`. The entry point is `drive::solve`.

pub mod drive;
pub mod factor;
pub mod forces;
pub mod levels;
pub mod newton;
pub mod report;

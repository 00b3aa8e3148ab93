//! The multilevel mesh of a garment, and the forces on each mesh level.
//!
//! Depends on `forces`.

pub(crate) mod assemble;
pub(crate) mod bending_continuation;
pub(crate) mod buckle;
pub(crate) mod cloths;
pub mod coarsen;
pub(crate) mod mesh_level;
pub mod pieces;
#[cfg(test)]
pub(crate) mod testing;

//! Pattern care: what a flat piece needs to be a pattern that can be cut and sewn.
//!
//! Seams whose two sides come out equal, straight edges straight, left and right mirror images,
//! darts where the strain is too large.

mod care_options;
mod chains;
mod dart_path;
mod dart_tips;
mod darts;
mod laid;
mod mirror;
mod objective;
mod outline;
mod outline_mirror;
mod piece_care;
mod refine;
mod seam_lengths;
mod straight;
#[cfg(test)]
mod tests;

pub use care_options::CareOptions;
pub use chains::boundary_chains;
pub use darts::{Dart, DartOptions, cut_darts, dart_tip, propose_darts};
pub use mirror::{MirrorPair, mirror_distance, mirror_pairs};
pub use objective::Objective;
pub use outline_mirror::OutlinePair;
pub use refine::{CareReport, refine};
pub use seam_lengths::SeamLengths;
pub use straight::{is_straight, straight_chains};

use nalgebra::Point2;

/// The length of the line through these vertices of a flat piece.
#[must_use]
pub fn flat_length(vertices: &[u32], flat: &[Point2<f64>]) -> f64 {
    crate::newton::chain_length(vertices, flat)
}

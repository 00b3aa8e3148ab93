//! What pieces are moved by.

use crate::place::sew::Offsets;
use toile_core::prelude::*;

/// The body and the pattern, and what is known of the pieces.
pub(super) struct MoveInput<'a> {
    pub(super) body: &'a Body,
    pub(super) pattern: &'a Pattern,
    pub(super) seams: &'a [GarmentSeam],
    pub(super) offsets: &'a Offsets<'a>,
    /// The sleeves of a pattern without places, each with the hand of its arm.
    pub(super) sleeves: Option<&'a [(String, Hand)]>,
    /// Least distance of a bent piece from the arm, metres.
    pub(super) clearance: f64,
}

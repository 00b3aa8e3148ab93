//! The driver of the static solver: plans the levels, sews, drapes, and resolves intersections.
//!
//! Depends on all other folders.

pub(crate) mod coarse_to_fine;
pub(crate) mod contour;
pub(crate) mod dips;
mod drape;
pub(crate) mod fallen;
pub(crate) mod held;
pub(crate) mod initial;
pub(crate) mod intersections;
pub mod live;
pub(crate) mod plan;
pub(crate) mod sew;
pub mod solve;
pub mod trial;

//! A whole garment to rest: laid out, sewn, draped and taken out of itself.
//!
//! Depends on all other rooms.

pub(crate) mod coarse_to_fine;
pub(crate) mod contour;
pub(crate) mod drape;
pub(crate) mod fallen;
pub(crate) mod held;
pub(crate) mod initial;
pub mod live;
pub(crate) mod plan;
pub(crate) mod sew;
pub mod solve;
pub(crate) mod unknot;

//! Straight to static equilibrium, coarse to fine.

pub mod dissect;
pub mod multifrontal;
pub mod pattern;

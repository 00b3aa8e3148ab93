//! Straight to static equilibrium, coarse to fine.

pub mod dissect;
pub mod elastic;
pub mod multifrontal;
pub mod pattern;

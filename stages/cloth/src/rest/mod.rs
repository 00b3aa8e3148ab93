//! Straight to static equilibrium, coarse to fine.

pub mod clear;
pub mod coarsen;
pub mod dissect;
pub mod elastic;
pub mod layers;
pub mod multifrontal;
pub mod newton;
pub mod pattern;
pub mod pieces;
pub mod solve;
pub mod system;

//! Straight to static equilibrium, coarse to fine.

pub mod clear;
pub mod coarsen;
pub mod dissect;
pub mod elastic;
mod front;
pub mod layers;
mod linear;
pub mod multifrontal;
mod nearby;
pub mod newton;
pub mod pattern;
pub mod pieces;
pub mod solve;
pub mod system;

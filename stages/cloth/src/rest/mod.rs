//! Straight to static equilibrium, coarse to fine.

mod assemble;
mod awake;
pub mod clear;
pub mod coarsen;
mod dense;
pub mod dissect;
mod drape;
pub mod elastic;
mod first;
mod front;
mod graded;
pub mod grip;
pub mod layers;
mod level;
mod linear;
pub mod live;
pub mod multifrontal;
mod nearby;
pub mod newton;
mod part;
pub mod pattern;
pub mod pieces;
pub mod press;
mod rub;
mod sew;
pub mod solve;
pub mod system;

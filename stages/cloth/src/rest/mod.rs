//! Straight to static equilibrium, coarse to fine.

mod assemble;
mod awake;
pub mod clear;
pub mod coarsen;
mod dense;
pub mod dissect;
mod drape;
mod ears;
pub mod elastic;
mod error;
pub(crate) mod fallen;
mod first;
mod front;
mod graded;
pub mod grip;
pub mod layers;
mod level;
mod linear;
pub mod live;
mod mixed;
pub mod multifrontal;
mod nearby;
pub mod newton;
mod part;
pub mod pattern;
pub mod pieces;
mod pierce;
mod pile;
mod plan;
pub mod press;
pub mod real;
mod rub;
mod search;
mod sew;
pub mod solve;
pub mod start;
pub mod support;
pub mod system;
mod tangled;
pub mod thread;
#[cfg(test)]
mod trial;
pub mod unrest;
pub(crate) mod words;
mod work;

pub(crate) use dense::probe_factor;

//! Estimates before a run: the sizes of artifacts along a pipeline's edges, and what stages took in
//! earlier runs.
//!
//! Before a run, [`foresee`] walks the pipeline and estimates for every stage the sizes of its
//! inputs and outputs. During a run a [`Meter`] measures what each stage takes. The laws of time
//! and memory that are fitted to both are outside this crate: only sizes and measures are here and
//! in [`toile_core::cost`].

mod foresee;
mod meter;
mod rules;
#[cfg(test)]
mod tests;

pub use foresee::{Foreseen, foresee, given};
pub use meter::{Expect, Meter, StageCost};
pub use rules::{EDGE_LENGTHS, usual};
pub use toile_core::cost::*;

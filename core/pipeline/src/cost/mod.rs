//! What a run will take, before it runs: sizes that travel along a pipeline's edges, and what
//! stages took.
//!
//! Before a run, [`foresee`] walks the pipeline and says of every stage how much it will be given
//! and how much it will make. During a run a [`Meter`] says what each stage took. What follows from
//! both, laws of time and memory, lies outside this crate: the amounts are here and in
//! [`toile_core::cost`], the model is not.

mod foresee;
mod meter;
mod rules;
#[cfg(test)]
mod tests;

pub use foresee::{Foreseen, foresee, given};
pub use meter::{Expect, Meter, StageCost};
pub use rules::{EDGE_LENGTHS, usual};
pub use toile_core::cost::*;

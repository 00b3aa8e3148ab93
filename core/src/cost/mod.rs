//! What a run will take, before it runs: sizes that travel along a pipeline's edges, and what stages took.
//!
//! Before a run, [`foresee`] walks the pipeline and says of every stage how much it will be given and how much it will
//! make: a photo's pixels from its file's header, triangles from the garment's area and the edge length. During a run a
//! [`Meter`] says what each stage took. What follows from both, laws of time and memory, lies outside this crate: core
//! holds the amounts, not the model.
//!
//! A stage that can say more than the rules of its role has `fn foresee(&self, given: &Size, cx: &Context) -> Option<Size>`
//! beside its `run`; all others need not care.

mod estimate;
mod fact;
mod foresee;
mod rules;
mod size;
#[cfg(test)]
mod tests;
mod used;

pub use estimate::{Estimate, Predicted};
pub use fact::size_of;
pub use foresee::{Foreseen, foresee, given};
pub use rules::{EDGE_LENGTHS, garment_area, usual};
pub use size::{Quantity, Size};
pub use used::{Expect, Meter, StageCost, Used};

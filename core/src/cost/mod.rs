//! Amounts: how much there is of what stages work on, and what a stage takes for it.
//!
//! Sizes are estimated along a pipeline's edges before anything runs (`toile_pipeline::cost`): a
//! photo's pixels from its file's header, triangles from the garment's area and the edge length.
//!
//! A stage that can say more than the rules of its role has
//! `fn sizes(&self, given: &Size, cx: &Context) -> Option<Size>` beside its `run`; all others
//! need not care.

mod estimate;
mod size;
mod used;

pub use estimate::{Estimate, Predicted};
pub use size::{Quantity, Size, garment_area};
pub use used::Used;

//! Measuring stages while they run.

use super::{Predicted, Size, Used};
use crate::Pipeline;

/// Measures stages, one after the other.
pub trait Meter: std::fmt::Debug + Send + Sync {
    /// A stage begins its work.
    fn start(&self);
    /// The stage that began last is done.
    fn stop(&self) -> Used;
}

/// Says what stages will take. A run asks it for those stages alone that it had to run whole, and
/// not before they have.
pub trait Expect: std::fmt::Debug + Send + Sync {
    /// What the stage of that index is expected to take; none where nothing is known of it.
    fn expected(&self, pipeline: &Pipeline, node: usize) -> Option<Predicted>;
}

/// A stage that ran whole, with what it took and how much it made.
#[derive(Debug, Clone, PartialEq)]
pub struct StageCost {
    /// Its id.
    pub stage: String,
    /// What it took.
    pub used: Used,
    /// What it made, all ports together.
    pub made: Size,
}

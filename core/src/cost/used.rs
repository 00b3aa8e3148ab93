//! What a stage took.

use super::{Predicted, Size};
use crate::pipeline::Pipeline;
use serde::{Deserialize, Serialize};

/// What a stage took for its own work: without finding, reading and keeping results of the cache.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Used {
    /// Wall time, seconds.
    pub wall_s: f64,
    /// Processor time of all threads, seconds; none where nobody measures it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cpu_s: Option<f64>,
    /// Memory at its peak beyond what was held before, bytes; none where nobody counts. Entries of a set that run at
    /// the same time share it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_bytes: Option<u64>,
    /// Memory that stayed held after it beyond what was held before, bytes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_bytes: Option<u64>,
}

/// Measures stages, one after the other.
pub trait Meter: std::fmt::Debug + Send + Sync {
    /// A stage begins its work.
    fn start(&self);
    /// The stage that began last is done.
    fn stop(&self) -> Used;
}

/// Says what stages will take. A run asks it for those stages alone that it had to run whole, and not before they have.
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

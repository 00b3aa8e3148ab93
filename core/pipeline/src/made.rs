//! What one run of a stage gave, for the runner and for the cache.

use toile_core::artifact::{Digest, Measure};
use toile_core::{PortValue, Remarks};

/// What one run of a stage gave.
#[derive(Debug)]
pub(crate) struct EntryResult {
    /// The entry of its sets; empty where it is not mapped.
    pub(crate) entry: String,
    pub(crate) outputs: Vec<PortValue>,
    pub(crate) figures: Vec<Measure>,
    pub(crate) remarks: Remarks,
    /// The files that it read.
    pub(crate) reads: Vec<(String, Option<Digest>)>,
}

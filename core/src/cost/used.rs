//! What a stage took.

use serde::{Deserialize, Serialize};

/// What a stage took for its own work: without finding, reading and keeping results of the cache.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Used {
    /// Wall time, seconds.
    pub wall_s: f64,
    /// Processor time of all threads, seconds; none where it is not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cpu_s: Option<f64>,
    /// Memory at its peak beyond what was held before, bytes; none where it is not counted. Entries
    /// of a set that run at the same time share it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_bytes: Option<u64>,
    /// Memory that stayed held after it beyond what was held before, bytes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_bytes: Option<u64>,
}

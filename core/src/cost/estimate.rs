//! A figure that is not known yet.

use serde::{Deserialize, Serialize};

/// A value with the range that 80 of 100 cases lie in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The middle: as often less as more.
    pub value: f64,
    /// One case of ten is less.
    pub low: f64,
    /// One case of ten is more.
    pub high: f64,
}

impl Estimate {
    /// True where a measured value lies in the range.
    pub fn holds(&self, fact: f64) -> bool {
        (self.low..=self.high).contains(&fact)
    }
}

/// What a stage is expected to take.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Predicted {
    /// Wall time, seconds.
    pub wall_s: Option<Estimate>,
    /// Processor time of all threads, seconds.
    pub cpu_s: Option<Estimate>,
    /// Memory at its peak beyond what was held before, bytes.
    pub peak_bytes: Option<Estimate>,
    /// Memory that stays held after it, bytes.
    pub kept_bytes: Option<Estimate>,
}

//! A setting and what came of it.

use super::Clock;
use crate::errors::Errors;
use crate::front::Cost;
use crate::knobs::slot::Setting;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;

/// A setting and what came of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Digest of the pipeline that it makes; also the name of its pictures.
    pub key: String,
    /// Knobs and their values; empty for the pipeline as it is.
    pub setting: Setting,
    /// Overrides of the pipeline file that make it.
    pub overrides: Vec<(String, String)>,
    /// What came of it.
    pub outcome: SettingOutcome,
}

impl Point {
    /// Its figures, where it ran.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            SettingOutcome::Measured(m) => Some(m),
            _ => None,
        }
    }
}

/// What came of a setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SettingOutcome {
    /// It ran.
    Measured(Box<Measured>),
    /// A stage refused or failed.
    Failed {
        /// The stable word.
        code: String,
        /// The sentence.
        message: String,
    },
    /// It was stopped after so many seconds.
    OverLimit {
        /// Seconds.
        seconds: f64,
    },
}

impl SettingOutcome {
    /// Whether a run with that limit would end no later.
    pub(crate) fn stands(&self, limit: Duration) -> bool {
        !matches!(self, SettingOutcome::OverLimit { seconds } if *seconds < 0.99 * limit.as_secs_f64())
    }
}

/// The figures of a setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Wall time of each run, seconds.
    pub wall_s: Vec<f64>,
    /// Processor time of each run, seconds.
    pub cpu_s: Vec<f64>,
    /// Greatest memory held, bytes.
    pub peak_memory_bytes: Option<u64>,
    /// Wall time by stage in the first run, seconds.
    pub stages_s: BTreeMap<String, f64>,
    /// Triangles of the garment.
    pub triangles: usize,
    /// Against the reference.
    pub errors: Errors,
    /// Ease of this garment.
    pub ease_mm: BTreeMap<String, f64>,
    /// Quality limits of the pipeline that it misses: code and sentence.
    pub shortfalls: Vec<(String, String)>,
    /// False where it misses a limit that the reference keeps.
    pub sound: bool,
    /// False where its runs gave other garments.
    pub repeatable: bool,
}

impl Measured {
    /// The middle of the runs' times.
    pub fn time(&self, clock: Clock) -> f64 {
        median(self.times(clock))
    }

    /// Of each run, seconds.
    fn times(&self, clock: Clock) -> &[f64] {
        match clock {
            Clock::Wall => &self.wall_s,
            Clock::Cpu => &self.cpu_s,
        }
    }

    /// From the quickest to the slowest run, seconds.
    pub fn time_spread(&self, clock: Clock) -> f64 {
        let times = self.times(clock).iter();
        let (lo, hi) = times.fold((f64::INFINITY, 0.0_f64), |(lo, hi), t| (lo.min(*t), hi.max(*t)));
        (hi - lo).max(0.0)
    }

    /// What the front is drawn by: time, and the distance that 95 % of the surface keep, mm.
    pub fn cost(&self, clock: Clock) -> Cost {
        Cost { time: self.time(clock), error: self.errors.distance_mm.p95 }
    }
}

pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => (sorted[n / 2 - 1] + sorted[n / 2]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_runs_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[3.0, 1.0]), 2.0);
        assert!(median(&[]).is_nan());
    }
}

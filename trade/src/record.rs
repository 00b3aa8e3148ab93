//! What was measured, as it is written to `trade.json` and read back.

use crate::errors::{Errors, Millimetres};
use crate::front::{Cost, front};
use crate::slot::Setting;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::{SystemTime, UNIX_EPOCH};

/// The version of this form; raised when old files cannot be read any more.
pub const SCHEME: u32 = 1;

/// Which clock the front is drawn by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// What passes for the user.
    #[default]
    Wall,
    /// What the processors work, all together: the one to look at on a busy machine.
    Cpu,
}

impl Clock {
    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Clock::Wall => "wall",
            Clock::Cpu => "cpu",
        }
    }
}

/// Where it was measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// `linux x86_64`.
    pub system: String,
    /// Cores that the system offers.
    pub cores: usize,
    /// Threads that the stages used.
    pub threads: usize,
    /// Load of the machine over a minute at the end, where the system tells: beyond the threads used, others worked too.
    pub load: Option<f64>,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        let load = std::fs::read_to_string("/proc/loadavg").ok();
        Machine {
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            threads: rayon::current_num_threads(),
            load: load.and_then(|l| l.split(' ').next()?.parse().ok()),
        }
    }
}

/// A knob.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KnobRecord {
    /// `mesher.edge`.
    pub key: String,
    /// What it may be, in words.
    pub values: String,
}

/// One refinement of the reference.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// What is refined, and how far.
    pub setting: Setting,
    /// Overrides of the pipeline file that make it.
    pub overrides: Vec<(String, String)>,
    /// Triangles of the garment.
    pub triangles: usize,
    /// Seconds.
    pub wall_s: f64,
    /// Seconds.
    pub cpu_s: f64,
    /// Distance from the level before.
    pub moved_mm: Option<Millimetres>,
    /// Displacement from the level before.
    pub displaced_mm: Option<Millimetres>,
    /// Ease.
    pub ease_mm: BTreeMap<String, f64>,
    /// 99th percentile of the strain, percent.
    pub strain_p99: f64,
}

/// Order and rest of one figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Observed order; none where it is beyond all bounds (the last two levels were equal).
    pub order: Option<f64>,
    /// What the finest level still lacks, millimetres.
    pub missing_mm: f64,
}

/// How much the garment differs from itself when its start is moved a little.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnSpread {
    /// Root mean square move of the starts, millimetres.
    pub jitter_mm: f64,
    /// The level that was started anew.
    pub level: usize,
    /// Distance of each from the same level without jitter.
    pub starts_mm: Vec<Millimetres>,
    /// Starts that failed, with the reason.
    pub failed: Vec<String>,
}

impl OwnSpread {
    /// The worst of the starts: 95 % of the surface, millimetres.
    pub fn p95(&self) -> Option<f64> {
        self.starts_mm.iter().map(|m| m.p95).reduce(f64::max)
    }
}

/// What the errors are measured against.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Factor from level to level.
    pub ratio: f64,
    /// From the pipeline's own setting to the reference, the last.
    pub levels: Vec<Level>,
    /// Of the mean distance between levels; none where it does not shrink.
    pub mean: Option<Order>,
    /// Of the distance that 95 % keep.
    pub p95: Option<Order>,
    /// Of the mean displacement.
    pub displacement: Option<Order>,
    /// Why it went no finer.
    pub stopped: String,
    /// Its own spread; none where no start was tried.
    pub spread: Option<OwnSpread>,
    /// Of the reference garment.
    pub ease_mm: BTreeMap<String, f64>,
}

/// What came of a setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
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
        median(match clock {
            Clock::Wall => &self.wall_s,
            Clock::Cpu => &self.cpu_s,
        })
    }

    /// From the quickest to the slowest run, seconds.
    pub fn time_spread(&self, clock: Clock) -> f64 {
        let times = match clock {
            Clock::Wall => &self.wall_s,
            Clock::Cpu => &self.cpu_s,
        };
        let (lo, hi) = times.iter().fold((f64::INFINITY, 0.0_f64), |(lo, hi), t| (lo.min(*t), hi.max(*t)));
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
    pub outcome: Outcome,
}

impl Point {
    /// Its figures, where it ran.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Measured(m) => Some(m),
            _ => None,
        }
    }
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trade {
    /// [`SCHEME`].
    pub scheme: u32,
    /// The program's version.
    pub toile: String,
    /// The pipeline's name.
    pub pipeline: String,
    /// Its file.
    pub file: String,
    /// Day of the measurement, `2026-11-22`.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Which clock the front is drawn by.
    pub clock: Clock,
    /// The stage that runs ended at; none for the whole pipeline.
    pub until: Option<String>,
    /// Whether each run had a process of its own, so that memory is that of the run.
    #[serde(default)]
    pub apart: bool,
    /// What was turned.
    pub knobs: Vec<KnobRecord>,
    /// What the errors are against.
    pub reference: Reference,
    /// Settings in the order in which they were measured; the first is the pipeline's own.
    pub points: Vec<Point>,
    /// Indices of points that none beats in time and distance (95 %), by ascending time.
    pub front: Vec<usize>,
}

/// The points that keep the pipeline's limits and that none of those beats.
pub fn front_of(points: &[Point], clock: Clock) -> Vec<usize> {
    let nothing = Cost { time: f64::NAN, error: f64::NAN };
    let cost = |p: &Point| p.measured().filter(|m| m.sound).map_or(nothing, |m| m.cost(clock));
    front(&points.iter().map(cost).collect::<Vec<_>>())
}

/// Today, UTC (days to date: Hinnant 2013).
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    date_of((seconds / 86_400) as i64)
}

fn date_of(days: i64) -> String {
    let z = days + 719_468;
    let (era, day) = (z.div_euclid(146_097), z.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let m = (5 * day + 2) / 153;
    let (d, m) = (day - (153 * m + 2) / 5 + 1, if m < 10 { m + 3 } else { m - 9 });
    format!("{:04}-{m:02}-{d:02}", year + era * 400 + i64::from(m <= 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_dates() {
        assert_eq!(date_of(0), "1970-01-01");
        assert_eq!(date_of(59), "1970-03-01");
        assert_eq!(date_of(11_016), "2000-02-29");
        assert_eq!(date_of(20_779), "2026-11-22");
    }

    #[test]
    fn the_middle_of_the_runs_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[3.0, 1.0]), 2.0);
        assert!(median(&[]).is_nan());
    }
}

//! What was measured, as it is written to `trade.json` and read back.

mod clock;
mod day;
mod machine;
mod point;
mod reference;

pub use clock::Clock;
pub use day::today;
pub use machine::Machine;
pub(crate) use point::median;
pub use point::{Measured, Point, SettingOutcome};
pub use reference::{NeighbourLevels, Order, OwnSpread, Reference, ReferenceLevel};

use crate::front::{Cost, front};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of this form; raised when old files cannot be read any more.
pub const SCHEME: u32 = 1;

/// A knob.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KnobRecord {
    /// `mesher.edge`.
    pub key: String,
    /// What it may be, in words.
    pub values: String,
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
    /// Files that the pipeline read, with the digests of their contents.
    #[serde(default)]
    pub reads: BTreeMap<String, Option<String>>,
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

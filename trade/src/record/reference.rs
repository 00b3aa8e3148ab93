//! What settings are measured against: levels, what they show, and the spread of moved starts.

use crate::errors::Millimetres;
use crate::knobs::slot::Setting;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What the errors are measured against.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Factor from level to level.
    pub ratio: f64,
    /// From the pipeline's own setting to the reference, the last.
    pub levels: Vec<ReferenceLevel>,
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
    /// How far it ends from neighbouring resolutions; none where none was tried, or by an earlier
    /// version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neighbours: Option<NeighbourLevels>,
    /// Of the reference garment.
    pub ease_mm: BTreeMap<String, f64>,
}

/// One refinement of the reference.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ReferenceLevel {
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
    /// By which factor it is finer than the level before; none in the first, and in records of
    /// earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finer: Option<f64>,
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

/// How much a level differs from ones that are a fiftieth finer and coarser.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NeighbourLevels {
    /// The level.
    pub level: usize,
    /// Distance of each from the level.
    pub apart_mm: Vec<Millimetres>,
    /// Those that failed, with the reason.
    pub failed: Vec<String>,
}

impl NeighbourLevels {
    /// The worst of them: 95 % of the surface, millimetres.
    pub fn p95(&self) -> Option<f64> {
        self.apart_mm.iter().map(|m| m.p95).reduce(f64::max)
    }
}

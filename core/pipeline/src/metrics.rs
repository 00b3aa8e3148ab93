//! `metrics.json`: the figures of a run, a contract with users.

use crate::cost::{Predicted, Used};
use serde::Serialize;
use std::collections::BTreeMap;
use toile_core::Remarks;
use toile_core::artifact::{Figures, GarmentFigures, Measure, PanelFigures};

/// One stage's line.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageMetrics {
    /// Its id in the pipeline.
    pub id: String,
    /// Its name.
    pub name: String,
    /// Wall time, seconds; 0 where it was skipped.
    pub wall_s: f64,
    /// True where its result came from the cache.
    pub cached: bool,
    /// Why it was not run, where it was not.
    pub skipped: Option<String>,
    /// Figures that the stage gave: name to value (units stand in its card).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub figures: BTreeMap<String, f64>,
    /// `notes` and `warnings` that the stage gave.
    #[serde(flatten)]
    pub remarks: Remarks,
    /// What its own work took, where it ran whole and somebody measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub used: Option<Used>,
    /// What it was expected to take, where that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub predicted: Option<Predicted>,
}

impl StageMetrics {
    /// Figures by name; those of a mapped stage carry the panel's name before their own.
    pub(crate) fn figure_map(figures: &[Measure]) -> BTreeMap<String, f64> {
        figures.iter().map(|m| (m.name.clone(), m.value)).collect()
    }
}

/// The garment's figures with those of the machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GarmentMetrics {
    /// The garment's own.
    #[serde(flatten)]
    pub figures: GarmentFigures,
    /// Threads used.
    pub threads: usize,
    /// Greatest memory held, bytes, where the system reports it.
    pub peak_memory_bytes: Option<u64>,
}

/// A whole run, SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Metrics {
    /// The pipeline's name.
    pub pipeline: String,
    /// The named quality that it was run at: `Draft`, `Draft, changed by --set`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quality: Option<String>,
    /// Wall time of all stages together, seconds.
    pub wall_s: f64,
    /// Stage by stage, in order.
    pub stages: Vec<StageMetrics>,
    /// By panel.
    pub panels: BTreeMap<String, PanelFigures>,
    /// By piece that was laid flat: how far the flat piece is from the garment. `panels` and
    /// `garment` are those of the pattern that it was sewn from.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub flat: BTreeMap<String, PanelFigures>,
    /// The garment; `None` where the run made none.
    pub garment: Option<GarmentMetrics>,
    /// The result's shortfalls against its quality limits: code and sentence.
    pub shortfalls: Vec<(String, String)>,
}

impl Metrics {
    /// Puts the judgement of the garment in.
    pub(crate) fn judge(&mut self, figures: &Figures) {
        self.panels = figures.panels.clone();
        self.flat = figures.flat.clone();
        self.garment = Some(GarmentMetrics {
            figures: figures.garment.clone(),
            threads: rayon::current_num_threads(),
            peak_memory_bytes: peak_memory(),
        });
        let line = |s: &toile_core::artifact::Shortfall| (s.code.to_string(), s.message.clone());
        self.shortfalls = figures.shortfalls.iter().map(line).collect();
    }

    /// As JSON text.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

/// The high-water mark of resident memory, from the kernel's own record (Linux).
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib * 1024)
}

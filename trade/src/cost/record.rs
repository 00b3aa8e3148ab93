//! What a stage took, once.

use serde::{Deserialize, Serialize};
use toile_core::cost::{Predicted, Size, Used};

/// What is predicted of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CostFigure {
    /// Wall time, seconds.
    Wall,
    /// Processor time of all threads, seconds.
    Cpu,
    /// Memory at its peak beyond what was held before, bytes.
    Peak,
    /// Memory that stays held after it, bytes.
    Kept,
}

impl CostFigure {
    /// Every figure.
    pub const ALL: [CostFigure; 4] = [CostFigure::Wall, CostFigure::Cpu, CostFigure::Peak, CostFigure::Kept];

    /// True of times, which differ from machine to machine.
    pub fn is_time(self) -> bool {
        matches!(self, CostFigure::Wall | CostFigure::Cpu)
    }

    /// Amounts below this are alike: timer and allocator say no less.
    pub fn floor(self) -> f64 {
        if self.is_time() { 2e-5 } else { 16_384.0 }
    }

    /// The fact of a run, at least the floor.
    pub fn of(self, used: &Used) -> Option<f64> {
        let fact = match self {
            CostFigure::Wall => Some(used.wall_s),
            CostFigure::Cpu => used.cpu_s,
            CostFigure::Peak => used.peak_bytes.map(|b| b as f64),
            CostFigure::Kept => used.kept_bytes.map(|b| b as f64),
        };
        fact.filter(|f| f.is_finite()).map(|f| f.max(self.floor()))
    }

    /// Its place in a prediction.
    pub fn predicted(self, of: &Predicted) -> Option<toile_core::cost::Estimate> {
        match self {
            CostFigure::Wall => of.wall_s,
            CostFigure::Cpu => of.cpu_s,
            CostFigure::Peak => of.peak_bytes,
            CostFigure::Kept => of.kept_bytes,
        }
    }

    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            CostFigure::Wall => "wall time",
            CostFigure::Cpu => "processor time",
            CostFigure::Peak => "peak memory",
            CostFigure::Kept => "memory kept",
        }
    }
}

/// The machine that figures hold for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostMachine {
    /// The processor, as the system calls it.
    pub cpu: String,
    /// Cores that the system offers.
    pub cores: usize,
}

impl HostMachine {
    /// This one.
    pub fn here() -> Self {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = info.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": "));
        let cpu = model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned());
        HostMachine { cpu, cores: std::thread::available_parallelism().map_or(1, usize::from) }
    }
}

impl std::fmt::Display for HostMachine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {} cores", self.cpu, self.cores)
    }
}

/// What a stage took in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostRecord {
    /// The pipeline's name.
    pub pipeline: String,
    /// The kind of garment: the name of the pipeline's first style.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub style: String,
    /// The stage's name, with what makes it do other work than by default.
    pub stage: String,
    /// Its role.
    pub role: String,
    /// Digest of the stage, its parameters and what it was to be given: by it a later run knows
    /// what it will make.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub key: String,
    /// Threads that it could use.
    pub threads: usize,
    /// What it was given and what it made.
    pub size: Size,
    /// What it made.
    #[serde(default, skip_serializing_if = "Size::is_empty")]
    pub made: Size,
    /// What it was expected to be given and to make before anything was known.
    #[serde(default, skip_serializing_if = "Size::is_empty")]
    pub foreseen: Size,
    /// What it took.
    pub used: Used,
}

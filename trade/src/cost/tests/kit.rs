//! Made-up records of runs.

use crate::cost::*;
use toile_core::cost::{Estimate, Quantity, Size, Used};

/// Numbers that look random and are the same every time (Lehmer 1951), from 0 to 1.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }

    /// A factor around 1 whose logarithm has about this standard deviation.
    fn noise(&mut self, spread: f64) -> f64 {
        let sum: f64 = (0..12).map(|_| self.roll()).sum();
        (spread * (sum - 6.0)).exp()
    }
}

pub(super) fn pixels(n: f64) -> Size {
    Size::new().with(Quantity::Pixels, n)
}

pub(super) fn triangles(n: f64) -> Size {
    Size::new().with(Quantity::Triangles, n)
}

pub(super) fn record(pipeline: &str, stage: &str, role: &str, size: Size, wall_s: f64) -> CostRecord {
    CostRecord {
        pipeline: pipeline.into(),
        style: "Vest".into(),
        stage: stage.into(),
        role: role.into(),
        key: format!("{stage} {wall_s}"),
        threads: 2,
        made: size.clone(),
        foreseen: size.clone(),
        size,
        used: Used { wall_s, cpu_s: Some(wall_s * 2.0), peak_bytes: Some(5_000_000), kept_bytes: None },
    }
}

/// Some milliseconds, and 30 ns a pixel.
pub(super) fn otsu(pixels: f64) -> f64 {
    2e-3 + 30e-9 * pixels
}

/// Runs of Otsu by that law.
pub(super) fn runs(pipeline: &str, count: usize, spread: f64) -> Vec<CostRecord> {
    let mut dice = Dice(1 + pipeline.bytes().map(u64::from).sum::<u64>());
    let run = |_| {
        let n = (1e5 * 100_f64.powf(dice.roll())).round();
        let microseconds = (otsu(n) * dice.noise(spread) * 1e6).round();
        record(pipeline, "Otsu", "binariser", pixels(n), microseconds / 1e6)
    };
    (0..count).map(run).collect()
}

pub(super) fn place<'a>(pipeline: &'a str, stage: &'a str, role: &'a str) -> StagePlace<'a> {
    StagePlace { pipeline, stage, role, style: "Vest" }
}

pub(super) fn wall(costs: &Costs, pipeline: &str, size: &Size) -> Estimate {
    costs.estimate(&place(pipeline, "Otsu", "binariser"), size, CostFigure::Wall).unwrap()
}

//! The scoreboard as one call: every test, model, mesh and resolution asked for, with what is wrong
//! beside what it costs.
//!
//! A row is one run. A verdict is a row's error against the limit of its test, and only where the
//! limit binds: the default models on a mesh fit for garments, at the resolution the test binds
//! from. All other rows are there to be compared.

use std::fmt;
use std::ops::ControlFlow;

use serde::Serialize;

use super::score::{Score, Test, run};
use super::table::Table;
use super::{Layout, Progress};
use toile_cloth::energy::Models;

/// What to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Which tests.
    pub tests: Vec<Test>,
    /// On which meshes.
    pub layouts: Vec<Layout>,
    /// Triangles along the longest side, ascending; empty for each test's own three.
    pub resolutions: Vec<usize>,
    /// Which models.
    pub models: Vec<Models>,
}

impl Default for Options {
    /// The default models on all tests and meshes.
    fn default() -> Self {
        Self {
            tests: Test::ALL.to_vec(),
            layouts: Layout::ALL.to_vec(),
            resolutions: vec![],
            models: vec![Models::DEFAULT],
        }
    }
}

/// A part of an error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Part {
    /// What it measures.
    pub name: String,
    /// Signed, as the test's formula gives it.
    pub error: f64,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// E1 to E6 and a word.
    pub test: &'static str,
    /// Membrane and bending.
    pub models: String,
    /// The mesh, with its seed.
    pub layout: String,
    /// Triangles along the longest side.
    pub along: usize,
    /// The greatest part in size; none if the run was refused.
    pub error: Option<f64>,
    /// `-log10(error)`.
    pub digits: Option<f64>,
    /// Order of convergence from the next coarser row: `log(E_coarse / E) / log(n / n_coarse)`.
    pub order: Option<f64>,
    /// The test's limit.
    pub limit: f64,
    /// Within the limit; none where it does not bind.
    pub pass: Option<bool>,
    /// All parts.
    pub parts: Vec<Part>,
    /// Wall time, s.
    pub seconds: f64,
    /// Why there is no error.
    pub refused: Option<String>,
}

/// The binding rows of a test together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Which test.
    pub test: &'static str,
    /// From how many triangles along the longest side.
    pub along: usize,
    /// How many runs bind.
    pub runs: usize,
    /// The worst of them; infinite if one was refused.
    pub worst: f64,
    /// `(max - min) / mean` of the measured quantity over the meshes of the finest binding
    /// resolution: E3 only.
    pub spread: Option<f64>,
    /// For error and spread.
    pub limit: f64,
    /// Whether both are within the limit.
    pub pass: bool,
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// In the order they were run.
    pub rows: Vec<Row>,
    /// A line for each test with binding rows.
    pub verdicts: Vec<Verdict>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

/// Runs what `options` ask for; `progress` hears of each run before it begins and may stop there.
#[must_use]
pub fn accuracy(options: &Options, progress: &mut Progress<'_>) -> Report {
    let runs = options.runs();
    let mut report = Report { rows: Vec::with_capacity(runs.len()), verdicts: vec![], stopped: false };
    for (k, &(test, models, layout, along)) in runs.iter().enumerate() {
        let name = format!("{}, {}, {}, {along} along", test.label(), models.name(), layout.label());
        if progress(k as f64 / runs.len() as f64, &name) == ControlFlow::Break(()) {
            report.stopped = true;
            break;
        }
        let row = Row::of(test, models, layout, along, report.rows.last());
        report.rows.push(row);
    }
    report.verdicts = options.tests.iter().filter_map(|&t| Verdict::of(t, &report.rows[..], &runs)).collect();
    report
}

type Run = (Test, Models, Layout, usize);

impl Options {
    fn runs(&self) -> Vec<Run> {
        let mut runs = Vec::new();
        for &test in &self.tests {
            let own = test.resolutions();
            let resolutions = if self.resolutions.is_empty() { &own[..] } else { &self.resolutions[..] };
            for &models in &self.models {
                for &layout in &self.layouts {
                    runs.extend(resolutions.iter().map(|&n| (test, models, layout, n)));
                }
            }
        }
        runs
    }
}

fn binds((test, models, layout, along): Run) -> bool {
    models == Models::DEFAULT && layout.is_for_garments() && along >= test.binding_resolution()
}

impl Row {
    fn of(test: Test, models: Models, layout: Layout, along: usize, coarser: Option<&Self>) -> Self {
        let mut row = Self {
            test: test.label(),
            models: models.name(),
            layout: layout.label(),
            along,
            error: None,
            digits: None,
            order: None,
            limit: test.limit(),
            pass: None,
            parts: vec![],
            seconds: 0.0,
            refused: None,
        };
        match run(test, models, layout, along) {
            Ok(score) => row.fill(&score, coarser),
            Err(e) => row.refused = Some(e.to_string()),
        }
        row.pass = binds((test, models, layout, along)).then(|| row.error.is_some_and(|e| e <= row.limit));
        row
    }

    fn fill(&mut self, score: &Score, coarser: Option<&Self>) {
        let error = score.error();
        self.seconds = score.seconds;
        self.parts =
            score.parts.iter().map(|(name, error)| Part { name: name.clone(), error: *error }).collect();
        (self.error, self.digits) = (Some(error), Some(-error.log10()));
        let same = |r: &&Self| {
            (r.test, &r.models, &r.layout) == (self.test, &self.models, &self.layout) && r.along < self.along
        };
        self.order = coarser.filter(same).and_then(|r| {
            let finer = (self.along as f64 / r.along as f64).ln();
            r.error.map(|e| (e / error).ln() / finer)
        });
    }

    fn worst_part(&self) -> Option<&Part> {
        self.parts.iter().max_by(|a, b| a.error.abs().total_cmp(&b.error.abs()))
    }
}

impl Verdict {
    fn of(test: Test, rows: &[Row], runs: &[Run]) -> Option<Self> {
        let binding: Vec<&Row> =
            rows.iter().zip(runs).filter(|(_, r)| r.0 == test && binds(**r)).map(|(row, _)| row).collect();
        let along = binding.iter().map(|r| r.along).min()?;
        let worst = binding.iter().map(|r| r.error.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
        let spread = (test == Test::Plate).then(|| spread(&binding));
        let pass = worst <= test.limit() && spread.is_none_or(|s| s <= test.limit());
        Some(Self {
            test: test.label(),
            along,
            runs: binding.len(),
            worst,
            spread,
            limit: test.limit(),
            pass,
        })
    }
}

/// Greatest spread of a part over the meshes, worst over the resolutions; 0 for one mesh.
fn spread(rows: &[&Row]) -> f64 {
    let mut resolutions: Vec<usize> = rows.iter().map(|r| r.along).collect();
    resolutions.sort_unstable();
    resolutions.dedup();
    let of = |along: usize, part: usize| {
        let values: Vec<f64> = rows
            .iter()
            .filter(|r| r.along == along)
            .filter_map(|r| r.parts.get(part))
            .map(|p| 1.0 + p.error)
            .collect();
        let (low, high) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        if values.is_empty() { 0.0 } else { (high - low) / mean }
    };
    let parts = rows.iter().map(|r| r.parts.len()).max().unwrap_or(0);
    resolutions
        .into_iter()
        .flat_map(|n| (0..parts).map(move |p| (n, p)))
        .map(|(n, p)| of(n, p))
        .fold(0.0, f64::max)
}

impl Report {
    /// Whether every limit that binds is kept.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.verdicts.iter().all(|v| v.pass)
    }

    /// As JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rows = Table::new(&[
            "test",
            "models",
            "mesh",
            "along",
            "error",
            "limit",
            "",
            "digits",
            "order",
            "s",
            "worst part",
        ]);
        for r in &self.rows {
            let part = r.worst_part().map(|p| format!("{} {:+.1e}", p.name, p.error));
            rows.row([
                r.test.into(),
                r.models.clone(),
                r.layout.clone(),
                r.along.to_string(),
                r.error.map_or("-".into(), |e| format!("{e:.5}")),
                r.limit.to_string(),
                r.pass.map_or("", mark).into(),
                r.digits.map_or(String::new(), |d| format!("{d:.1}")),
                r.order.map_or(String::new(), |p| format!("{p:.1}")),
                format!("{:.2}", r.seconds),
                r.refused.clone().or(part).unwrap_or_default(),
            ]);
        }
        let mut verdicts = Table::new(&["test", "from along", "runs", "worst", "spread", "limit", ""]);
        for v in &self.verdicts {
            verdicts.row([
                v.test.into(),
                v.along.to_string(),
                v.runs.to_string(),
                format!("{:.5}", v.worst),
                v.spread.map_or(String::new(), |s| format!("{s:.4}")),
                v.limit.to_string(),
                mark(v.pass).into(),
            ]);
        }
        write!(f, "{rows}\n{verdicts}")
    }
}

pub(super) fn mark(pass: bool) -> &'static str {
    if pass { "pass" } else { "FAIL" }
}

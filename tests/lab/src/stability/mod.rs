//! The extremes as one call: each value of each axis alone, and all pairs of ends if asked, against
//! the outcome that is required.
//!
//! A check either meets its criterion, or is refused by the typed error that its axis names, or
//! fails. Nothing else is allowed: no NaN, no hang, no silent wrong answer.

mod case;
mod garment;
mod model;
mod precision;
mod strip;
mod world;

use std::fmt;
use std::ops::ControlFlow;
use std::time::Instant;

use serde::Serialize;

pub use case::{AXES, Axis, Case, Outcome};

use super::Progress;
use super::accuracy::mark;
use super::table::Table;

/// What to run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Options {
    /// Names of axes; empty for all.
    pub axes: Vec<String>,
    /// All pairs of ends of the numeric axes as well, on 20 x 20 cells: minutes.
    pub pairs: bool,
    /// Also the sizes that take minutes and gigabytes: a million vertices, fifty layers.
    pub large: bool,
}

/// What an axis requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Must {
    /// To meet a criterion; where the criterion names an error, that error.
    Converge,
    /// To be refused by name.
    Refuse,
}

/// How a check ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "outcome", content = "detail")]
pub enum Verdict {
    /// The criterion is met, with the figures.
    Converged(String),
    /// Refused by the right error, with its text.
    Refused(String),
    /// Anything else.
    Failed(String),
}

/// One value of one axis.
pub(super) struct Check {
    axis: &'static str,
    value: String,
    must: Must,
    run: Box<dyn Fn() -> Verdict>,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// As in the list of extremes.
    pub axis: &'static str,
    /// The value, or two of them.
    pub value: String,
    /// What is required.
    pub must: Must,
    /// What happened.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// Whether that is what is required.
    pub pass: bool,
    /// Wall time, s.
    pub seconds: f64,
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// In the order they were run.
    pub rows: Vec<Row>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

/// The names of all axes.
#[must_use]
pub fn axes() -> Vec<&'static str> {
    let mut names: Vec<&'static str> = checks(true).iter().map(|c| c.axis).collect();
    names.dedup();
    names
}

/// Runs what `options` ask for; `progress` hears of each check before it begins and may stop there.
#[must_use]
pub fn stability(options: &Options, progress: &mut Progress<'_>) -> Report {
    let mut checks = checks(options.large);
    if options.pairs {
        checks.extend(case::pairs(20));
    }
    checks.retain(|c| options.axes.is_empty() || options.axes.iter().any(|a| a == c.axis));
    let mut report = Report { rows: Vec::with_capacity(checks.len()), stopped: false };
    for (k, check) in checks.iter().enumerate() {
        if progress(k as f64 / checks.len() as f64, &format!("{} {}", check.axis, check.value))
            == ControlFlow::Break(())
        {
            report.stopped = true;
            break;
        }
        report.rows.push(check.row());
    }
    report
}

fn checks(large: bool) -> Vec<Check> {
    let mut checks = case::singles(20);
    checks.extend(strip::checks());
    checks.extend(model::checks());
    checks.extend(world::checks(large));
    checks.extend(precision::checks());
    checks.extend(garment::checks(large));
    // One axis after the other, in the order of their first checks.
    let mut order: Vec<&str> = Vec::new();
    checks.iter().for_each(|c| {
        if !order.contains(&c.axis) {
            order.push(c.axis);
        }
    });
    checks.sort_by_key(|c| order.iter().position(|a| *a == c.axis));
    checks
}

impl Check {
    fn new(
        axis: &'static str,
        value: impl ToString,
        must: Must,
        run: impl Fn() -> Verdict + 'static,
    ) -> Self {
        Self { axis, value: value.to_string(), must, run: Box::new(run) }
    }

    fn row(&self) -> Row {
        let start = Instant::now();
        let verdict = (self.run)();
        let pass = match self.must {
            Must::Converge => !matches!(verdict, Verdict::Failed(_)),
            Must::Refuse => matches!(verdict, Verdict::Refused(_)),
        };
        let seconds = start.elapsed().as_secs_f64();
        Row { axis: self.axis, value: self.value.clone(), must: self.must, verdict, pass, seconds }
    }
}

impl Report {
    /// Whether every check ended as required.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.rows.iter().all(|r| r.pass)
    }

    /// As JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = Table::new(&["axis", "value", "", "outcome", "s", "detail"]);
        for r in &self.rows {
            let (outcome, detail) = match &r.verdict {
                Verdict::Converged(d) => ("converged", d),
                Verdict::Refused(d) => ("refused", d),
                Verdict::Failed(d) => ("failed", d),
            };
            let seconds = format!("{:.2}", r.seconds);
            table.row([
                r.axis.into(),
                r.value.clone(),
                mark(r.pass).into(),
                outcome.into(),
                seconds,
                detail.clone(),
            ]);
        }
        write!(f, "{table}")
    }
}

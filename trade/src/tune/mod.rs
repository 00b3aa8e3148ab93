//! Picks a setting from a measured front and proves it by fresh runs.
//!
//! For an error: the quickest setting of the front that keeps it, for a time: the most accurate that keeps that. The choice
//! is run afresh, and again from moved starts, each held against the reference; where a run misses what was asked, the
//! next setting of the front is tried. Ten of ten starts within the error mean, with 95 % confidence, that fewer than 26 % of
//! all such starts miss it (1 - 0.05^(1/10)); three of three would mean 63 %.

use crate::errors::{Millimetres, compare};
use crate::ladder::{moved_start, setting_words};
use crate::measure::{Bench, Missed, Ran};
use crate::record::{Clock, Measured, Point, Trade};
use crate::slot::Source;
use crate::store::digest;
use crate::study::measured;
use std::path::Path;
use std::sync::Arc;
use toile_core::cache::Cache;
use toile_core::pipeline::{Override, Pipeline, without_qualities};
use toile_core::{ErrorCode, Length, StageError};

/// Begins each line that tuning puts on top of a pipeline file.
pub const MARK: &str = "// toile tune:";

/// What is asked of a setting.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Wish {
    /// 95 % of the surface this near to the reference, mm.
    pub max_error_mm: Option<f64>,
    /// A run no longer than this, seconds by the record's clock.
    pub max_time_s: Option<f64>,
}

impl Wish {
    /// Whether figures keep it.
    pub fn is_kept(&self, error_mm: f64, seconds: f64) -> bool {
        self.max_error_mm.is_none_or(|e| error_mm <= e) && self.max_time_s.is_none_or(|t| seconds <= t)
    }

    /// In words: `an error of at most 2 mm and a time of at most 1 s`.
    pub fn words(&self) -> String {
        let error = self.max_error_mm.map(|e| format!("an error of at most {e} mm"));
        let time = self.max_time_s.map(|t| format!("a time of at most {t} s"));
        error.into_iter().chain(time).collect::<Vec<_>>().join(" and ")
    }
}

/// A setting that was proved.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// The index of its point.
    pub point: usize,
    /// The fresh run.
    pub fresh: Measured,
    /// Distances of the moved starts.
    pub starts: Vec<Millimetres>,
    /// Moved starts that failed.
    pub failed: Vec<String>,
}

impl Proof {
    /// Moved starts that keep an error.
    pub fn kept(&self, max_error_mm: f64) -> usize {
        self.starts.iter().filter(|m| m.p95 <= max_error_mm).count()
    }

    /// The worst of the fresh run and of the moved starts: 95 % of the surface, mm.
    pub fn worst_mm(&self) -> f64 {
        self.starts.iter().map(|m| m.p95).fold(self.fresh.errors.distance_mm.p95, f64::max)
    }

    fn is_good(&self, wish: &Wish, clock: Clock) -> bool {
        let starts =
            wish.max_error_mm.is_none_or(|e| self.failed.is_empty() && self.kept(e) == self.starts.len());
        wish.is_kept(self.fresh.errors.distance_mm.p95, self.fresh.time(clock)) && self.fresh.sound && starts
    }

    /// How the moved starts ended, where an error was asked for: `10 of 10 moved starts within 2 mm, the worst 1.31 mm`.
    pub fn starts_in_words(&self, wish: &Wish) -> Option<String> {
        let e = wish.max_error_mm.filter(|_| !self.starts.is_empty())?;
        let worst = self.starts.iter().map(|m| m.p95).fold(0.0, f64::max);
        let (kept, all) = (self.kept(e), self.starts.len() + self.failed.len());
        Some(format!("{kept} of {all} moved starts within {e} mm, the worst {worst:.2} mm"))
    }

    fn words(&self, wish: &Wish, clock: Clock) -> String {
        let mut text = format!(
            "a fresh run takes {:.2} s ({}), 95 % within {:.2} mm",
            self.fresh.time(clock),
            clock.as_str(),
            self.fresh.errors.distance_mm.p95
        );
        if let Some(e) = wish.max_error_mm.filter(|_| !self.starts.is_empty() || !self.failed.is_empty()) {
            let (kept, all) = (self.kept(e), self.starts.len() + self.failed.len());
            text += &format!(", {kept} of {all} moved starts within {e} mm");
        }
        text
    }
}

/// Points of the front that keep a wish, the best first: the quickest where an error is asked, else the most accurate.
pub fn picks(trade: &Trade, wish: &Wish) -> Vec<usize> {
    let keeps = |i: &usize| {
        trade.points[*i]
            .measured()
            .is_some_and(|m| wish.is_kept(m.errors.distance_mm.p95, m.time(trade.clock)))
    };
    let picks = trade.front.iter().copied().filter(|i| *i < trade.points.len()).filter(keeps);
    if wish.max_error_mm.is_some() { picks.collect() } else { picks.rev().collect() }
}

/// Why no setting is good enough, with the nearest.
pub fn refusal(trade: &Trade, wish: &Wish) -> StageError {
    let costs: Vec<_> = trade
        .front
        .iter()
        .filter_map(|&i| Some(trade.points.get(i)?.measured()?.cost(trade.clock)))
        .collect();
    let e = StageError::new(
        ErrorCode::StaticEquilibrium,
        format!("no setting of the measured front keeps {}", wish.words()),
    );
    let floor = trade.reference.floor_mm().filter(|f| wish.max_error_mm.is_some_and(|e| e < *f));
    if let Some(floor) = floor {
        return e.hint(format!("the reference itself is only known to {floor:.2} mm (what it lacks, or its spread over moved starts)"));
    }
    match (costs.last(), costs.first()) {
        (Some(best), Some(quickest)) => e.hint(format!(
            "the most accurate keeps {:.2} mm in {:.2} s, the quickest takes {:.2} s at {:.2} mm",
            best.error, best.time, quickest.time, quickest.error
        )),
        _ => e.hint("nothing was measured; give `toile trade` more time"),
    }
}

/// Everything that a proof needs.
pub struct Prover<'a> {
    /// The pipeline's file.
    pub source: &'a Source<'a>,
    /// What was measured.
    pub trade: &'a Trade,
    /// How runs are made.
    pub bench: &'a Bench,
    /// The folder of the measurement, which keeps the reference.
    pub folder: &'a Path,
    /// Moved starts for each proof.
    pub starts: usize,
    /// Root mean square move of a start.
    pub jitter: Length,
}

impl Prover<'_> {
    /// Tries the picks of a wish, the best first, until one is proved.
    ///
    /// Errors: none is, or the reference does not run.
    pub fn prove(&self, wish: &Wish, tell: &mut dyn FnMut(String)) -> Result<Proof, StageError> {
        match picks(self.trade, wish).is_empty() {
            true => Err(refusal(self.trade, wish)),
            false => self.prove_against(wish, &self.reference()?, &mut Vec::new(), tell),
        }
    }

    /// As [`Prover::prove`], against a reference that was run already; settings in `known`, proved before from every start,
    /// are not run again, and those that are proved now are added.
    ///
    /// Errors: no setting is proved.
    pub fn prove_against(
        &self,
        wish: &Wish,
        reference: &Ran,
        known: &mut Vec<Proof>,
        tell: &mut dyn FnMut(String),
    ) -> Result<Proof, StageError> {
        for point in picks(self.trade, wish) {
            let setting = setting_words(&self.trade.points[point].setting);
            let before = known.iter().find(|p| p.point == point).cloned();
            let proof = match before.map_or_else(|| self.one(point, wish, reference), Ok) {
                Ok(proof) => proof,
                Err(Missed::Failed(e)) => {
                    tell(format!("{setting}: {}", e.message));
                    continue;
                }
                Err(missed) => return Err(crate::ladder::error(missed)),
            };
            tell(format!("{setting}: {}", proof.words(wish, self.trade.clock)));
            let is_whole = proof.starts.len() + proof.failed.len() == self.starts;
            if is_whole && known.iter().all(|p| p.point != point) {
                known.push(proof.clone());
            }
            if proof.is_good(wish, self.trade.clock) {
                return Ok(proof);
            }
        }
        Err(self.unproved(wish))
    }

    fn unproved(&self, wish: &Wish) -> StageError {
        let message = format!("no setting that kept {} when it was measured keeps it again", wish.words());
        let spread = self.trade.reference.spread.as_ref().and_then(|s| s.p95());
        let rest = spread.map_or_else(String::new, |p| {
            format!("; the garment has several states of rest, and moved starts of the reference differ by up to {p:.2} mm")
        });
        StageError::new(ErrorCode::StaticEquilibrium, message)
            .hint(format!("ask for a little more than is needed, or give `toile trade` more time{rest}"))
    }

    /// The garment of the reference, from the cache of the measurement where it is still there.
    ///
    /// Errors: the record holds none, or it does not run any more.
    pub fn reference(&self) -> Result<Ran, StageError> {
        let none =
            || StageError::invalid("the record holds no reference").hint("measure again with `toile trade`");
        let finest = self.trade.reference.levels.last().ok_or_else(none)?;
        let cache = Arc::new(Cache::new(&self.folder.join("reference")));
        let pipeline = self.load(&overrides(&finest.overrides))?;
        self.bench.run(&pipeline, None, Some(cache)).map_err(crate::ladder::error)
    }

    fn load(&self, overrides: &[Override]) -> Result<Pipeline, StageError> {
        self.source.load(overrides).map_err(|f| StageError::invalid(f.to_string()))
    }

    fn one(&self, point: usize, wish: &Wish, reference: &Ran) -> Result<Proof, Missed> {
        let set = overrides(&self.trade.points[point].overrides);
        let pipeline = self.load(&set).map_err(Missed::Failed)?;
        let fresh = self.bench.run(&pipeline, None, None)?;
        let fresh = measured(&fresh, reference).map_err(Missed::Failed)?;
        let mut proof = Proof { point, fresh, starts: Vec::new(), failed: Vec::new() };
        let is_worth = proof.is_good(wish, self.trade.clock) && wish.max_error_mm.is_some();
        for seed in 1..=if is_worth { self.starts as u64 } else { 0 } {
            match moved_start(self.source, &set, self.bench, (self.jitter, seed), None, None) {
                Ok(ran) => proof.starts.push(compare(&ran, reference).map_err(Missed::Failed)?.distance_mm),
                Err(Missed::Failed(e)) => proof.failed.push(e.message),
                Err(missed) => return Err(missed),
            }
            // One that misses is enough to look further.
            if !proof.is_good(wish, self.trade.clock) {
                break;
            }
        }
        Ok(proof)
    }

    /// The pipeline file with the proved setting in its place, comments and order kept, and the figures on top. Its named
    /// qualities are left out: they were measured on the file as it was.
    ///
    /// Errors: the setting does not fit the file any more.
    pub fn tuned(&self, wish: &Wish, proof: &Proof, date: &str) -> Result<String, StageError> {
        let point = &self.trade.points[proof.point];
        let pipeline = self.load(&overrides(&point.overrides))?;
        let text = without_qualities(&pipeline.text).map_err(|f| StageError::invalid(f.message))?;
        Ok(commented(&text, &self.comments(wish, proof, point, date)))
    }

    fn comments(&self, wish: &Wish, proof: &Proof, point: &Point, date: &str) -> Vec<String> {
        let (m, d, machine) = (&proof.fresh, &proof.fresh.errors.distance_mm, &self.trade.machine);
        let mut lines = vec![
            format!(
                "{date}, toile {}, {}, {} cores: {}.",
                self.trade.toile,
                machine.system,
                machine.cores,
                wish.words()
            ),
            format!("set {}.", setting_words(&point.setting)),
            format!(
                "a fresh run took {:.2} s ({:.2} s of processor time); 95 % of its surface within {:.2} mm of the reference, mean {:.2} mm, worst {:.2} mm.",
                m.time(Clock::Wall),
                m.time(Clock::Cpu),
                d.p95,
                d.mean,
                d.max
            ),
        ];
        lines.extend(proof.starts_in_words(wish).map(|words| format!("{words}.")));
        if let Some(finest) = self.trade.reference.levels.last() {
            let floor = self
                .trade
                .reference
                .floor_mm()
                .map_or_else(String::new, |f| format!(", itself known to {f:.2} mm"));
            lines.push(format!("the reference: {} triangles{floor}.", finest.triangles));
        }
        lines
    }
}

/// Holds a record against the pipeline that it is to be used for.
///
/// Errors: it was measured on another pipeline, or before a stage or parameter changed.
pub fn check(trade: &Trade, pipeline: &Pipeline) -> Result<(), StageError> {
    let own = digest(pipeline, &[]);
    match trade.points.first().is_some_and(|p| p.key == own) {
        true => Ok(()),
        false => {
            Err(StageError::invalid(format!("the measurement is of another state of \"{}\"", trade.file))
                .hint("run `toile trade` again: the pipeline, a stage's version or a `--set` has changed"))
        }
    }
}

pub(crate) fn overrides(pairs: &[(String, String)]) -> Vec<Override> {
    pairs.iter().map(|(path, value)| Override { path: path.clone(), value: value.clone() }).collect()
}

/// A pipeline's text with lines of comment on top, in the place of those of an earlier tuning.
fn commented(text: &str, lines: &[String]) -> String {
    let (mark, rest) = match text.strip_prefix('\u{feff}') {
        Some(rest) => ("\u{feff}", rest),
        None => ("", text),
    };
    let own: String = rest.split_inclusive('\n').filter(|l| !l.starts_with(MARK)).collect();
    let lines: String = lines.iter().map(|l| format!("{MARK} {l}\n")).collect();
    format!("{mark}{lines}{own}")
}

#[cfg(test)]
#[path = "tune_tests.rs"]
mod tests;

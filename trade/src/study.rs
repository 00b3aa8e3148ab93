//! The whole measurement: reference, settings, what is kept on disk; bounded by a budget, gone on with by the next session.
//!
//! Half of the budget is the reference's. Then the pipeline's own setting, a space-filling start, and the gaps of the
//! front. A setting that takes longer than the limit is stopped, which is a result as well. A choice of stage whose first
//! two settings gave nothing is not tried further, nor is a setting whose nearest neighbour took longer than what is left.

use crate::errors::{compare, ease};
use crate::front::Cost;
use crate::knob::KnobSpec;
use crate::ladder::{FINER, Found, RATIO, Search, error, setting_words};
use crate::measure::{Bench, Missed, Ran};
use crate::page::pictures;
use crate::record::*;
use crate::sample::{candidates, halton};
use crate::slot::{Board, ReferenceValue, Setting, Source};
use crate::store::{Store, digest, garment_digest};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use toile_core::artifact::Digester;
use toile_core::cache::Cache;
use toile_core::pipeline::Pipeline;
use toile_core::{Length, StageError, write_files};

/// The reference's share of the budget, and that of its moved starts.
const REFERENCE_SHARE: [f64; 2] = [0.35, 0.15];
/// Space-filling settings a knob, before the front is refined.
const START: usize = 4;
/// Every so many-th setting after the start is space-filling again, so that nothing is left out for good.
const LOOK_AROUND: usize = 5;
/// A setting may take this share of the budget where no limit is given.
const LIMIT_SHARE: f64 = 0.1;
/// Settings without result after which a choice of stage is given up.
const HOPELESS: usize = 2;
/// Settings nearer than this to a measured one with the same choices, as a share of the knobs' ranges, tell nothing new.
const LEAST_STEP: f64 = 0.03;
/// Proposals that are looked at before there is said to be nothing new.
const PROPOSALS: usize = 4000;

/// What is asked.
#[derive(Clone)]
pub struct Options {
    /// Folder for all results.
    pub out: PathBuf,
    /// Time for everything.
    pub budget: Duration,
    /// Longest run of a setting.
    pub limit: Option<Duration>,
    /// Most settings.
    pub points: Option<usize>,
    /// Runs of each setting.
    pub repeats: usize,
    /// Moved starts of the reference.
    pub starts: usize,
    /// Root mean square move of a start.
    pub jitter: Length,
    /// Values of knobs that the reference has in place of the pipeline's own.
    pub reference: Vec<ReferenceValue>,
    /// Which clock the front is drawn by.
    pub clock: Clock,
    /// How runs are made.
    pub bench: Bench,
}

/// A study that has its reference.
pub struct Study<'a> {
    source: &'a Source<'a>,
    options: &'a Options,
    board: Board,
    found: Found,
    store: Store,
    started: Instant,
}

/// Measures, or goes on with what was measured.
///
/// Errors: a knob that does not fit, the pipeline's own setting fails, the folder cannot be written, stopped by the user
/// (what was measured is kept).
pub fn study(
    source: &Source<'_>,
    pipeline: &Pipeline,
    knobs: &[KnobSpec],
    options: &Options,
    tell: &mut dyn FnMut(String),
) -> Result<Trade, StageError> {
    let mut study = Study::begin(source, pipeline, knobs, options, tell)?;
    let ended = study.settings(tell);
    let trade = study.trade(pipeline);
    ended.map(|()| trade)
}

impl<'a> Study<'a> {
    /// Binds the knobs and finds the reference, or takes over that of an earlier session.
    ///
    /// Errors: as [`study`].
    pub fn begin(
        source: &'a Source<'a>,
        pipeline: &Pipeline,
        knobs: &[KnobSpec],
        options: &'a Options,
        tell: &mut dyn FnMut(String),
    ) -> Result<Study<'a>, StageError> {
        let started = Instant::now();
        let board = Board::new(source, pipeline, knobs)?;
        let board = board.with_reference(&options.reference)?;
        if options.bench.apart.is_none() {
            tell(
                "runs share this process: memory is the process's own, and a run that breaks off ends all"
                    .into(),
            );
        }
        // Knobs that are not refined may change from session to session.
        let own = board.own();
        let finer =
            board.refined(RATIO).into_iter().filter(|(key, value)| own.get(key) != Some(value)).collect();
        let finer = setting_words(&finer);
        let base = digest(pipeline, &[&finer, options.bench.until.as_deref().unwrap_or("")]);
        let share = |s: f64| options.budget.mul_f64(s);
        let search = Search {
            source,
            board: &board,
            bench: &options.bench,
            cache: Arc::new(Cache::new(&options.out.join("reference"))),
            budget: share(REFERENCE_SHARE[0]),
            starts_budget: share(REFERENCE_SHARE[1]),
            starts: options.starts,
            jitter: options.jitter,
        };
        let earlier = Store::open(&options.out, &base).unwrap_or_else(|why| {
            tell(format!("what is in {} is put aside: {why}", options.out.display()));
            Store::put_aside(&options.out);
            None
        });
        let (found, store) = match earlier {
            Some(store) => {
                tell(format!("goes on from {} settings in {}", store.points.len(), options.out.display()));
                (search.again(store.head.reference.clone())?, store)
            }
            None => {
                let found = search.run(tell)?;
                let store = Store::new(&options.out, base, found.ran.reads.clone(), found.reference.clone());
                store.write()?;
                (found, store)
            }
        };
        Ok(Study { source, options, board, found, store, started })
    }

    /// The reference.
    pub fn reference(&self) -> &Found {
        &self.found
    }

    fn left(&self) -> Duration {
        self.options.budget.saturating_sub(self.started.elapsed())
    }

    /// Measures settings until the budget or the number of settings is used up, or nothing new is left.
    fn settings(&mut self, tell: &mut dyn FnMut(String)) -> Result<(), StageError> {
        let most = self.options.points.unwrap_or(usize::MAX);
        while self.store.points.len() < most && !self.left().is_zero() {
            let Some(setting) = self.next() else { break };
            let Some(point) = self.measure(setting)? else { continue };
            tell(self.words(&point));
            self.store.add(point)?;
        }
        Ok(())
    }

    /// The next setting to measure; none where nothing new is left that fits into the budget.
    fn next(&self) -> Option<Setting> {
        let n = self.store.points.len();
        if n == 0 {
            return Some(self.board.own());
        }
        let dimensions = self.board.knobs.len();
        let around = n <= START * dimensions || n.is_multiple_of(LOOK_AROUND);
        let spread = (0..PROPOSALS).map(|i| halton(i, dimensions));
        let near = candidates(&self.front_places(), &self.discrete()).into_iter();
        let proposals: Box<dyn Iterator<Item = Vec<f64>>> =
            if around { Box::new(spread.chain(near)) } else { Box::new(near.chain(spread)) };
        proposals.map(|place| self.board.setting(&place)).find(|s| self.is_worth(s))
    }

    fn front_places(&self) -> Vec<(Vec<f64>, Cost)> {
        let clock = self.options.clock;
        let place = |i: usize| {
            let point = &self.store.points[i];
            Some((self.board.place(&point.setting), point.measured()?.cost(clock)))
        };
        front_of(&self.store.points, clock).into_iter().filter_map(place).collect()
    }

    fn discrete(&self) -> Vec<bool> {
        self.board.knobs.iter().map(|k| k.dial.is_discrete()).collect()
    }

    /// New, coarser than the reference, not of a hopeless choice, and likely to be done in time.
    fn is_worth(&self, setting: &Setting) -> bool {
        let is_known =
            self.store.points.iter().any(|p| p.setting == *setting || self.is_beside(setting, &p.setting));
        let finest = self.found.reference.levels.last().map(|l| &l.setting);
        let too_fine = finest.is_some_and(|f| self.board.is_too_fine(setting, f, FINER));
        !is_known
            && !too_fine
            && !self.is_hopeless(setting)
            && self.expected(setting) <= self.left().as_secs_f64()
    }

    /// True where two settings differ in no choice and hardly in numbers.
    fn is_beside(&self, a: &Setting, b: &Setting) -> bool {
        let (p, q) = (self.board.place(a), self.board.place(b));
        let same_knobs = a.keys().eq(b.keys());
        same_knobs && p.iter().zip(&q).all(|(x, y)| (x - y).abs() < LEAST_STEP)
    }

    fn is_hopeless(&self, setting: &Setting) -> bool {
        let choices = self.board.knobs.iter().filter(|k| k.param.is_none());
        choices.filter_map(|k| Some((&k.key, setting.get(&k.key)?))).any(|(key, stage)| {
            let mut tried = self.store.points.iter().filter(|p| p.setting.get(key) == Some(stage)).peekable();
            let count = tried.clone().count();
            tried.peek().is_some() && count >= HOPELESS && tried.all(|p| p.measured().is_none())
        })
    }

    /// Seconds that all runs of a setting may take, by its nearest neighbour with the same choices.
    fn expected(&self, setting: &Setting) -> f64 {
        let (at, discrete) = (self.board.place(setting), self.discrete());
        let near = self.store.points.iter().filter_map(|p| {
            let there = self.board.place(&p.setting);
            let far = (0..at.len()).map(|k| (at[k] - there[k]).abs() * if discrete[k] { 100.0 } else { 1.0 });
            let seconds = match &p.outcome {
                Outcome::Measured(m) => m.time(Clock::Wall) * self.options.repeats as f64,
                Outcome::OverLimit { seconds } => *seconds,
                Outcome::Failed { .. } => return None,
            };
            Some((far.sum::<f64>(), seconds))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, seconds)| seconds)
    }

    /// Measures a setting; none where it makes a pipeline that was measured already, which is then noted as known.
    fn measure(&mut self, setting: Setting) -> Result<Option<Point>, StageError> {
        let overrides = self.board.overrides(&setting);
        let record = |key: String, outcome: Outcome| Point {
            key,
            setting: setting.clone(),
            overrides: overrides.iter().map(|o| (o.path.clone(), o.value.clone())).collect(),
            outcome,
        };
        let pipeline = match self.source.load(&overrides) {
            Ok(pipeline) => pipeline,
            Err(faults) => {
                let key = Digester::new().text(&setting_words(&setting)).finish().short();
                return Ok(Some(record(
                    key,
                    Outcome::Failed { code: "invalid_pipeline".into(), message: faults.to_string() },
                )));
            }
        };
        let key = digest(&pipeline, &[]);
        if let Some(known) = self.store.points.iter().find(|p| p.key == key) {
            let same = record(key, known.outcome.clone());
            self.store.add(same)?;
            return Ok(None);
        }
        let outcome = match self.runs(&pipeline) {
            Ok((ran, measured)) => {
                write_files(&self.options.out, &pictures(&key, &ran))?;
                Outcome::Measured(Box::new(measured))
            }
            Err(Missed::Cancelled) => return Err(error(Missed::Cancelled)),
            Err(Missed::Failed(e)) => Outcome::Failed { code: e.code.to_string(), message: e.message },
            // The end of the budget says nothing of the setting.
            Err(Missed::OverLimit(_)) if self.left().is_zero() => return Ok(None),
            Err(Missed::OverLimit(seconds)) => Outcome::OverLimit { seconds },
        };
        Ok(Some(record(key, outcome)))
    }

    /// Runs a setting as often as asked, fewer times where the budget ends.
    fn runs(&self, pipeline: &Pipeline) -> Result<(Ran, Measured), Missed> {
        let limit = self.options.limit.unwrap_or_else(|| self.options.budget.mul_f64(LIMIT_SHARE));
        let first = self.options.bench.run(pipeline, Some(limit.min(self.left())), None)?;
        let mut measured = measured(&first, &self.found.ran).map_err(Missed::Failed)?;
        let digest = garment_digest(&first.garment);
        for _ in 1..self.options.repeats {
            if self.left().as_secs_f64() < first.wall_s {
                break;
            }
            let again = self.options.bench.run(pipeline, None, None)?;
            measured.wall_s.push(again.wall_s);
            measured.cpu_s.push(again.cpu_s);
            measured.repeatable &= garment_digest(&again.garment) == digest;
        }
        Ok((first, measured))
    }

    fn words(&self, point: &Point) -> String {
        let what = if point.setting.is_empty() { "as it is".into() } else { setting_words(&point.setting) };
        let clock = self.options.clock;
        let came = match &point.outcome {
            Outcome::Measured(m) => format!(
                "{:.2} s {}, 95 % within {:.2} mm{}",
                m.time(clock),
                clock.as_str(),
                m.errors.distance_mm.p95,
                if m.sound { "" } else { ", misses a quality limit" }
            ),
            Outcome::Failed { message, .. } => format!("fails: {message}"),
            Outcome::OverLimit { seconds } => format!("stopped after {seconds:.0} s"),
        };
        format!("setting {} ({what}): {came}", self.store.points.len() + 1)
    }

    /// The record of all.
    pub fn trade(&self, pipeline: &Pipeline) -> Trade {
        let knob = |k: &crate::slot::Knob| KnobRecord { key: k.key.clone(), values: k.dial.words() };
        let mut points: Vec<Point> = Vec::new();
        for p in &self.store.points {
            if points.iter().all(|q| q.key != p.key) {
                points.push(p.clone());
            }
        }
        Trade {
            scheme: SCHEME,
            toile: env!("CARGO_PKG_VERSION").to_owned(),
            pipeline: pipeline.name.clone(),
            file: pipeline.file.clone(),
            date: today(),
            machine: Machine::here(),
            clock: self.options.clock,
            until: self.options.bench.until.clone(),
            knobs: self.board.knobs.iter().map(knob).collect(),
            reference: self.found.reference.clone(),
            front: front_of(&points, self.options.clock),
            apart: self.options.bench.apart.is_some(),
            points,
        }
    }
}

/// The figures of a run against the reference.
///
/// Errors: garments that cannot be compared.
pub(crate) fn measured(ran: &Ran, reference: &Ran) -> Result<Measured, StageError> {
    let missed = |ran: &Ran| ran.figures.as_ref().map(|f| f.shortfalls.clone()).unwrap_or_default();
    let (known, shortfalls) = (missed(reference), missed(ran));
    Ok(Measured {
        wall_s: vec![ran.wall_s],
        cpu_s: vec![ran.cpu_s],
        peak_memory_bytes: ran.peak_memory_bytes,
        stages_s: ran.stages_s.clone(),
        triangles: ran.garment.triangles.len(),
        errors: compare(ran, reference)?,
        ease_mm: ease(ran),
        sound: shortfalls.iter().all(|s| known.iter().any(|k| k.code == s.code)),
        shortfalls: shortfalls.into_iter().map(|s| (s.code.to_string(), s.message)).collect(),
        repeatable: true,
    })
}

//! The whole measurement: reference, settings, what is kept on disk; bounded by a budget, gone on
//! with by the next session.
//!
//! Half of the budget is the reference's. Then the pipeline's own setting, a space-filling start,
//! and the gaps of the front. A setting that takes longer than the limit is stopped, which is a
//! result as well. A choice of stage whose first two settings gave nothing is not tried further,
//! nor is a setting whose nearest neighbour took longer than what is left.
//!
//! - `budget`: whether the budget is long enough; `next`: which setting is measured next;
//!   `setting`: its runs and figures; `store`: what is kept.

mod budget;
pub mod ladder;
mod next;
mod setting;
mod store;

pub(crate) use budget::{Allowed, GROWTH};
pub(crate) use setting::measured;

use crate::digest::digest;
use crate::knobs::knob::KnobSpec;
use crate::knobs::slot::{Knob, KnobBoard, ReferenceValue, setting_words};
use crate::knobs::source::Source;
use crate::measure::Bench;
use crate::record::{Clock, KnobRecord, Machine, Point, SCHEME, SettingOutcome, Trade, front_of, today};
use crate::study::ladder::{FoundReference, RATIO, ReferenceSearch};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use store::{Against, KIND, Store};
use toile_core::{Length, StageError};
use toile_pipeline::Pipeline;
use toile_pipeline::cache::Cache;

/// The reference's share of the budget, and that of its moved starts.
const REFERENCE_SHARE: [f64; 2] = [0.35, 0.15];

/// A setting may take this share of the budget where no limit is given.
const LIMIT_SHARE: f64 = 0.1;

/// What is asked.
#[derive(Clone)]
pub struct StudyOptions {
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

impl StudyOptions {
    /// Longest run of a setting.
    fn limit(&self) -> Duration {
        self.allowed().limit()
    }

    fn allowed(&self) -> Allowed {
        Allowed { budget: self.budget, limit: self.limit }
    }
}

/// A study that has its reference.
struct Study<'a> {
    source: &'a Source<'a>,
    options: &'a StudyOptions,
    board: KnobBoard,
    found: FoundReference,
    store: Store,
    started: Instant,
}

/// Measures, or goes on with what was measured.
///
/// Errors: a knob that does not fit, the pipeline's own setting fails, the budget is too short to
/// say anything, the folder cannot be written, stopped by the user (what was measured is kept).
pub fn study(
    source: &Source<'_>,
    pipeline: &Pipeline,
    knobs: &[KnobSpec],
    options: &StudyOptions,
    tell: &mut dyn FnMut(String),
) -> Result<Trade, StageError> {
    let mut study = Study::begin(source, pipeline, knobs, options, tell)?;
    let ended = study.settings(tell);
    let trade = study.trade(pipeline);
    ended.map(|()| trade)
}

impl<'a> Study<'a> {
    /// Binds the knobs and finds the reference, or takes over that of an earlier session.
    fn begin(
        source: &'a Source<'a>,
        pipeline: &Pipeline,
        knobs: &[KnobSpec],
        options: &'a StudyOptions,
        tell: &mut dyn FnMut(String),
    ) -> Result<Study<'a>, StageError> {
        let started = Instant::now();
        let board = KnobBoard::new(source, pipeline, knobs)?.with_reference(&options.reference)?;
        if options.bench.apart.is_none() {
            let words =
                "runs share this process: memory is the process's own, and a run that breaks off ends all";
            tell(words.into());
        }
        let (found, store) = found(&search(source, &board, options), pipeline, options, tell)?;
        Ok(Study { source, options, board, found, store, started })
    }

    fn left(&self) -> Duration {
        self.options.budget.saturating_sub(self.started.elapsed())
    }

    /// Measures settings until the budget or the number of settings is used up, or nothing new is
    /// left.
    fn settings(&mut self, tell: &mut dyn FnMut(String)) -> Result<(), StageError> {
        let most = self.options.points.unwrap_or(usize::MAX);
        while self.store.lines.len() < most && !self.left().is_zero() {
            let Some(setting) = self.next() else { break };
            let Some(point) = self.measure(setting)? else { continue };
            if self.store.lines.is_empty() && matches!(point.outcome, SettingOutcome::OverLimit { .. }) {
                break;
            }
            tell(self.words(&point));
            self.store.add(point)?;
        }
        let nothing = self.store.lines.is_empty() && most > 0;
        if nothing { Err(self.options.allowed().nothing_measured()) } else { Ok(()) }
    }

    /// The record of all.
    fn trade(&self, pipeline: &Pipeline) -> Trade {
        let knob = |k: &Knob| KnobRecord { key: k.key.clone(), values: k.dial.words() };
        let mut points: Vec<Point> = Vec::new();
        for p in &self.store.lines {
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
            reads: self.store.head.reads.clone(),
            points,
        }
    }
}

/// How the reference of a board is looked for.
fn search<'a>(
    source: &'a Source<'a>,
    board: &'a KnobBoard,
    options: &'a StudyOptions,
) -> ReferenceSearch<'a> {
    let share = |s: f64| options.budget.mul_f64(s);
    ReferenceSearch {
        source,
        board,
        bench: &options.bench,
        allowed: options.allowed(),
        cache: Arc::new(Cache::new(&options.out.join("reference"))),
        budget: share(REFERENCE_SHARE[0]),
        starts_budget: share(REFERENCE_SHARE[1]),
        starts: options.starts,
        jitter: options.jitter,
    }
}

/// The reference and the record: those of an earlier session where they are of this pipeline, else
/// new ones.
fn found(
    search: &ReferenceSearch<'_>,
    pipeline: &Pipeline,
    options: &StudyOptions,
    tell: &mut dyn FnMut(String),
) -> Result<(FoundReference, Store), StageError> {
    let base = base(pipeline, search.board, options);
    if let Some(mut store) = Store::taken_up(&options.out, KIND, &base, tell) {
        store.lines.retain(|p| p.outcome.stands(options.limit()));
        tell(format!(
            "goes on from {} settings in {}, and from the reference that is there",
            store.lines.len(),
            options.out.display()
        ));
        let levels = &store.head.on.reference.levels;
        if let (Some(own), true) = (levels.first(), store.lines.iter().all(|p| p.measured().is_none())) {
            options.allowed().holds(own.wall_s)?;
        }
        return Ok((search.again(store.head.on.reference.clone())?, store));
    }
    let found = search.run(tell)?;
    let against = Against { reference: found.reference.clone() };
    let store = Store::new(&options.out, KIND, base, found.ran.reads.clone(), against);
    store.write()?;
    Ok((found, store))
}

/// What must be the same for a later session: the pipeline, what is refined, the stage that ends
/// runs, the number of threads. Knobs that are not refined may change.
fn base(pipeline: &Pipeline, board: &KnobBoard, options: &StudyOptions) -> String {
    let own = board.own();
    let finer = board.refined(RATIO).into_iter().filter(|(key, value)| own.get(key) != Some(value)).collect();
    let threads = Machine::here().threads.to_string();
    digest(pipeline, &[&setting_words(&finer), options.bench.until.as_deref().unwrap_or(""), &threads])
}

//! The reference: the pipeline refined level by level until its garment stops moving.
//!
//! Level k divides every knob whose card says that less is finer (edge length, time step,
//! tolerance) by sqrt(2)^k and multiplies those of which more is finer (counts of iterations) by
//! it, from the pipeline's own values and with the pipeline's own stages. A power at which rounding
//! leaves every resolution in space where it was is no level. What is no knob is part of the
//! problem and stays. Levels end once the estimate of what is missing (`richardson`, on the
//! distance that 95 % of the surface keep) is below [`CLOSE_ENOUGH`] and the level is finer than
//! any setting to be judged by it; or with the share of the budget that is theirs, which is then
//! said, with the estimate, or that there is none.
//!
//! The garment has many states of rest, so a reference has a spread of its own: the level before
//! the last is started again from moved starts (`jitter`, `spread`), and made a little finer and
//! coarser (`neighbours`).
//!
//! Cost: with sqrt(2), each level has twice the triangles of the one before. Limit: three levels
//! are needed for an order.

mod neighbours;
mod spread;

pub(crate) use spread::moved_start;

use crate::errors::{compare, ease};
use crate::knobs::slot::{KnobBoard, Setting, setting_words};
use crate::knobs::source::Source;
use crate::measure::{Bench, Missed, Ran};
use crate::record::{Order, Reference, ReferenceLevel};
use crate::reference::richardson::{RefinementStep, convergence};
use crate::study::{Allowed, GROWTH};
use std::sync::Arc;
use std::time::{Duration, Instant};
use toile_core::{Length, StageError};
use toile_pipeline::cache::Cache;

/// Factor between levels: twice the triangles, so that a further level is never far out of the
/// budget.
pub const RATIO: f64 = std::f64::consts::SQRT_2;
/// Missing distance at which the reference counts as found, mm: a quarter of what a tape measure
/// resolves.
pub const CLOSE_ENOUGH: f64 = 0.25;
/// How much finer than the finest setting to be judged the reference must be.
pub const FINER: f64 = 1.3;
/// Levels at most: 2^9 times the triangles.
const MOST_LEVELS: usize = 10;
/// Powers of the ratio among which levels are looked for: a single part of an edge takes two to
/// become another number.
const MOST_POWERS: i32 = 2 * MOST_LEVELS as i32;
/// Said where a finer level there is not.
const NO_FINER: &str = "no knob can be refined further";

/// How the reference is looked for.
pub struct ReferenceSearch<'a> {
    /// The pipeline.
    pub source: &'a Source<'a>,
    /// Its knobs.
    pub board: &'a KnobBoard,
    /// How runs are made.
    pub bench: &'a Bench,
    /// Keeps the levels for later sessions.
    pub cache: Arc<Cache>,
    /// What the user allows for everything and for a run of a setting.
    pub(crate) allowed: Allowed,
    /// Time for the levels.
    pub budget: Duration,
    /// Time for the moved starts and the neighbours.
    pub starts_budget: Duration,
    /// How many moved starts; without any, no neighbours are tried either.
    pub starts: usize,
    /// Root mean square move of a start.
    pub jitter: Length,
}

/// The reference with its garment.
pub struct FoundReference {
    /// The record.
    pub reference: Reference,
    /// The finest level.
    pub ran: Ran,
}

impl ReferenceSearch<'_> {
    /// Refines until the garment stops moving or the budget is used.
    ///
    /// Errors: the pipeline's own setting fails; the budget is too short to say anything; stopped
    /// by the user.
    pub fn run(&self, tell: &mut dyn FnMut(String)) -> Result<FoundReference, StageError> {
        let started = Instant::now();
        let (mut levels, mut last, mut before) = (Vec::<ReferenceLevel>::new(), None::<Ran>, None::<Ran>);
        let stopped = loop {
            let k = levels.len();
            if let Some(why) = self.enough(&levels, self.budget.saturating_sub(started.elapsed())) {
                break why;
            }
            let Some(setting) = self.setting(k) else { break NO_FINER.into() };
            // Without the pipeline's own setting there is nothing to say: it may take the whole
            // budget.
            let left = match k {
                0 => self.allowed.budget,
                _ => self.budget.saturating_sub(started.elapsed()),
            };
            let ran = match self.level(&setting, Some(left)) {
                Ok(ran) => ran,
                Err(missed) => break self.after_miss(missed, &levels)?,
            };
            if k == 0 {
                self.allowed.holds(ran.wall_s)?;
            }
            let mut level = level(self.board, setting, &ran, last.as_ref())?;
            level.finer = levels.last().map(|before| self.board.ratio(&level.setting, &before.setting));
            tell(words(k, &level));
            levels.push(level);
            before = last.replace(ran);
        };
        let Some(ran) = last else { return Err(StageError::internal("a reference without levels")) };
        let (unmoved, began) = (before.as_ref().unwrap_or(&ran), Instant::now());
        let spread = self.spread(&levels, unmoved, tell)?;
        let left = self.starts_budget.saturating_sub(began.elapsed());
        let neighbours = match self.starts {
            0 => None,
            _ => self.neighbours(&levels, unmoved, left, tell)?,
        };
        let ease_mm = ease(&ran);
        let reference =
            Reference { ratio: RATIO, levels, stopped, spread, neighbours, ease_mm, ..Reference::default() };
        Ok(FoundReference { reference: self.with_orders(reference), ran })
    }

    /// The reference of an earlier session: its finest level again, from the cache where it is
    /// still there.
    ///
    /// Errors: it does not run any more.
    pub fn again(&self, reference: Reference) -> Result<FoundReference, StageError> {
        let finest =
            reference.levels.last().ok_or_else(|| StageError::invalid("the record holds no reference"))?;
        let ran = self.level(&finest.setting, None)?;
        Ok(FoundReference { ran, reference: self.with_orders(reference) })
    }

    /// The setting of a level; none where no knob can be refined so far.
    fn setting(&self, level: usize) -> Option<Setting> {
        let powers = (0..MOST_POWERS).map(|k| self.board.refined(RATIO.powi(k)));
        let own = self.board.refined(1.0);
        let is_spatial = powers.clone().any(|s| self.board.differ_in_space(&s, &own));
        let differ = |a: &Setting, b: &Setting| a != b && (!is_spatial || self.board.differ_in_space(a, b));
        let mut levels: Vec<Setting> = vec![own];
        for setting in powers {
            if levels.last().is_some_and(|last| differ(&setting, last)) {
                levels.push(setting);
            }
        }
        levels.into_iter().nth(level)
    }

    /// The reference with the orders that its levels show.
    fn with_orders(&self, reference: Reference) -> Reference {
        let order = |figure: fn(&ReferenceLevel) -> Option<f64>| self.order(&reference.levels, figure);
        Reference {
            mean: order(|l| Some(l.moved_mm?.mean)),
            p95: order(|l| Some(l.moved_mm?.p95)),
            displacement: order(|l| Some(l.displaced_mm?.mean)),
            ..reference.clone()
        }
    }

    fn order(&self, levels: &[ReferenceLevel], figure: fn(&ReferenceLevel) -> Option<f64>) -> Option<Order> {
        let step = |w: &[ReferenceLevel]| {
            let ratio = self.board.ratio(&w[1].setting, &w[0].setting);
            Some(RefinementStep { distance: figure(&w[1])?, ratio })
        };
        let steps: Vec<RefinementStep> = levels.windows(2).filter_map(step).collect();
        let c = convergence(&steps)?;
        Some(Order { order: c.order.is_finite().then_some(c.order), missing_mm: c.missing })
    }

    fn level(&self, setting: &Setting, limit: Option<Duration>) -> Result<Ran, Missed> {
        let pipeline = self.source.load(&self.board.overrides(setting));
        let pipeline = pipeline.map_err(|f| Missed::Failed(StageError::invalid(f.to_string())))?;
        self.bench.run(&pipeline, limit, Some(self.cache.clone()))
    }

    /// Why no further level is wanted; none where one is.
    fn enough(&self, levels: &[ReferenceLevel], left: Duration) -> Option<String> {
        let k = levels.len();
        let last = levels.last()?;
        if self.setting(k).is_none() {
            return Some(NO_FINER.into());
        }
        let missing = self.order(levels, |l| Some(l.moved_mm?.p95)).map(|o| o.missing_mm);
        if missing.is_some_and(|m| m <= CLOSE_ENOUGH) && self.board.is_finer(&last.setting, FINER) {
            return Some(format!("it stopped moving: less than {CLOSE_ENOUGH} mm is missing"));
        }
        if k >= MOST_LEVELS {
            return Some(format!("{MOST_LEVELS} levels are the most"));
        }
        let growth = match levels {
            // No solver is quicker than its triangles are many.
            [.., a, b] => (b.wall_s / a.wall_s).clamp(RATIO * RATIO, 8.0),
            _ => GROWTH,
        };
        let next = last.wall_s * growth;
        // The second level is always tried: one level alone says nothing.
        (k >= 2 && next > left.as_secs_f64()).then(|| {
            format!(
                "the next level would take about {next:.0} s, more than is left of its share of the budget"
            )
        })
    }

    fn after_miss(&self, missed: Missed, levels: &[ReferenceLevel]) -> Result<String, StageError> {
        match (missed, levels) {
            (Missed::OverLimit(_), []) => Err(self.allowed.ended_first()),
            (Missed::OverLimit(_), [own]) => Err(self.allowed.unrefined(own.wall_s)),
            (Missed::OverLimit(s), _) => {
                Ok(format!("level {} was not done after {s:.0} s, its share of the budget", levels.len()))
            }
            (Missed::Failed(e), [_, ..]) => Ok(format!("level {} fails: {}", levels.len(), e.message)),
            (missed, _) => Err(missed.into()),
        }
    }
}

fn level(
    board: &KnobBoard,
    setting: Setting,
    ran: &Ran,
    before: Option<&Ran>,
) -> Result<ReferenceLevel, StageError> {
    let moved = before.map(|b| compare(ran, b)).transpose()?;
    let strain = ran.figures.as_ref().map_or(0.0, |f| f.garment.edge_strain.p99);
    let overrides = board.overrides(&setting).into_iter().map(|o| (o.path, o.value)).collect();
    Ok(ReferenceLevel {
        setting,
        overrides,
        triangles: ran.garment.triangles.len(),
        wall_s: ran.wall_s,
        cpu_s: ran.cpu_s,
        finer: None,
        moved_mm: moved.as_ref().map(|e| e.distance_mm),
        displaced_mm: moved.as_ref().map(|e| e.displacement_mm),
        ease_mm: ease(ran),
        strain_p99: strain * 1e2,
    })
}

fn words(k: usize, level: &ReferenceLevel) -> String {
    let setting = setting_words(&level.setting);
    let moved = level.moved_mm.map_or_else(String::new, |m| {
        format!(", moved by {:.2} mm in the mean, {:.2} mm at 95 %", m.mean, m.p95)
    });
    format!("reference level {k} ({setting}): {} triangles, {:.1} s{moved}", level.triangles, level.wall_s)
}

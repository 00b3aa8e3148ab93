//! The runs of an ablation, each kept as soon as it is done.

use super::kept::{Came, KeptRecord};
use super::options::AblationOptions;
use super::record::{Ablation, GarmentChange};
use super::rows::ablation;
use super::turned::{Turned, all_turned};
use super::{AblationProgress, RunStep, outline};
use crate::digest::garment_digest;
use crate::errors::compare;
use crate::knobs::source::Source;
use crate::measure::{Missed, Ran};
use std::time::{Duration, Instant};
use toile_core::{ErrorCode, StageError};
use toile_pipeline::Pipeline;

/// Runs the pipeline as decided and with each decision turned round, or goes on with what was run.
///
/// Errors: no decision there is to turn round; the pipeline fails as it is, or does not end within
/// the budget; an override that does not load; the folder cannot be written; stopped by the user
/// (what was measured is kept).
pub fn ablate(
    source: &Source<'_>,
    pipeline: &Pipeline,
    options: &AblationOptions,
    tell: &mut dyn FnMut(AblationProgress),
) -> Result<Ablation, StageError> {
    let started = Instant::now();
    let turned = all_turned(source, pipeline, options.bench.until.as_deref())?;
    let kept = KeptRecord::open(pipeline, options, &mut |note| tell(AblationProgress::Note(note)));
    let mut session = Session { pipeline, options, turned, kept, started };
    match session.rounds(tell) {
        Ok(()) | Err(AblationStop::Budget) => session.ablation(),
        Err(AblationStop::Failed(e)) => Err(e),
    }
}

/// An ablation at work.
struct Session<'a> {
    pipeline: &'a Pipeline,
    options: &'a AblationOptions,
    turned: Vec<Turned>,
    kept: KeptRecord,
    started: Instant,
}

/// Why it goes no further.
enum AblationStop {
    /// The budget is used up.
    Budget,
    /// A fault, or the user's wish.
    Failed(StageError),
}

impl From<StageError> for AblationStop {
    fn from(e: StageError) -> Self {
        AblationStop::Failed(e)
    }
}

impl Session<'_> {
    fn rounds(&mut self, tell: &mut dyn FnMut(AblationProgress)) -> Result<(), AblationStop> {
        (0..self.options.repeats).try_for_each(|round| self.round(round, tell))
    }

    /// What is missing of a round, beside a run as decided of this session: garments and times of
    /// one hour are compared.
    fn round(&mut self, round: usize, tell: &mut dyn FnMut(AblationProgress)) -> Result<(), AblationStop> {
        let missing: Vec<usize> = self.missing(round).collect();
        let is_new = !self.kept.own().contains_key(&round);
        if missing.is_empty() && !is_new {
            return Ok(());
        }
        let beside = format!("as decided, beside the rest of round {}", round + 1);
        let own = self.as_decided(if is_new { "as decided" } else { &beside }, tell)?;
        if is_new {
            self.kept.add_own(round, &own)?;
        }
        missing.into_iter().try_for_each(|index| self.turned_round(index, round, &own, tell))
    }

    fn as_decided(&self, what: &str, tell: &mut dyn FnMut(AblationProgress)) -> Result<Ran, AblationStop> {
        let left = self.left()?;
        tell(self.step(what));
        let ran = self.options.bench.run(self.pipeline, left, None);
        ran.map_err(|missed| match missed {
            // Without a limit of its own, only the budget ends it.
            Missed::OverLimit(_) => AblationStop::Budget,
            missed => AblationStop::Failed(missed.into()),
        })
    }

    /// One run with a decision turned round, beside the run of the same round as decided.
    fn turned_round(
        &mut self,
        index: usize,
        round: usize,
        own: &Ran,
        tell: &mut dyn FnMut(AblationProgress),
    ) -> Result<(), AblationStop> {
        let left = self.left()?;
        let turned = &self.turned[index];
        tell(self.step(&turned.by));
        let limit = [self.options.limit, left].into_iter().flatten().min();
        let came = match self.options.bench.run_also(&turned.pipeline, &turned.also, limit) {
            Ok(ran) => Came::Ran {
                cpu_s: ran.cpu_s,
                saved_s: ran.cpu_s - own.cpu_s,
                change: (!self.kept.has_change(&turned.by)).then(|| changed(own, &ran)).transpose()?,
            },
            Err(Missed::Cancelled) => return Err(AblationStop::Failed(Missed::Cancelled.into())),
            Err(Missed::Failed(e)) => Came::Failed { message: e.message },
            // The end of the budget says nothing of the decision.
            Err(Missed::OverLimit(seconds)) => {
                self.left()?;
                Came::OverLimit { seconds }
            }
        };
        Ok(self.kept.add_turned(round, &turned.by, came)?)
    }

    /// What is left of the budget, where there is one.
    fn left(&self) -> Result<Option<Duration>, AblationStop> {
        let left = self.options.budget.map(|budget| budget.saturating_sub(self.started.elapsed()));
        if left.is_some_and(|l| l.is_zero()) { Err(AblationStop::Budget) } else { Ok(left) }
    }

    /// The decisions that a round has not turned round yet.
    fn missing(&self, round: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.turned.len()).filter(move |i| self.kept.is_missing(&self.turned[*i].by, round))
    }

    /// Runs that are done, and runs in all.
    fn count(&self) -> [usize; 2] {
        let (own, rounds) = (self.kept.own(), self.options.repeats);
        let missing = |round| self.missing(round).count() + usize::from(!own.contains_key(&round));
        let all = rounds * (1 + self.turned.len());
        [all - (0..rounds).map(missing).sum::<usize>(), all]
    }

    fn step(&self, what: &str) -> AblationProgress {
        let [done, all] = self.count();
        AblationProgress::Run(RunStep { done, all, what: what.to_owned() })
    }

    fn ablation(self) -> Result<Ablation, StageError> {
        if self.kept.own().is_empty() {
            let message = "the budget ended before the pipeline as it is had run once";
            return Err(StageError::new(ErrorCode::Timeout, message).hint("give a longer --budget"));
        }
        let (count, until) = (self.count(), self.options.bench.until.clone());
        Ok(ablation(self.pipeline, until, &self.turned, &self.kept, count))
    }
}

fn changed(own: &Ran, turned: &Ran) -> Result<GarmentChange, StageError> {
    let errors = compare(turned, own)?;
    let crossings = |ran: &Ran| ran.figures.as_ref().and_then(|f| f.garment.self_crossings);
    Ok(GarmentChange {
        same_bits: garment_digest(&own.garment) == garment_digest(&turned.garment),
        distance_mm: errors.distance_mm,
        outline_mm: outline::distance(&own.garment, &turned.garment).into(),
        texture_levels: errors.texture_levels,
        crossings: [crossings(own), crossings(turned)],
    })
}

//! Runs the picks of a wish afresh, the best first, until one keeps it.

use super::{SettingProof, Wish, overrides, picks, refusal};
use crate::errors::compare;
use crate::knobs::slot::setting_words;
use crate::knobs::source::Source;
use crate::measure::{Bench, Missed, Ran};
use crate::record::Trade;
use crate::study::ladder::moved_start;
use crate::study::measured;
use std::path::Path;
use std::sync::Arc;
use toile_core::{ErrorCode, Length, StageError};
use toile_pipeline::cache::Cache;
use toile_pipeline::{Override, Pipeline};

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
    pub fn prove(&self, wish: &Wish, tell: &mut dyn FnMut(String)) -> Result<SettingProof, StageError> {
        match refusal(self.trade, wish) {
            Some(refused) => Err(refused),
            None => self.prove_against(wish, &self.reference()?, &mut Vec::new(), tell),
        }
    }

    /// As [`Prover::prove`], against a reference that was run already; settings in `known`, proved
    /// before from every start, are not run again, and those that are proved now are added.
    ///
    /// Errors: no setting is proved.
    pub fn prove_against(
        &self,
        wish: &Wish,
        reference: &Ran,
        known: &mut Vec<SettingProof>,
        tell: &mut dyn FnMut(String),
    ) -> Result<SettingProof, StageError> {
        for point in picks(self.trade, wish) {
            let setting = setting_words(&self.trade.points[point].setting);
            let before = known.iter().find(|p| p.point == point).cloned();
            let proof = match before.map_or_else(|| self.one(point, wish, reference), Ok) {
                Ok(proof) => proof,
                Err(Missed::Failed(e)) => {
                    tell(format!("{setting}: {}", e.message));
                    continue;
                }
                Err(missed) => return Err(missed.into()),
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
        Ok(self.bench.run(&pipeline, None, Some(cache))?)
    }

    pub(super) fn load(&self, overrides: &[Override]) -> Result<Pipeline, StageError> {
        self.source.load(overrides).map_err(|f| StageError::invalid(f.to_string()))
    }

    fn one(&self, point: usize, wish: &Wish, reference: &Ran) -> Result<SettingProof, Missed> {
        let set = overrides(&self.trade.points[point].overrides);
        let pipeline = self.load(&set).map_err(Missed::Failed)?;
        let fresh = self.bench.run(&pipeline, None, None)?;
        let fresh = measured(&fresh, reference).map_err(Missed::Failed)?;
        let mut proof = SettingProof { point, fresh, starts: Vec::new(), failed: Vec::new() };
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
}

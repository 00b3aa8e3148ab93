//! Picks a setting from a measurement and proves it by fresh runs.
//!
//! For an error: the quickest setting that keeps it, for a time: the most accurate of the front that keeps that. The choice
//! is run afresh, and again from moved starts, each held against the reference; where a run misses what was asked, the
//! next one is tried. Ten of ten starts within the error mean, with 95 % confidence, that fewer than 26 % of
//! all such starts miss it (1 - 0.05^(1/10)); three of three would mean 63 %.
//!
//! An error below what the reference itself is known to (`floor`) is refused before anything runs: a fresh run may well lie
//! that near to the reference, and both that far from the garment.
//!
//! - `wish`: what is asked; `pick`: the settings that may keep it, and the refusal; `prover`, `proof`: fresh runs and what
//!   they showed; `written`: the file.

mod pick;
mod proof;
mod prover;
mod wish;
mod written;

pub use pick::{picks, refusal};
pub use proof::Proof;
pub use prover::Prover;
pub use wish::Wish;
pub use written::MARK;

use crate::digest::digest;
use crate::record::Trade;
use toile_core::StageError;
use toile_core::pipeline::{Override, Pipeline};

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

#[cfg(test)]
mod tests;

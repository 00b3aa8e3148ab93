//! Picks a setting from a measurement and proves it by fresh runs.
//!
//! For an error: the quickest setting that keeps it, for a time: the most accurate of the front
//! that keeps that. The choice is run afresh, and again from moved starts, each held against the
//! reference; where a run misses what was asked, the next one is tried. Ten of ten starts within
//! the error mean, with 95 % confidence, that fewer than 26 % of all such starts miss it (1 -
//! 0.05^(1/10)); three of three would mean 63 %.
//!
//! An error below what the reference itself is known to (`floor`) is refused before anything runs:
//! a fresh run may well lie that near to the reference, and both that far from the garment.
//!
//! - `wish`: what is asked; `pick`: the settings that may keep it, and the refusal; `prover`,
//!   `proof`: fresh runs and what they showed; `written`: the file.

mod pick;
mod proof;
mod prover;
mod wish;
mod written;

pub use pick::{picks, refusal};
pub use proof::SettingProof;
pub use prover::Prover;
pub use wish::Wish;
pub use written::MARK;

use crate::digest::{changed, digest};
use crate::record::Trade;
use toile_core::StageError;
use toile_pipeline::{Override, Pipeline};

/// Holds a record against the pipeline that it is to be used for.
///
/// Errors: it holds no setting; it was measured by another version or on another pipeline, or
/// before a stage, a parameter or a file changed.
pub fn check(trade: &Trade, pipeline: &Pipeline) -> Result<(), StageError> {
    let refused = |why: String, hint: &str| Err(StageError::invalid(why).hint(hint));
    let Some(first) = trade.points.first() else {
        let why = format!("the measurement of \"{}\" holds no setting", trade.file);
        return refused(why, "give `toile trade` more --points or a longer --budget");
    };
    if first.key != digest(pipeline, &[]) || trade.toile != env!("CARGO_PKG_VERSION") {
        let why = format!("the measurement is of another state of \"{}\"", trade.file);
        return refused(
            why,
            "run `toile trade` again: the pipeline, a stage's version or a `--set` has changed",
        );
    }
    match changed(&trade.reads) {
        None => Ok(()),
        Some(path) => {
            refused(format!("\"{path}\" has changed since it was measured"), "run `toile trade` again")
        }
    }
}

pub(crate) fn overrides(pairs: &[(String, String)]) -> Vec<Override> {
    pairs.iter().map(|(path, value)| Override { path: path.clone(), value: value.clone() }).collect()
}

#[cfg(test)]
mod tests;

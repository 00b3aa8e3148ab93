//! Every decision of a pipeline turned round, one at a time: what it costs, what it changes,
//! whether its rule holds.
//!
//! Runs are fresh, without a cache, in rounds: once as decided, then once with each decision turned
//! round, and again. So what a busy machine does to one run it does to its neighbours as well, and
//! times are compared within a round.
//!
//! Each run is kept as soon as it is done, and a later session goes on from there. A round that was
//! broken off is gone on with beside one more run as decided, since times and garments are compared
//! with those of the same session alone; that run is not counted.
//!
//! - `turned`: the pipelines; `run`: the rounds; `kept`: what is on disk; `rows`, `record`,
//!   `table`: what it comes to.

mod kept;
mod options;
mod outline;
mod progress;
mod record;
mod rows;
mod run;
mod table;
#[cfg(test)]
mod tests;
mod turned;

pub use options::AblationOptions;
pub use progress::{AblationProgress, RunStep};
pub use record::{Ablation, DecisionRow, EndedBudget, GarmentChange, RuleVerdict, SCHEME, Saved, Unmeasured};
pub use run::ablate;
pub use table::{csv, lines};
pub(crate) use turned::path_to;

use toile_core::StageError;
use toile_core::artifact::OutputFile;

/// The files of an ablation: CSV and JSON.
///
/// Errors: a fault of the program's own.
pub fn files(ablation: &Ablation) -> Result<Vec<OutputFile>, StageError> {
    let fault = |e: serde_json::Error| StageError::internal(format!("the record cannot be written: {e}"));
    let json = serde_json::to_string_pretty(ablation).map_err(fault)?;
    let file = |path: &str, bytes: Vec<u8>| OutputFile { path: path.into(), bytes };
    Ok(vec![file("ablation.csv", csv(ablation).into_bytes()), file("ablation.json", json.into_bytes())])
}

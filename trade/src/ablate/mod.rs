//! Every decision of a pipeline turned round, one at a time: what it costs, what it changes, whether its rule holds.
//!
//! Runs are fresh, without a cache, in rounds: once as decided, then once with each decision turned round, and again. So what a
//! busy machine does to one run it does to its neighbours as well, and times are compared within a round.

mod outline;
mod record;
mod run;
mod table;
#[cfg(test)]
mod tests;

pub use record::{Ablation, Change, Row, SCHEME, Saved, Verdict};
pub(crate) use run::path_to;
pub use run::{Options, Step, ablate};
pub use table::{csv, lines};

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

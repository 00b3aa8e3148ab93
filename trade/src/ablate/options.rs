//! What is asked of an ablation.

use crate::measure::Bench;
use std::path::PathBuf;
use std::time::Duration;

/// What is asked.
#[derive(Clone)]
pub struct AblationOptions {
    /// Folder of the record.
    pub out: PathBuf,
    /// Rounds, those of earlier sessions counted.
    pub repeats: usize,
    /// Time for everything; none ends with the last round.
    pub budget: Option<Duration>,
    /// Longest run with a decision turned round.
    pub limit: Option<Duration>,
    /// How runs are made.
    pub bench: Bench,
}

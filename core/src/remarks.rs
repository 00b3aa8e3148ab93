//! Notes and warnings that a stage gives the user beside its result.

use serde::{Deserialize, Serialize};

/// Remarks of one stage, in two levels; the third, an error, ends the run.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Remarks {
    /// Decisions, each with the fact behind it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// What the user should look at.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

impl Remarks {
    /// Adds those of one entry of a named set, under the entry's name.
    pub fn absorb(&mut self, entry: &str, others: Remarks) {
        let named = |texts: Vec<String>| texts.into_iter().map(move |t| format!("{entry}: {t}"));
        self.notes.extend(named(others.notes));
        self.warnings.extend(named(others.warnings));
    }
}

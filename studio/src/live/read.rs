//! A pattern as its reader gave it, with the seams that are proposed for it.

use std::sync::{Arc, OnceLock};
use toile_core::artifact::Pattern;
use toile_pattern::pattern::{ProposedSeam, proposed_seams};

/// A pattern as its reader gave it, before any alteration.
#[derive(Debug)]
pub(crate) struct ReadPattern {
    pattern: Arc<Pattern>,
    proposed: OnceLock<Vec<ProposedSeam>>,
}

impl ReadPattern {
    pub(super) fn new(pattern: Arc<Pattern>) -> Self {
        ReadPattern { pattern, proposed: OnceLock::new() }
    }

    /// The proposals, the surest first; none for a pattern that has seams.
    pub(crate) fn proposed(&self) -> &[ProposedSeam] {
        let propose = || match self.pattern.seams.is_empty() {
            true => proposed_seams(&self.pattern.pieces),
            false => Vec::new(),
        };
        self.proposed.get_or_init(propose)
    }
}

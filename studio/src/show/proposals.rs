//! Seams that are proposed for a pattern that was read without any.

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};
use toile_core::artifact::{EdgeRef, EdgeUse, Pattern, PatternSeam};
use toile_pattern::pattern::{ProposedSeam, proposed_seams};

/// A pattern as its reader gave it, before any alteration.
#[derive(Debug)]
pub(crate) struct ReadPattern {
    pattern: Arc<Pattern>,
    proposed: OnceLock<Vec<ProposedSeam>>,
}

impl ReadPattern {
    pub(crate) fn new(pattern: Arc<Pattern>) -> Self {
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

    /// The proposals of edges that are not sewn in the pattern that came of it.
    pub(super) fn view(&self, now: Option<&Pattern>) -> Value {
        let edges = |seam: &PatternSeam| -> Vec<EdgeRef> {
            seam.sides.iter().flatten().map(|used| used.edge.clone()).collect()
        };
        let sewn: BTreeSet<EdgeRef> = now.into_iter().flat_map(|p| &p.seams).flat_map(edges).collect();
        let is_free = |p: &&ProposedSeam| edges(&p.seam).iter().all(|edge| !sewn.contains(edge));
        self.proposed().iter().filter(is_free).map(told).collect()
    }
}

fn told(proposed: &ProposedSeam) -> Value {
    let ProposedSeam { seam, confidence, reason } = proposed;
    let used = |u: &EdgeUse| json!({ "piece": u.edge.panel, "edge": u.edge.edge, "reverse": u.reversed });
    let side = |side: &Vec<EdgeUse>| side.iter().map(used).collect::<Vec<_>>();
    json!({
        "name": seam.name,
        "kind": seam.kind.word(),
        "sides": seam.sides.iter().map(side).collect::<Vec<_>>(),
        "confidence": confidence,
        "reason": reason,
    })
}

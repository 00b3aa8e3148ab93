//! Seams that are proposed for a pattern that was read without any.

use crate::live::read::ReadPattern;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use toile_core::artifact::{EdgeRef, EdgeUse, Pattern, PatternSeam};
use toile_pattern::pattern::ProposedSeam;

/// The proposals of edges that are not sewn in `now`, the pattern that came of it.
pub(super) fn proposals(read: &ReadPattern, now: Option<&Pattern>) -> Value {
    let edges = |seam: &PatternSeam| -> Vec<EdgeRef> {
        seam.sides.iter().flatten().map(|used| used.edge.clone()).collect()
    };
    let sewn: BTreeSet<EdgeRef> = now.into_iter().flat_map(|p| &p.seams).flat_map(edges).collect();
    let is_free = |p: &&ProposedSeam| edges(&p.seam).iter().all(|edge| !sewn.contains(edge));
    read.proposed().iter().filter(is_free).map(told).collect()
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

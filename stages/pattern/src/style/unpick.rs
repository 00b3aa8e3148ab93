//! Seams that are left open.

use toile_core::prelude::*;

/// Leaves seams open: a slit or a placket, or a dart that is to be compared with the same garment
/// without it.
///
/// A seam is named by one of its edges, `"panel.edge"`; every seam of that edge is left open. Their
/// cloth is not drawn together, and no report counts them as open.
#[stage(
    role = Style,
    source = "tailoring",
    example = "Unpick(edges: [\"front.side_left\"])",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Unpick {
    /// The edges whose seams are left open.
    #[param(default = Vec::new())]
    edges: Vec<EdgeRef>,
}

#[stage]
impl Unpick {
    pub(crate) fn run(&self, plan: &SewingPlan, cx: &Context) -> Result<SewingPlan, StageError> {
        if self.edges.is_empty() {
            cx.note("`edges` names none: every seam is sewn");
        }
        let is_of = |seam: &Seam, edge: &EdgeRef| seam.a == *edge || seam.b == *edge;
        for edge in &self.edges {
            if !plan.seams.iter().any(|s| is_of(s, edge)) {
                return Err(unsewn(edge, plan));
            }
        }
        let (open, sewn): (Vec<Seam>, Vec<Seam>) =
            plan.seams.iter().cloned().partition(|s| self.edges.iter().any(|e| is_of(s, e)));
        open.iter().for_each(|s| cx.note(format!("\"{}\" is left open", s.name())));
        Ok(SewingPlan { seams: sewn })
    }
}

/// No seam has that edge.
fn unsewn(edge: &EdgeRef, plan: &SewingPlan) -> StageError {
    let seams: Vec<String> = plan.seams.iter().map(|s| format!("\"{}\"", s.name())).collect();
    let hint = match seams.is_empty() {
        true => "the plan has no seams: take this stage out".to_owned(),
        false => format!("the seams are {}", seams.join(", ")),
    };
    StageError::new(ErrorCode::InvalidParameter, format!("no seam has the edge \"{edge}\""))
        .at("edges")
        .hint(hint)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn edge(panel: &str, edge: &str) -> EdgeRef {
        EdgeRef { panel: panel.into(), edge: edge.into() }
    }

    fn plan() -> SewingPlan {
        let seam =
            |a, b| Seam { a: edge("front", a), b: edge("back", b), kind: SeamKind::Matched, reversed: false };
        SewingPlan { seams: vec![seam("left", "right"), seam("right", "left")] }
    }

    #[test]
    fn the_seams_of_an_edge_are_left_open_whichever_side_it_is() {
        let cx = Context::quiet();
        for (named, left) in [(edge("front", "left"), 1), (edge("back", "left"), 0)] {
            let made = Unpick { edges: vec![named] }.run(&plan(), &cx).unwrap();
            assert_eq!(made.seams, [plan().seams[left].clone()]);
        }
        assert_eq!(
            cx.take_remarks().notes,
            ["\"front.left + back.right\" is left open", "\"front.right + back.left\" is left open"]
        );
    }

    #[test]
    fn an_edge_without_a_seam_is_refused_with_the_seams() {
        let e = Unpick { edges: vec![edge("front", "hem")] }.run(&plan(), &Context::quiet()).unwrap_err();
        assert_eq!(e.message, "no seam has the edge \"front.hem\"");
        assert_eq!(
            e.hint.as_deref(),
            Some("the seams are \"front.left + back.right\", \"front.right + back.left\"")
        );
    }

    #[test]
    fn without_edges_it_says_that_every_seam_is_sewn() {
        let cx = Context::quiet();
        assert_eq!(Unpick { edges: Vec::new() }.run(&plan(), &cx).unwrap(), plan());
        assert_eq!(cx.take_remarks().notes, ["`edges` names none: every seam is sewn"]);
    }
}

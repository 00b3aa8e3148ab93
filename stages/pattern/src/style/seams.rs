//! Seams that a pipeline file lists itself.

use super::outline::edges_of;
use super::sewing::{misnamed, sew};
use toile_core::prelude::*;
use toile_image::photo::sides;

/// One entry of a pipeline's `seams`.
#[choice]
pub enum SeamEntry {
    /// Equal lengths, the start of one edge with the end of the other, as pieces laid face to face
    /// meet.
    Match(EdgeRef, EdgeRef),
    /// The longer edge is gathered evenly onto the shorter.
    Gather(EdgeRef, EdgeRef),
    /// Equal lengths, start with start.
    Reversed(EdgeRef, EdgeRef),
}

impl SeamEntry {
    fn seam(&self) -> Seam {
        let (a, b, kind, reversed) = match self {
            SeamEntry::Match(a, b) => (a, b, SeamKind::Matched, false),
            SeamEntry::Gather(a, b) => (a, b, SeamKind::Gathered, false),
            SeamEntry::Reversed(a, b) => (a, b, SeamKind::Matched, true),
        };
        Seam { a: a.clone(), b: b.clone(), kind, reversed }
    }
}

/// Sews the edges that the file names, in place of the style's own seams.
///
/// Edges are written `"panel.edge"`, such as `"front.side_left"`. Unknown names, edges of very
/// different length that are not declared gathered, and reversed pairings are refused.
#[stage(
    role = Style,
    source = "3D garment modelling based on image-based rendering, about 2012",
    example = "Seams(seams: [Match(\"front.side_left\", \"back.side_left\")])",
    contracts(Deterministic, ThreadInvariant)
)]
pub struct Seams {
    /// What is sewn to what, in the order of the report.
    #[param(default = Vec::new())]
    seams: Vec<SeamEntry>,
}

#[stage]
impl Seams {
    pub(crate) fn run(
        &self,
        outlines: Set<Outline>,
        // What these seams stand in the place of.
        _plan: &SewingPlan,
        cx: &Context,
    ) -> Result<(Set<Outline>, SewingPlan), StageError> {
        let seams = self.seams.iter().map(SeamEntry::seam).collect();
        sew(&outlines, seams, cx)
    }

    /// Names of panels and edges, where photos and a built-in style make them.
    fn faults(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let seams: Vec<Seam> = self.seams.iter().map(SeamEntry::seam).collect();
        let edges = placed.maker("plan").and_then(edges_of);
        misnamed(&seams, sides(&placed.sources()).as_deref(), edges.as_deref())
    }
}

#[cfg(test)]
impl Seams {
    pub(super) fn of(seams: Vec<SeamEntry>) -> Self {
        Seams { seams }
    }
}

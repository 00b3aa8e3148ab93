//! A sewing pattern: pieces, seams, and where each piece goes, before anything is meshed.
//!
//! Readers of pattern files make it; [`Pattern::lower`] turns it into outlines and a sewing plan.

mod chain;
mod check;
mod curve;
mod drawn;
mod edge_role;
mod lower;
mod lowering_error;
mod piece;
mod pleats;
mod seam;
mod svg;
#[cfg(test)]
pub(in crate::artifact) mod tests;

pub use chain::lacking_stops;
pub use curve::{EdgeCurve, EdgePath};
pub use edge_role::EdgeRole;
pub use lower::Lowered;
pub use lowering_error::LoweringError;
pub use piece::{BodyPart, LinePurpose, Notch, PatternLoop, Piece, PieceEdge, PieceLine, Pose};
pub use seam::{EdgeUse, PatternSeam};

use super::{Artifact, ArtifactType, Kind, Measures};

/// The pieces of a garment and the seams between them; lengths in metres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pattern {
    /// Its name, such as that of its file.
    pub name: String,
    /// The pieces, in the order of the file.
    pub pieces: Vec<Piece>,
    /// The seams, in the order in which they are sewn and reported.
    pub seams: Vec<PatternSeam>,
}

impl Pattern {
    /// The piece of that name.
    pub fn piece(&self, name: &str) -> Option<&Piece> {
        self.pieces.iter().find(|p| p.name == name)
    }

    /// The length of a seam's side, metres; an edge that does not exist counts as 0.
    pub fn side_length(&self, side: &[EdgeUse]) -> f64 {
        let length = |u: &EdgeUse| self.piece(&u.edge.panel)?.path(&u.edge.edge).map(|p| p.length());
        side.iter().filter_map(length).sum()
    }
}

impl ArtifactType for Pattern {
    const KIND: Kind = Kind("pattern");
    const IN_SETS: bool = false;
}

impl Artifact for Pattern {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("pieces", self.pieces.len()).count("seams", self.seams.len());
        let holes: usize = self.pieces.iter().map(|p| p.holes.len()).sum();
        m.count("holes", holes).count("inner_lines", self.pieces.iter().map(|p| p.lines.len()).sum());
        m.count("notches", self.pieces.iter().map(|p| p.notches.len()).sum());
        for p in &self.pieces {
            for (k, e) in p.outer.edges.iter().enumerate() {
                m.push(&format!("edge.{}.{}", p.name, e.name), p.outer.path(k).length() * 1e3, "mm", 0.01);
            }
        }
        m
    }

    fn check(&self) -> Result<(), String> {
        check::check(self)
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        vec![("svg", svg::svg(self).into_bytes())]
    }
}

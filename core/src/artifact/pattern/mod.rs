//! A sewing pattern: pieces, seams, and where each piece goes, before anything is meshed.
//!
//! Readers of pattern files make it; [`Pattern::lower`] turns it into outlines and a sewing plan.

mod chain;
mod check;
mod curve;
mod lower;
mod piece;
mod pleats;
mod seam;
mod svg;
#[cfg(test)]
pub(in crate::artifact) mod tests;

pub use chain::lacking_stops;
pub use curve::{EdgeCurve, EdgePath};
pub use lower::{Lowered, LoweringError};
pub use piece::{BodyPart, LinePurpose, Notch, PatternLoop, Piece, PieceEdge, PieceLine, Pose};
pub use seam::{EdgeUse, PatternSeam};

use super::{Artifact, ArtifactType, Digester, Kind, Measures, Point2};

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

    /// The length of a seam's side, metres; an edge that there is none of counts as nothing.
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

    fn digest(&self, d: &mut Digester) {
        d.text("pattern").text(&self.name).count(self.pieces.len());
        self.pieces.iter().for_each(|p| digest_piece(p, d));
        d.count(self.seams.len());
        for s in &self.seams {
            s.kind.digest(d.text(&s.name));
            d.count(s.sides.len());
            for side in &s.sides {
                d.count(side.len());
                for u in side {
                    d.text(&u.edge.panel).text(&u.edge.edge).count(usize::from(u.reversed));
                }
            }
        }
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

    fn record(&self) -> Option<super::stored::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        vec![("svg", svg::svg(self).into_bytes())]
    }
}

fn digest_piece(p: &Piece, d: &mut Digester) {
    d.text(&p.name).count(1 + p.holes.len());
    for l in std::iter::once(&p.outer).chain(&p.holes) {
        digest_points(&l.corners, d);
        for e in &l.edges {
            digest_points(e.curve.points(), d.text(&e.name).text(e.curve.word()));
            if let EdgeCurve::Arc { bulge } = e.curve {
                d.floats([bulge]);
            }
        }
    }
    d.count(p.lines.len());
    p.lines.iter().for_each(|l| digest_points(&l.points, d.text(&l.name).count(l.purpose as usize)));
    d.count(p.notches.len());
    for n in &p.notches {
        d.text(&n.edge).floats([n.along, n.depth]);
    }
    digest_points(&p.drill_holes, d);
    digest_points(p.grain.as_ref().map_or(&[][..], |g| g), d);
    d.count(p.body_part.map_or(0, |b| 1 + b as usize)).count(p.layer as usize);
    if let Some(pose) = &p.pose {
        d.floats(pose.origin.coords.iter().chain(&pose.across).chain(&pose.along).copied());
    }
}

fn digest_points(points: &[Point2], d: &mut Digester) {
    d.count(points.len()).floats(points.iter().flat_map(|p| [p.x, p.y]));
}

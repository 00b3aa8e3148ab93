//! What can be changed, and who does it.

use super::{AlteredPattern, dart, held, mirror, moved, names, sewn, sewn_on};
use toile_core::prelude::*;

/// No move is longer than this, metres: a train of a wedding dress is shorter.
const LONGEST: f64 = 10.0;

/// One change of a pattern.
#[choice]
pub enum Alteration {
    /// Moves a corner; the two edges that meet there follow.
    MoveCorner {
        /// The piece.
        piece: String,
        /// Its number along the outline, from 0: the edge of that number starts there.
        corner: usize,
        /// To the right, as seen from outside the wearer.
        x: Length,
        /// Up.
        y: Length,
    },
    /// Moves an edge with both its corners.
    MoveEdge {
        /// The edge.
        edge: EdgeRef,
        /// To the right, as seen from outside the wearer.
        x: Length,
        /// Up.
        y: Length,
    },
    /// Makes an edge longer, or shorter where the length is negative.
    Lengthen {
        /// The edge.
        edge: EdgeRef,
        /// By how much.
        by: Length,
    },
    /// Cuts a dart out of an edge and sews its legs together.
    Dart {
        /// The edge.
        edge: EdgeRef,
        /// Where its middle lies, as a share of the edge from its start.
        at: f64,
        /// How wide it is at the edge.
        width: Length,
        /// How far it reaches into the piece.
        length: Length,
    },
    /// Adds the mirror image of a piece, or makes the piece of that name the mirror image.
    Mirror {
        /// The piece that is mirrored.
        piece: String,
        /// The name of the mirror image.
        name: String,
    },
    /// Sews two edges together.
    Sew {
        /// One edge.
        a: EdgeRef,
        /// The other.
        b: EdgeRef,
        /// Whether start is sewn to start.
        #[serde(default)]
        reversed: bool,
    },
    /// Opens every seam of an edge.
    Unsew {
        /// The edge.
        edge: EdgeRef,
    },
    /// Sews a piece onto another, as a pocket: all its edges but the highest.
    SewOn {
        /// The piece that lies outside.
        piece: String,
        /// The piece on which it lies.
        onto: String,
        /// How far its middle lies to the right of that of the other piece, as seen from outside
        /// the wearer; middles are those of the boxes around the pieces.
        x: Length,
        /// How far above it.
        y: Length,
    },
    /// Takes a piece out, and opens its seams.
    Remove {
        /// The piece.
        piece: String,
    },
}

impl Alteration {
    /// Changes a pattern.
    pub(super) fn carry_out(&self, altered: &mut AlteredPattern, cx: &Context) -> Result<(), StageError> {
        self.within_reason()?;
        let pattern = &mut altered.pattern;
        match self {
            Alteration::MoveCorner { piece, corner, .. } => {
                let p = names::piece(pattern, piece)?;
                let corner = names::corner(&pattern.pieces[p], *corner)?;
                self.moved(&mut pattern.pieces[p], &[corner])
            }
            Alteration::MoveEdge { edge, .. } => {
                let (p, k) = names::edge(pattern, edge)?;
                let next = (k + 1) % pattern.pieces[p].outer.corners.len();
                self.moved(&mut pattern.pieces[p], &[k, next])
            }
            Alteration::Lengthen { edge, .. } => {
                let (p, k) = names::edge(pattern, edge)?;
                self.lengthened(&mut pattern.pieces[p], k)
            }
            Alteration::Dart { edge, at, width, length } => {
                let dart = dart::CutDart { at: *at, width: width.metres(), length: length.metres() };
                dart.cut(edge, pattern, &mut altered.showing, cx)
            }
            Alteration::Mirror { piece, name } => {
                mirror::mirror(piece, name, pattern, &mut altered.showing, cx)
            }
            Alteration::Sew { a, b, reversed } => sewn::sew(pattern, [a, b], *reversed, cx),
            Alteration::Unsew { edge } => sewn::unsew(pattern, edge, cx),
            Alteration::SewOn { piece, onto, .. } => sewn_on::sew_on(pattern, piece, onto, self.way()),
            Alteration::Remove { piece } => sewn::remove(pattern, piece, cx),
        }
    }

    /// The lengths that it states.
    fn lengths(&self) -> Vec<Length> {
        match self {
            Alteration::MoveCorner { x, y, .. }
            | Alteration::MoveEdge { x, y, .. }
            | Alteration::SewOn { x, y, .. } => vec![*x, *y],
            Alteration::Lengthen { by, .. } => vec![*by],
            Alteration::Dart { width, length, .. } => vec![*width, *length],
            Alteration::Mirror { .. }
            | Alteration::Sew { .. }
            | Alteration::Unsew { .. }
            | Alteration::Remove { .. } => Vec::new(),
        }
    }

    /// Refuses lengths that no pattern has.
    fn within_reason(&self) -> Result<(), StageError> {
        match self.lengths().into_iter().find(|l| l.metres().is_nan() || l.metres().abs() > LONGEST) {
            Some(l) => Err(StageError::invalid(format!("{l} is longer than any piece"))
                .hint("lengths carry their unit, such as \"20 mm\"")),
            None => Ok(()),
        }
    }

    /// The way of a move, metres.
    fn way(&self) -> Vector2 {
        match self.lengths()[..] {
            [x, y] => Vector2::new(x.metres(), y.metres()),
            _ => Vector2::zeros(),
        }
    }

    /// Moves corners of a piece.
    fn moved(&self, piece: &mut Piece, corners: &[usize]) -> Result<(), StageError> {
        let (was, way) = (piece.clone(), self.way());
        let by = |share: f64| {
            let moves = |k: usize| if corners.contains(&k) { way * share } else { Vector2::zeros() };
            moved::moved(&was, moves)
        };
        *piece = held::whole(&was, by, |share| self.shorter(share))?;
        Ok(())
    }

    /// Makes an edge of a piece longer.
    fn lengthened(&self, piece: &mut Piece, k: usize) -> Result<(), StageError> {
        let (was, by) = (piece.clone(), self.lengths().first().map_or(0.0, |l| l.metres()));
        moved::can_lengthen(&was, k, by)?;
        *piece =
            held::whole(&was, |share| moved::lengthened(&was, k, by * share), |share| self.shorter(share))?;
        Ok(())
    }

    /// The same by a share, in whole millimetres, as it is written; none where nothing is left of
    /// it.
    fn shorter(&self, share: f64) -> Option<String> {
        let mm = |l: &Length| (l.metres() * share * 1e3).trunc();
        let left: Vec<f64> = self.lengths().iter().map(mm).collect();
        let text = match (self, &left[..]) {
            (Alteration::MoveCorner { piece, corner, .. }, [x, y]) => {
                format!("MoveCorner(piece: \"{piece}\", corner: {corner}, x: \"{x} mm\", y: \"{y} mm\")")
            }
            (Alteration::MoveEdge { edge, .. }, [x, y]) => {
                format!("MoveEdge(edge: \"{edge}\", x: \"{x} mm\", y: \"{y} mm\")")
            }
            (Alteration::Lengthen { edge, .. }, [by]) => {
                format!("Lengthen(edge: \"{edge}\", by: \"{by} mm\")")
            }
            _ => return None,
        };
        left.iter().any(|mm| *mm != 0.0).then(|| text.replace("\"-0 mm\"", "\"0 mm\""))
    }
}

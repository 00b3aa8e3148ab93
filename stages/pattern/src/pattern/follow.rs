//! Whether the edges of a seam's side follow each other, and whether its sides run as those of
//! pieces do that are seen from outside.
//!
//! Method: ends of edges that seams join are one place; so are the ends of neighbours in a loop. A
//! side whose next edge begins at another place than where the one before ends is a fault if both
//! are of one piece, or if other directions would let them follow: pieces may meet across an
//! opening that nothing sews. Edges run counter-clockwise around their piece, so that of two edges
//! that are sewn one is run through backwards. Cost: two to the power of a side's edges, of up to
//! [`TRIED`]. Limits: a place in the middle of an edge is none.

use super::faults::PatternFault;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// Edges of one piece may follow each other across an opening of this width, metres.
const OPENING: f64 = 0.02;
/// Edges that are this near to each other meet, metres.
const MEET: f64 = 1e-3;
/// Ends of chains that lie at the same share of two sides, as a share of them.
const NEAR: f64 = 0.01;
/// Directions are tried of sides of no more edges.
const TRIED: usize = 8;

/// An end of an edge: piece, name of the edge, and whether it is the edge's end.
type End<'a> = (&'a str, &'a str, bool);

/// Ends of edges as places that seams join.
struct JoinedEnds<'a> {
    pieces: &'a [Piece],
    /// For each end the number of its place.
    of: BTreeMap<End<'a>, usize>,
    /// Places that are one, each with another of its own or itself.
    joined: Vec<usize>,
}

impl<'a> JoinedEnds<'a> {
    fn of(pieces: &'a [Piece], seams: &'a [PatternSeam]) -> Self {
        let mut places = JoinedEnds { pieces, of: BTreeMap::new(), joined: Vec::new() };
        for p in pieces {
            let n = p.outer.edges.len();
            let first = places.joined.len();
            places.joined.extend(first..first + n);
            for (k, e) in p.outer.edges.iter().enumerate() {
                places.of.insert((&p.name, &e.name, false), first + k);
                places.of.insert((&p.name, &e.name, true), first + (k + 1) % n);
            }
            for l in &p.lines {
                for end in [false, true] {
                    places.of.insert((&p.name, &l.name, end), places.joined.len());
                    places.joined.push(places.joined.len());
                }
            }
        }
        for s in seams {
            for other in s.sides.iter().skip(1) {
                places.sew(&s.sides[0], other);
            }
        }
        places
    }

    fn place(&self, u: &EdgeUse, end: bool) -> Option<usize> {
        let at = (u.edge.panel.as_str(), u.edge.edge.as_str(), end != u.reversed);
        let mut place = *self.of.get(&at)?;
        while self.joined[place] != place {
            place = self.joined[place];
        }
        Some(place)
    }

    fn join(&mut self, a: Option<usize>, b: Option<usize>) {
        if let (Some(a), Some(b)) = (a, b) {
            self.joined[a.max(b)] = a.min(b);
        }
    }

    /// Joins the ends of two sides, and those of their edges that lie at the same share of them.
    fn sew(&mut self, a: &[EdgeUse], b: &[EdgeUse]) {
        let (Some(a0), Some(b0), Some(a1), Some(b1)) = (a.first(), b.first(), a.last(), b.last()) else {
            return;
        };
        self.join(self.place(a0, false), self.place(b0, false));
        self.join(self.place(a1, true), self.place(b1, true));
        let (sa, sb) = (self.shares(a), self.shares(b));
        for (i, s) in sa.iter().enumerate() {
            for (j, t) in sb.iter().enumerate() {
                if (s - t).abs() <= NEAR {
                    self.join(self.place(&a[i], true), self.place(&b[j], true));
                }
            }
        }
    }

    /// Where the edges of a side meet, as shares of its length.
    fn shares(&self, side: &[EdgeUse]) -> Vec<f64> {
        let lengths: Vec<f64> = side.iter().map(|u| self.path(u).map_or(0.0, |p| p.length())).collect();
        let whole: f64 = lengths.iter().sum();
        let mut before = 0.0;
        let sum = |l: &f64| {
            before += l;
            before / whole.max(f64::MIN_POSITIVE)
        };
        lengths[..lengths.len().saturating_sub(1)].iter().map(sum).collect()
    }

    fn path(&self, u: &EdgeUse) -> Option<EdgePath> {
        self.pieces.iter().find(|p| p.name == u.edge.panel)?.path(&u.edge.edge)
    }

    /// The flat point at an end of an edge.
    fn point(&self, u: &EdgeUse, end: bool) -> Option<Point2> {
        let path = self.path(u)?;
        Some(path.at(if end == u.reversed { 0.0 } else { path.length() }))
    }

    /// Whether one edge begins where the other ends; across an opening if it may be.
    fn follows(&self, a: &EdgeUse, b: &EdgeUse, opening: f64) -> bool {
        let near = || {
            let (p, q) = (self.point(a, true)?, self.point(b, false)?);
            Some((p - q).norm() <= opening)
        };
        self.place(a, true) == self.place(b, false)
            || (a.edge.panel == b.edge.panel && near().unwrap_or(true))
    }

    fn chain(&self, side: &[EdgeUse]) -> bool {
        side.windows(2).all(|w| self.follows(&w[0], &w[1], MEET))
    }

    /// The same edges in other directions, or in the other order, in which they follow each other.
    fn other(&self, side: &[EdgeUse]) -> Option<Vec<EdgeUse>> {
        let turned = |side: &[EdgeUse], which: usize| -> Vec<EdgeUse> {
            let one = |(k, u): (usize, &EdgeUse)| EdgeUse {
                reversed: u.reversed != (which >> k & 1 == 1),
                ..u.clone()
            };
            side.iter().enumerate().map(one).collect()
        };
        if side.len() > TRIED {
            return None;
        }
        let all = (1 << side.len()) - 1;
        // All of them turned is what a drawing in the other direction needs.
        let same = std::iter::once(all).chain(1..all).map(|which| turned(side, which));
        let back: Vec<EdgeUse> = side.iter().rev().cloned().collect();
        let back = (0..=all).map(move |which| turned(&back, which));
        same.chain(back).find(|side| self.chain(side))
    }

    /// Whether a side runs counter-clockwise around its pieces, or clockwise; none where it does
    /// both or runs along inner lines.
    fn way(&self, side: &[EdgeUse]) -> Option<bool> {
        let first = side.first()?.reversed;
        let outer = |u: &EdgeUse| {
            self.pieces.iter().any(|p| p.name == u.edge.panel && p.edge_number(&u.edge.edge).is_some())
        };
        side.iter().all(|u| u.reversed == first && outer(u)).then_some(!first)
    }
}

fn written(u: &EdgeUse) -> String {
    format!("\"{}{}\"", if u.reversed { "-" } else { "" }, u.edge)
}

/// The sides of seams whose edges do not follow each other.
pub(super) fn broken(pieces: &[Piece], seams: &[PatternSeam]) -> Vec<PatternFault> {
    let places = JoinedEnds::of(pieces, seams);
    let mut out = Vec::new();
    for seam in seams {
        for side in &seam.sides {
            let Some(w) = side.windows(2).find(|w| !places.follows(&w[0], &w[1], OPENING)) else { continue };
            let other = places.other(side);
            if w[0].edge.panel != w[1].edge.panel && other.is_none() {
                continue;
            }
            let remedy = match other {
                Some(other) => format!(
                    "edges run counter-clockwise around their piece, as the arrows in its picture show: write [{}]",
                    other.iter().map(written).collect::<Vec<_>>().join(", ")
                ),
                None => "name the edges between them, too, in the order in which they follow each other"
                    .to_owned(),
            };
            let what = format!(
                "seam \"{}\": {} does not begin where {} ends",
                seam.name,
                written(&w[1]),
                written(&w[0])
            );
            out.push(PatternFault {
                code: ErrorCode::PatternLoading,
                param: "seams",
                what,
                remedy: Some(remedy),
            });
        }
    }
    out
}

/// A sentence of each seam whose two sides run around their pieces in the same way.
pub(super) fn inside_out(pieces: &[Piece], seams: &[PatternSeam]) -> Vec<String> {
    let places = JoinedEnds::of(pieces, seams);
    let mut out = Vec::new();
    for seam in seams {
        let joins = matches!(seam.kind, SeamKind::Matched | SeamKind::Gathered);
        let [a, b] = &seam.sides[..] else { continue };
        if let (true, Some(x), Some(y)) = (joins, places.way(a), places.way(b))
            && x == y
        {
            let name = |side: &[EdgeUse]| side.first().map_or_else(String::new, written);
            out.push(format!(
                "seam \"{}\" runs {} around both pieces, which sews one of them inside out: turn one side, {} or {}, unless that is meant",
                seam.name,
                if x { "counter-clockwise" } else { "clockwise" },
                name(a),
                name(b)
            ));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rectangles; edges 0 below, 1 right, 2 above, 3 left.
    fn pieces() -> Vec<Piece> {
        let corners = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.4], [0.0, 0.4]].map(|[x, y]| Point2::new(x, y));
        let edges = ["edge_0", "edge_1", "edge_2", "edge_3"]
            .map(|n| PieceEdge { name: n.into(), curve: EdgeCurve::Line });
        let piece = |name: &str| Piece {
            name: name.into(),
            outer: PatternLoop { corners: corners.into(), edges: edges.clone().into() },
            ..Piece::default()
        };
        vec![piece("front"), piece("back")]
    }

    fn seam(sides: &[&[&str]]) -> PatternSeam {
        let one = |text: &&str| {
            let (reversed, bare) = text.strip_prefix('-').map_or((false, *text), |rest| (true, rest));
            let (panel, edge) = bare.split_once('.').unwrap_or((bare, ""));
            EdgeUse { edge: EdgeRef { panel: panel.into(), edge: edge.into() }, reversed }
        };
        let sides = sides.iter().map(|s| s.iter().map(one).collect()).collect();
        PatternSeam { name: "side".into(), kind: SeamKind::Matched, sides }
    }

    fn told(seams: &[PatternSeam]) -> Vec<(String, String)> {
        broken(&pieces(), seams).into_iter().map(|f| (f.what, f.remedy.unwrap_or_default())).collect()
    }

    #[test]
    fn a_chain_whose_edges_do_not_follow_each_other_is_told_with_how_they_would() {
        let chain = |a: &[&str]| seam(&[a, &["-back.edge_3", "-back.edge_2"]]);
        assert_eq!(told(&[chain(&["front.edge_1", "front.edge_2"])]), []);
        assert_eq!(
            told(&[chain(&["-front.edge_1", "-front.edge_2"])]),
            [(
                "seam \"side\": \"-front.edge_2\" does not begin where \"-front.edge_1\" ends".into(),
                "edges run counter-clockwise around their piece, as the arrows in its picture show: write [\"front.edge_1\", \"front.edge_2\"]".into()
            )]
        );
        assert_eq!(
            told(&[chain(&["front.edge_1", "front.edge_3"])])[0].1,
            "name the edges between them, too, in the order in which they follow each other"
        );
    }

    #[test]
    fn a_chain_goes_on_across_a_seam_and_across_an_opening_of_two_pieces() {
        let side = seam(&[&["front.edge_1"], &["-back.edge_3"]]);
        let around = |a: &str, b: &str| seam(&[&[a, b], &["-front.edge_2"]]);
        assert_eq!(told(&[side.clone(), around("front.edge_0", "back.edge_0")]), []);
        // Backwards they would not meet; without the side seam nothing says that they do.
        assert_eq!(told(&[side, around("front.edge_0", "-back.edge_0")]).len(), 1);
        assert_eq!(told(&[around("front.edge_0", "-back.edge_0")]), []);
    }

    #[test]
    fn a_seam_that_turns_a_piece_inside_out_is_told() {
        let told = |a: &str, b: &str| inside_out(&pieces(), &[seam(&[&[a], &[b]])]);
        assert_eq!(told("front.edge_1", "-back.edge_3"), Vec::<String>::new());
        assert_eq!(
            told("front.edge_1", "back.edge_3"),
            [
                "seam \"side\" runs counter-clockwise around both pieces, which sews one of them inside out: turn one side, \
              \"front.edge_1\" or \"back.edge_3\", unless that is meant"
            ]
        );
    }
}

//! The layers of a pleat are sewn into the edge that its lines end on.
//!
//! Method: where both lines of a pleat end on one outer edge, that edge is cut at them and at the
//! folds between them. The cloth of the pleat lies there in three layers: it is sewn to itself and
//! to the edge beside it, and whatever else is sewn to the edge is sewn to what is seen of it
//! alone, as a tailor lays pleats before the waistband is set on. Cost: linear in the edges.
//! Limits: where two pleats lie so close that one covers the other, or one reaches beyond the edge,
//! its layers are sewn to each other and not to the edge.

use super::super::{EdgeRef, Point2, SeamKind};
use super::{EdgeCurve, EdgePath, EdgeUse, Notch, Pattern, PatternSeam, Piece, PieceEdge};
use crate::artifact::sewing::seam_kind::PleatFold;

/// A line ends on an edge that is this near to its end, metres.
const NEAR: f64 = 3e-3;
/// Two cuts this near to each other are one, metres.
const ALIKE: f64 = 1e-6;

/// A pleat at an edge: where its lines end on it, metres from the edge's start.
struct LaidPleat {
    name: String,
    fold: PleatFold,
    piece: usize,
    edge: usize,
    ends: [f64; 2],
}

/// A stretch of an edge, metres from its start.
type EdgeStretch = [f64; 2];

impl LaidPleat {
    fn low(&self) -> f64 {
        self.ends[0].min(self.ends[1])
    }

    fn high(&self) -> f64 {
        self.ends[0].max(self.ends[1])
    }

    /// The layers that lie on each other, groups of stretches, each from its fold that is seen;
    /// what lies on top is the last of its group.
    fn layers(&self) -> Vec<Vec<EdgeStretch>> {
        let [a, c] = self.ends;
        match self.fold {
            PleatFold::Knife => {
                let half = 0.5 * (c - a);
                vec![vec![[a, a + half], [c, a + half], [a, a - half]]]
            }
            PleatFold::Box => {
                let part = 0.25 * (c - a);
                vec![
                    vec![[a, a + part], [a + 2.0 * part, a + part], [a, a - part]],
                    vec![[c, c - part], [c - 2.0 * part, c - part], [c, c + part]],
                ]
            }
        }
    }
}

impl Pattern {
    /// The same with the layers of its pleats sewn into the edges that they end on; nothing where
    /// no pleat ends on an edge.
    pub(super) fn pleated(&self) -> Option<Pattern> {
        let laid: Vec<LaidPleat> = self.seams.iter().filter_map(|s| laid(self, s)).collect();
        if laid.is_empty() {
            return None;
        }
        let mut out = self.clone();
        let mut edges: Vec<(usize, usize)> = laid.iter().map(|l| (l.piece, l.edge)).collect();
        edges.sort_unstable();
        edges.dedup();
        // The last edge of a piece first, so that the numbers of the others stay.
        for (piece, edge) in edges.into_iter().rev() {
            let mine: Vec<&LaidPleat> = laid.iter().filter(|l| (l.piece, l.edge) == (piece, edge)).collect();
            cut(&mut out, piece, edge, &mine);
        }
        Some(out)
    }
}

/// Where a pleat's lines end on an outer edge.
fn laid(pattern: &Pattern, s: &PatternSeam) -> Option<LaidPleat> {
    let SeamKind::Pleat(fold) = s.kind else { return None };
    let ([[a], [b]], 2) = ([&s.sides[0][..], &s.sides[s.sides.len() - 1][..]], s.sides.len()) else {
        return None;
    };
    let piece = pattern.pieces.iter().position(|p| p.name == a.edge.panel && p.name == b.edge.panel)?;
    let p = &pattern.pieces[piece];
    let found = |u: &EdgeUse| -> Option<Vec<(usize, f64)>> {
        let path = p.line(&u.edge.edge).and_then(|_| p.path(&u.edge.edge))?;
        Some([path.at(0.0), path.at(path.length())].iter().filter_map(|end| on_edge(p, *end)).collect())
    };
    let (one, other) = (found(a)?, found(b)?);
    let both =
        one.iter().flat_map(|x| other.iter().filter(move |y| x.0 == y.0).map(move |y| (x.0, [x.1, y.1])));
    let (edge, ends) = both.into_iter().next()?;
    ((ends[0] - ends[1]).abs() > ALIKE).then(|| LaidPleat { name: s.name.clone(), fold, piece, edge, ends })
}

/// The outer edge on which a point lies, and where.
fn on_edge(piece: &Piece, p: Point2) -> Option<(usize, f64)> {
    let near = |k: usize| {
        let path = piece.outer.path(k);
        let (mut best, mut before) = ((f64::INFINITY, 0.0), 0.0);
        for w in path.points().windows(2) {
            let d = w[1] - w[0];
            let t = ((p - w[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let far = (p - (w[0] + d * t)).norm();
            if far < best.0 {
                best = (far, (before + t * d.norm()).min(path.length()));
            }
            before += d.norm();
        }
        (best, k)
    };
    let nearest = (0..piece.outer.edges.len()).map(near).min_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
    let ((far, along), k) = nearest;
    (far <= NEAR).then_some((k, along))
}

/// Cuts an edge at its pleats and sews their layers.
fn cut(out: &mut Pattern, piece: usize, edge: usize, laid: &[&LaidPleat]) {
    let path = out.pieces[piece].outer.path(edge);
    let length = path.length();
    let hidden = |s: f64| laid.iter().any(|l| s > l.low() + ALIKE && s < l.high() - ALIKE);
    let mut groups: Vec<(String, Vec<EdgeStretch>)> = Vec::new();
    for l in laid {
        for mut group in l.layers() {
            let seen = group[2];
            let free = [seen[0], seen[1], 0.5 * (seen[0] + seen[1])].iter().all(|s| !hidden(*s));
            if !free || seen[1] < 0.0 || seen[1] > length {
                group.pop();
            }
            groups.push((l.name.clone(), group));
        }
    }
    let mut stops: Vec<f64> = groups.iter().flat_map(|g| g.1.iter().flatten().copied()).collect();
    stops.extend([0.0, length]);
    stops.sort_by(f64::total_cmp);
    stops.retain(|s| (0.0..=length).contains(s));
    stops.dedup_by(|b, a| *b - *a < ALIKE);
    if let Some(last) = stops.last_mut() {
        *last = length;
    }
    let names = split(&mut out.pieces[piece], edge, &path, &stops);
    let panel = out.pieces[piece].name.clone();
    let old = EdgeRef { panel: panel.clone(), edge: names.0.clone() };
    let parts: Vec<(String, bool)> =
        names.1.iter().zip(stops.windows(2)).map(|(n, w)| (n.clone(), hidden(0.5 * (w[0] + w[1])))).collect();
    for s in &mut out.seams {
        s.sides.iter_mut().for_each(|side| *side = side.iter().flat_map(|u| seen(u, &old, &parts)).collect());
    }
    let side = |of: EdgeStretch| -> Vec<EdgeUse> {
        let reversed = of[0] > of[1];
        let within = |w: &[f64]| {
            let middle = 0.5 * (w[0] + w[1]);
            middle > of[0].min(of[1]) && middle < of[0].max(of[1])
        };
        let inside = stops.windows(2).zip(&names.1).filter(|(w, _)| within(w));
        let mut uses: Vec<EdgeUse> = inside
            .map(|(_, n)| EdgeUse { edge: EdgeRef { panel: panel.clone(), edge: n.clone() }, reversed })
            .collect();
        if reversed {
            uses.reverse();
        }
        uses
    };
    for (name, group) in groups {
        let sides = group.into_iter().map(side).collect();
        out.seams.push(PatternSeam {
            name: format!("{name} at {}", names.0),
            kind: SeamKind::Matched,
            sides,
        });
    }
}

/// Replaces an edge by its parts between the stops; its name and theirs.
fn split(piece: &mut Piece, edge: usize, path: &EdgePath, stops: &[f64]) -> (String, Vec<String>) {
    let old = piece.outer.edges[edge].clone();
    let taken = |name: &String| {
        piece.outer.edges.iter().chain(piece.holes.iter().flat_map(|h| &h.edges)).any(|e| e.name == *name)
            || piece.line(name).is_some()
    };
    let names: Vec<String> = (1..stops.len())
        .map(|k| {
            let mut name = format!("{}_{k}", old.name);
            while taken(&name) {
                name.push('\'');
            }
            name
        })
        .collect();
    let parts = stops.windows(2).zip(&names).map(|(w, name)| {
        let mut points = path.between(w[0], w[1]);
        points.pop();
        points.remove(0);
        let curve = match (&old.curve, points.is_empty()) {
            (EdgeCurve::Line, _) | (_, true) => EdgeCurve::Line,
            _ => EdgeCurve::Polyline { points },
        };
        PieceEdge { name: name.clone(), curve }
    });
    let parts: Vec<PieceEdge> = parts.collect();
    let corners: Vec<Point2> = stops[1..stops.len() - 1].iter().map(|s| path.at(*s)).collect();
    piece.outer.edges.splice(edge..=edge, parts);
    piece.outer.corners.splice(edge + 1..edge + 1, corners);
    for n in piece.notches.iter_mut().filter(|n| n.edge == old.name) {
        let k = stops[1..stops.len() - 1].partition_point(|s| *s <= n.along);
        *n = Notch { edge: names[k].clone(), along: n.along - stops[k], depth: n.depth };
    }
    (old.name, names)
}

/// What stands for the use of an edge once it is cut: its parts that are seen.
fn seen(u: &EdgeUse, old: &EdgeRef, parts: &[(String, bool)]) -> Vec<EdgeUse> {
    if u.edge != *old {
        return vec![u.clone()];
    }
    let part = |(name, _): &(String, bool)| EdgeUse {
        edge: EdgeRef { panel: old.panel.clone(), edge: name.clone() },
        reversed: u.reversed,
    };
    let mut uses: Vec<EdgeUse> = parts.iter().filter(|p| !p.1).map(part).collect();
    if u.reversed {
        uses.reverse();
    }
    uses
}

#[cfg(test)]
mod tests;

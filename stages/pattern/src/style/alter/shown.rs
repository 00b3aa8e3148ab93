//! Where the cloth of a pattern that is altered lies in the photos.
//!
//! For each edge it is remembered where its points lie, by shares of its length. An edge that is
//! moved, scaled or parted keeps these places, so that its part of the photo goes along; the inside
//! follows the outline ([`Outline::lying`]).

use super::names::other_side;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// Points this near to where they lie, lie as they are cut, metres.
const SAME: f64 = 1e-4;
/// Points of the leg of a dart whose places are kept.
const ON_LEG: usize = 16;

/// What photos show of the pieces, by their names.
pub(super) struct Showing(BTreeMap<String, ShownPiece>);

/// A piece in its photo.
#[derive(Clone)]
struct ShownPiece {
    frame: PhotoFrame,
    edges: BTreeMap<String, ShownEdge>,
}

/// Places in the coordinates of the frame, metres, each with the share of the edge's length at
/// which it lies, ascending.
#[derive(Clone, Default)]
struct ShownEdge(Vec<(f64, Point2)>);

impl Showing {
    /// What the photos of outlines show of the pieces that they are.
    pub(super) fn of(pattern: &Pattern, outlines: Option<&Set<Outline>>) -> Self {
        let all = outlines.into_iter().flat_map(Set::iter);
        let shown =
            all.filter_map(|(name, o)| Some((name.to_owned(), ShownPiece::of(pattern.piece(name)?, o)?)));
        Showing(shown.collect())
    }

    /// The outline of an altered piece, where it lies in its photo.
    pub(super) fn laid(&self, pattern: &Pattern, name: &str, outline: Outline) -> Outline {
        match self.0.get(name).zip(pattern.piece(name)) {
            Some((shown, piece)) => shown.laid(piece, outline),
            None => outline,
        }
    }

    /// An edge of a piece was parted by a dart: its parts and legs by their names, and the shares
    /// of the edge at which the mouth starts and ends.
    pub(super) fn part(
        &mut self,
        before: &Piece,
        after: &Piece,
        edge: &str,
        names: &[String; 4],
        mouth: [f64; 2],
    ) {
        let Some(shown) = self.0.get_mut(&before.name) else { return };
        let Some(whole) = shown.edges.get(edge).cloned() else { return };
        let (points, _) = before.outer.points();
        let loops = Loop { points, corners: Vec::new() };
        let old = shown.laid(before, plain(before, loops));
        let leg = |name: &str| {
            let path = after.path(name);
            let at = |k: usize| {
                let share = k as f64 / ON_LEG as f64;
                let place = path.as_ref().map_or_else(Point2::origin, |p| p.at(share * p.length()));
                (share, old.lying(place))
            };
            ShownEdge((0..=ON_LEG).map(at).collect())
        };
        let made = [whole.part(0.0, mouth[0]), leg(&names[1]), leg(&names[2]), whole.part(mouth[1], 1.0)];
        shown.edges.remove(edge);
        shown.edges.extend(names.iter().cloned().zip(made));
    }

    /// A piece became the mirror image of another, under a name. One that a photo shows already
    /// keeps its own.
    pub(super) fn mirror(&mut self, piece: &str, name: &str) {
        if let Some(shown) = self.0.get(piece).filter(|_| !self.0.contains_key(name)) {
            let mirrored = shown.mirrored();
            self.0.insert(name.to_owned(), mirrored);
        }
    }
}

/// The outline of a piece by the edges of its pattern.
fn plain(piece: &Piece, outer: Loop) -> Outline {
    let (_, corners) = piece.outer.points();
    let n = corners.len();
    let edge = |k: usize| Edge {
        name: piece.outer.edges[k].name.clone(),
        start: corners[k],
        end: corners[(k + 1) % n],
        gauge: Gauge::default(),
    };
    Outline {
        edges: (0..n).map(edge).collect(),
        outer,
        holes: Vec::new(),
        inner: Vec::new(),
        frame: None,
        lies: Vec::new(),
    }
}

impl ShownPiece {
    /// Of a piece and its outline; none where that lies in no photo.
    fn of(piece: &Piece, outline: &Outline) -> Option<Self> {
        let frame = outline.frame?;
        let place = |i: usize| outline.lies.get(i).copied().unwrap_or(outline.outer.points[i]);
        let mut edges: BTreeMap<String, ShownEdge> = BTreeMap::new();
        each_point(piece, outline, |edge, i, along| {
            edges.entry(edge.to_owned()).or_default().0.push((along, place(i)));
        });
        Some(ShownPiece { frame, edges })
    }

    /// The outline of the piece, with its frame and its places.
    fn laid(&self, piece: &Piece, outline: Outline) -> Outline {
        let mut found = vec![None; outline.outer.points.len()];
        each_point(piece, &outline, |edge, i, along| {
            if let Some(shown) = self.edges.get(edge) {
                found[i] = shown.at(along);
            }
        });
        let is_same = |(p, q): (&Point2, &Option<Point2>)| q.is_some_and(|q| (p - q).norm() < SAME);
        let lies = match outline.outer.points.iter().zip(&found).all(is_same) {
            true => Vec::new(),
            false => found.into_iter().collect::<Option<_>>().unwrap_or_default(),
        };
        Outline { frame: Some(self.frame), lies, ..outline }
    }

    /// The same photo over the mirror image of the piece.
    fn mirrored(&self) -> ShownPiece {
        let PhotoFrame { mirrored, turn, .. } = self.frame;
        let edges = self.edges.iter().map(|(name, e)| (other_side(name), e.mirrored())).collect();
        ShownPiece { frame: PhotoFrame { mirrored: !mirrored, turn: -turn, ..self.frame }, edges }
    }
}

impl ShownEdge {
    /// The place at a share of the edge; none of an edge without places.
    fn at(&self, share: f64) -> Option<Point2> {
        let k = self.0.partition_point(|(s, _)| *s < share);
        let (before, after) = (self.0.get(k.saturating_sub(1))?, self.0.get(k).or(self.0.last())?);
        let step = after.0 - before.0;
        let t = if step > 0.0 { ((share - before.0) / step).clamp(0.0, 1.0) } else { 0.0 };
        Some(before.1 + (after.1 - before.1) * t)
    }

    /// The part between two shares, as an edge of its own.
    fn part(&self, from: f64, to: f64) -> ShownEdge {
        let span = (to - from).max(f64::MIN_POSITIVE);
        let ends = |share: f64| self.at(share).map(|p| (share, p));
        let inner = self.0.iter().copied().filter(|(s, _)| *s > from && *s < to);
        let all = ends(from).into_iter().chain(inner).chain(ends(to));
        ShownEdge(all.map(|(s, p)| ((s - from) / span, p)).collect())
    }

    fn mirrored(&self) -> ShownEdge {
        let flip = |(s, p): &(f64, Point2)| (1.0 - s, Point2::new(-p.x, p.y));
        ShownEdge(self.0.iter().rev().map(flip).collect())
    }
}

/// Calls `with` for each point of an outline, edge by edge of the piece, with the edge's name, the
/// point's number and its share of the edge's length; corners come with both their edges.
fn each_point(piece: &Piece, outline: &Outline, mut with: impl FnMut(&str, usize, f64)) {
    let n = outline.outer.points.len();
    let points: Vec<Vec<Point2>> = outline.edges.iter().map(|e| outline.edge_points(e)).collect();
    let mut lengths: BTreeMap<&str, f64> = BTreeMap::new();
    for (edge, points) in outline.edges.iter().zip(&points) {
        *lengths.entry(whole(piece, &edge.name)).or_default() += polyline_length(points);
    }
    let mut gone: BTreeMap<&str, f64> = BTreeMap::new();
    for (edge, points) in outline.edges.iter().zip(&points) {
        let name = whole(piece, &edge.name);
        let all = lengths.get(name).copied().unwrap_or_default().max(f64::MIN_POSITIVE);
        let along = gone.entry(name).or_default();
        for (k, p) in points.iter().enumerate() {
            *along += if k > 0 { (p - points[k - 1]).norm() } else { 0.0 };
            with(name, (edge.start + k) % n, (*along / all).min(1.0));
        }
    }
}

/// The edge of a piece that an edge of its outline is, or is one of the numbered parts of.
fn whole<'a>(piece: &Piece, name: &'a str) -> &'a str {
    let is_number = |part: &str| part.trim_end_matches('\'').parse::<usize>().is_ok();
    match name.rsplit_once('_') {
        Some((whole, part)) if piece.path(name).is_none() && is_number(part) => whole,
        _ => name,
    }
}

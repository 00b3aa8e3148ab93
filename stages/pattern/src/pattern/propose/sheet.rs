//! What is known of the edges of flat pieces before any is sewn: their forms, angles, mirror images
//! and equal ones.
//!
//! Cost: pieces squared times their edges. Limits: a mirror image is one at the grain; pieces are
//! not turned to find it.

use toile_core::prelude::*;

/// Parts of an edge at whose ends it is compared.
pub(super) const PARTS: usize = 24;
/// Edges that are one another's image or equal lie on each other to this, metres.
const SAME: f64 = 2e-3;
/// The direction of an edge at its ends is taken over this length, metres.
const TIP: f64 = 6e-3;
/// Notches nearer to an end mark the corner, metres.
const AT_END: f64 = 0.01;

/// An edge of a piece.
#[derive(Debug, Clone)]
pub(super) struct Edge {
    pub(super) piece: usize,
    /// Its number in the piece.
    pub(super) number: usize,
    pub(super) length: f64,
    /// Points at equal lengths, counter-clockwise in the piece.
    pub(super) points: Vec<Point2>,
    /// The direction out of the piece, at a right angle to the line from end to end.
    pub(super) out: Vector2,
    /// The direction of its start and its end.
    ways: [Vector2; 2],
    /// Places of notches from its start.
    pub(super) notches: Vec<f64>,
}

/// All edges of all pieces.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) edges: Vec<Edge>,
    /// The edge that follows in the piece.
    pub(super) next: Vec<usize>,
    /// The angle inside the piece at the start of the edge, degrees.
    pub(super) angle: Vec<f64>,
    /// The edge that is its image when its piece is mirrored at the grain.
    pub(super) image: Vec<Option<usize>>,
    /// The first edge that has its form and lies in a piece of the same form.
    pub(super) alike: Vec<usize>,
    /// Least and greatest corner of each piece.
    pub(super) boxes: Vec<[Point2; 2]>,
    /// The first piece that is cut from the same drawing, by the names that readers give to copies.
    pub(super) block: Vec<usize>,
    /// Whether a piece was unfolded, by the names that readers give to its edges.
    pub(super) unfolded: Vec<bool>,
    /// The numbers of the edges of each piece.
    spans: Vec<(usize, usize)>,
}

impl Sheet {
    pub(super) fn of(pieces: &[Piece]) -> Self {
        let mut edges: Vec<Edge> = Vec::new();
        let mut spans = Vec::new();
        let mut next = Vec::new();
        for (i, p) in pieces.iter().enumerate() {
            let first = edges.len();
            let n = p.outer.edges.len();
            edges.extend((0..n).map(|k| edge(i, p, k)));
            next.extend((0..n).map(|k| first + (k + 1) % n));
            spans.push((first, n));
        }
        let mut angle = vec![180.0; edges.len()];
        for (e, &after) in next.iter().enumerate() {
            let (come, go) = (edges[e].ways[1], edges[after].ways[0]);
            angle[after] = 180.0 - come.perp(&go).atan2(come.dot(&go)).to_degrees();
        }
        let boxes = spans.iter().map(|&(first, n)| around(&edges[first..first + n])).collect();
        let mut sheet = Sheet {
            next,
            angle,
            image: Vec::new(),
            alike: Vec::new(),
            edges,
            boxes,
            block: blocks(pieces),
            unfolded: pieces.iter().map(|p| p.outer.edges.iter().any(|e| e.name.ends_with("_m"))).collect(),
            spans,
        };
        sheet.alike = sheet.equals();
        sheet.image = sheet.images();
        sheet
    }

    /// How the edges of a piece lie on those of another that is moved, or mirrored as well: the
    /// other's edge for each.
    fn laid(&self, i: usize, j: usize, mirrored: bool) -> Option<Vec<usize>> {
        let ((first, n), (other, m)) = (self.spans[i], self.spans[j]);
        let to = |p: Point2| if mirrored { Point2::new(-p.x, p.y) } else { p };
        let number = |k: usize, s: usize| other + if mirrored { (s + m - k) % m } else { (s + k) % m };
        let fits = |s: &usize| {
            let place =
                |e: usize, at: usize| to(self.edges[e].points[if mirrored { PARTS - at } else { at }]);
            let by = self.edges[first].points[0] - place(number(0, *s), 0);
            (0..n).all(|k| {
                let (a, b) = (first + k, number(k, *s));
                let near = |at: usize| (self.edges[a].points[at] - place(b, at) - by).norm() <= SAME;
                near(0) && (1..PARTS).step_by(4).all(near)
            })
        };
        let shift = if n == m { (0..m).find(fits) } else { None };
        shift.map(|s| (0..n).map(|k| number(k, s)).collect())
    }

    fn equals(&self) -> Vec<usize> {
        let mut out: Vec<usize> = (0..self.edges.len()).collect();
        for i in 0..self.spans.len() {
            let same = (0..i).find_map(|j| self.laid(i, j, false));
            for (k, e) in same.into_iter().flatten().enumerate() {
                out[self.spans[i].0 + k] = out[e];
            }
        }
        out
    }

    /// The images: in another piece that is the mirror image of this one, or in the piece itself
    /// where it is symmetric and the only one of its form.
    fn images(&self) -> Vec<Option<usize>> {
        let mut out: Vec<Option<usize>> = vec![None; self.edges.len()];
        let copies = |i: usize| {
            let own = self.alike.get(self.spans[i].0).copied();
            let piece = own.map(|e| self.edges[e].piece);
            let is = |j: &usize| {
                self.alike.get(self.spans[*j].0).map(|e| self.edges[*e].piece) == piece && piece.is_some()
            };
            (0..self.spans.len()).filter(is).count()
        };
        let mut paired = vec![false; self.spans.len()];
        for i in 0..self.spans.len() {
            if paired[i] || self.spans[i].1 == 0 {
                continue;
            }
            if let Some(own) = self.laid(i, i, true) {
                paired[i] = true;
                if copies(i) == 1 {
                    own.iter().enumerate().for_each(|(k, e)| out[self.spans[i].0 + k] = Some(*e));
                }
                continue;
            }
            let twin = (i + 1..self.spans.len()).filter(|j| !paired[*j]);
            let found = twin.into_iter().find_map(|j| Some((j, self.laid(i, j, true)?)));
            if let Some((j, edges)) = found {
                (paired[i], paired[j]) = (true, true);
                for (k, e) in edges.into_iter().enumerate() {
                    out[self.spans[i].0 + k] = Some(e);
                    out[e] = Some(self.spans[i].0 + k);
                }
            }
        }
        out
    }

    /// The height of the middle of an edge over the foot of its piece, and below its top.
    pub(super) fn heights(&self, e: usize) -> [f64; 2] {
        let [low, high] = self.boxes[self.edges[e].piece];
        let y = (self.edges[e].points[0].y + self.edges[e].points[PARTS].y) / 2.0;
        [y - low.y, high.y - y]
    }

    /// How many times a piece is longer than wide.
    pub(super) fn slender(&self, piece: usize) -> f64 {
        let [low, high] = self.boxes[piece];
        let (w, h) = ((high.x - low.x).max(1e-6), (high.y - low.y).max(1e-6));
        (w / h).max(h / w).min(1e3)
    }
}

/// For every piece the first one of which it is a copy.
fn blocks(pieces: &[Piece]) -> Vec<usize> {
    // As `copies` names them: `NAME_mirrored`, `NAME_2`, `NAME_mirrored_2`.
    let plain = |name: &str| {
        let numbered = name.rsplit_once('_').filter(|(_, n)| n.bytes().all(|b| b.is_ascii_digit()));
        let name = numbered.map_or(name, |(n, _)| n);
        name.strip_suffix("_mirrored").unwrap_or(name).to_owned()
    };
    let names: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    let first = |i: usize| {
        let drawn = plain(names[i]);
        // A name that only looks like a copy's is none.
        names.iter().position(|n| *n == drawn).unwrap_or(i)
    };
    (0..pieces.len()).map(first).collect()
}

fn around(edges: &[Edge]) -> [Point2; 2] {
    let all = edges.iter().flat_map(|e| &e.points);
    all.fold([Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)], |[a, b], p| {
        [a.inf(p), b.sup(p)]
    })
}

fn edge(piece: usize, p: &Piece, number: usize) -> Edge {
    let path = p.outer.path(number);
    let length = path.length();
    let points: Vec<Point2> = (0..=PARTS).map(|k| path.at(length * k as f64 / PARTS as f64)).collect();
    let unit = |a: Point2, b: Point2| (b - a).try_normalize(1e-9).unwrap_or_default();
    let tip = TIP.min(length / 3.0);
    let way = unit(points[0], points[PARTS]);
    let on = p.notches.iter().filter(|m| m.edge == p.outer.edges[number].name).map(|m| m.along);
    Edge {
        piece,
        number,
        length,
        out: Vector2::new(way.y, -way.x),
        ways: [unit(points[0], path.at(tip)), unit(path.at(length - tip), points[PARTS])],
        notches: on.filter(|n| *n > AT_END && *n < length - AT_END).collect(),
        points,
    }
}

/// How far two edges of one length are from lying on each other, one run through backwards, as a
/// share of their length: the pieces side by side, and one of them turned over.
pub(super) fn apart(a: &Edge, b: &Edge) -> [f64; 2] {
    // The points of an edge seen along the line from its end to end, the length 1.
    let seen = |e: &Edge| -> Vec<Vector2> {
        let length = e.length.max(1e-9);
        let along = (e.points[PARTS] - e.points[0]).try_normalize(1e-9).unwrap_or(Vector2::x());
        let rel = e.points.iter().map(|p| (p - e.points[0]) / length);
        rel.map(|v| Vector2::new(v.dot(&along), along.perp(&v))).collect()
    };
    let (x, y) = (seen(a), seen(b));
    let chord = y[PARTS].x;
    let far = |f: &dyn Fn(Vector2) -> Vector2| {
        (0..=PARTS).map(|k| (x[k] - f(y[PARTS - k])).norm()).fold(0.0, f64::max)
    };
    [far(&|v| Vector2::new(chord - v.x, -v.y)), far(&|v| Vector2::new(chord - v.x, v.y))]
}

/// How far an edge bulges out of its piece, as a share of its length; below 0 where it is hollow.
pub(super) fn bulge(e: &Edge) -> f64 {
    let aside = e.points.iter().map(|p| (p - e.points[0]).dot(&e.out) / e.length.max(1e-9));
    aside.fold(0.0, |far: f64, d| if d.abs() > far.abs() { d } else { far })
}

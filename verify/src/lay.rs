//! Panels laid on the pieces of a pattern.
//!
//! Method: a panel whose name is a piece's, and whose outline lies on it, stays where it is.
//! Otherwise both outlines are walked in equal parts; for each start the best turn and shift are
//! known in closed form (Procrustes, two dimensions), and the best starts are refined by closest
//! points (Besl, McKay 1992). Where several pieces or turns fit alike (left and right, a
//! rectangle), those are taken that bring the ends of the seams nearest together in space. Cost:
//! about a millisecond a panel and piece. Limits: panels are not mirrored one by one; a panel of
//! another shape than every piece is not laid.

use crate::laid::{ByPiece, Laid};
use crate::limits::CheckLimits;
use crate::{loops, seams};
use nalgebra::{Isometry2, Translation2, UnitComplex, Vector2};
use rayon::prelude::*;
use toile_core::artifact::{Garment, Pattern, Piece, Point2, polyline_length};

/// Parts in which an outline is walked.
const PARTS: usize = 96;
/// Steps by closest points.
const STEPS: usize = 20;
/// A panel may lie on a piece that its outline leaves by no more than this, metres.
const ALIKE: f64 = 5e-3;
/// How often other pieces and turns are tried.
const ROUNDS: usize = 8;
/// Every so many points of a piece's outline are looked at.
const EVERY: usize = 4;
/// Outlines in equal parts that stay so far apart, in the mean, are not of one shape, metres.
const UNLIKE: f64 = 0.03;
/// Outlines whose lengths differ by this share are not of one shape.
const LENGTHS: f64 = 0.05;

/// A piece's outline as points, and where its corners are among them.
struct PieceOutline {
    points: Vec<Point2>,
    corners: Vec<usize>,
    /// Corners and every few points between.
    few: Vec<Point2>,
}

impl PieceOutline {
    fn of(piece: &Piece) -> Self {
        let (points, corners) = piece.outer.points();
        let is_kept = |k: &usize| k.is_multiple_of(EVERY) || corners.contains(k);
        let few = (0..points.len()).filter(is_kept).map(|k| points[k]).collect();
        Self { points, corners, few }
    }
}

/// Each panel on its piece, in the order of the panels; none where no piece fits.
#[must_use]
pub fn lay(garment: &Garment, pattern: &Pattern, limits: &CheckLimits) -> Vec<Option<Laid>> {
    let outlines: Vec<PieceOutline> = pattern.pieces.iter().map(PieceOutline::of).collect();
    let candidates: Vec<Vec<Laid>> = (0..garment.panels.len())
        .into_par_iter()
        .map(|k| candidates(garment, k, pattern, &outlines, limits))
        .collect();
    let search = LaySearch { garment, pattern, candidates: &candidates };
    let mut chosen = search.grown();
    search.improve(&mut chosen);
    let pick = |(k, c): (usize, &Option<usize>)| c.map(|c| candidates[k][c].clone());
    chosen.iter().enumerate().map(pick).collect()
}

/// Where a panel fits, best first.
fn candidates(
    garment: &Garment,
    panel: usize,
    pattern: &Pattern,
    outlines: &[PieceOutline],
    limits: &CheckLimits,
) -> Vec<Laid> {
    let own = &garment.panels[panel];
    let flat: Vec<Point2> = own.boundary.iter().map(|v| garment.rest[*v as usize]).collect();
    if flat.len() < 3 {
        return Vec::new();
    }
    let rings = loops::of_panel(garment, panel).len();
    let laid = |piece: usize, to: Isometry2<f64>| {
        let placed: Vec<Point2> = flat.iter().map(|p| to * p).collect();
        let deviation = deviation(&placed, &outlines[piece]);
        let edges = edges(&placed, &own.boundary, &outlines[piece]);
        let holes = rings.saturating_sub(1 + pattern.pieces[piece].holes.len());
        Laid { piece, to, deviation, edges, holes }
    };
    let named = pattern.pieces.iter().position(|p| alike(&p.name, &own.name));
    if let Some(here) = named.map(|piece| laid(piece, Isometry2::identity()))
        && here.deviation <= limits.outline
    {
        return vec![here];
    }
    let fit = |piece: usize| turns(&flat, &outlines[piece].few).into_iter().map(move |to| (piece, to));
    let tried = (0..outlines.len()).filter(|k| named.is_none_or(|n| n == *k));
    let mut all: Vec<Laid> = tried.flat_map(fit).map(|(piece, to)| laid(piece, to)).collect();
    all.retain(|l| l.deviation <= ALIKE);
    all.sort_by(|a, b| a.deviation.total_cmp(&b.deviation));
    all
}

/// Whether a mesh and a piece have one name; exporters replace blanks and add numbers.
fn alike(piece: &str, mesh: &str) -> bool {
    let plain =
        |s: &str| s.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect::<String>();
    plain(piece) == plain(mesh)
}

/// Turns and shifts that bring one closed outline near another.
fn turns(flat: &[Point2], piece: &[Point2]) -> Vec<Isometry2<f64>> {
    let (p, q) = (walked(flat), walked(piece));
    let length = |ring: &[Point2]| polyline_length(ring);
    if (length(&p) / length(&q) - 1.0).abs() > LENGTHS {
        return Vec::new();
    }
    let centre = |ring: &[Point2]| ring.iter().map(|p| p.coords).sum::<Vector2<f64>>() / ring.len() as f64;
    let (cp, cq) = (centre(&p), centre(&q));
    let spin = |start: usize| {
        (0..PARTS).fold((0.0, 0.0), |(along, across), i| {
            let (u, v) = (p[i].coords - cp, q[(i + start) % PARTS].coords - cq);
            (along + u.dot(&v), across + u.perp(&v))
        })
    };
    let spins: Vec<(f64, f64)> = (0..PARTS).map(spin).collect();
    let score: Vec<f64> = spins.iter().map(|s| s.0.hypot(s.1)).collect();
    let spread =
        |ring: &[Point2], c: Vector2<f64>| ring.iter().map(|p| (p.coords - c).norm_squared()).sum::<f64>();
    let apart = |k: usize| (spread(&p, cp) + spread(&q, cq) - 2.0 * score[k]).max(0.0) / PARTS as f64;
    let is_peak = |k: &usize| {
        let (before, after) = (score[(k + PARTS - 1) % PARTS], score[(k + 1) % PARTS]);
        score[*k] >= before && score[*k] > after && apart(*k) <= UNLIKE * UNLIKE
    };
    let placed = |k: usize| {
        let turn = UnitComplex::new(spins[k].1.atan2(spins[k].0));
        refined(Isometry2::from_parts(Translation2::from(cq - turn * cp), turn), &p, piece)
    };
    (0..PARTS).filter(is_peak).map(placed).collect()
}

/// Points at equal lengths along a closed outline.
fn walked(ring: &[Point2]) -> Vec<Point2> {
    let closed: Vec<Point2> = ring.iter().chain(ring.first()).copied().collect();
    let step = polyline_length(&closed) / PARTS as f64;
    let (mut points, mut done) = (Vec::with_capacity(PARTS), 0.0);
    for w in closed.windows(2) {
        let length = (w[1] - w[0]).norm();
        while points.len() < PARTS && points.len() as f64 * step <= done + length {
            let share = if length > 0.0 { (points.len() as f64 * step - done) / length } else { 0.0 };
            points.push(w[0] + (w[1] - w[0]) * share);
        }
        done += length;
    }
    while points.len() < PARTS {
        points.push(closed[closed.len() - 1]);
    }
    points
}

/// The turn and shift after some steps by closest points.
fn refined(mut to: Isometry2<f64>, from: &[Point2], piece: &[Point2]) -> Isometry2<f64> {
    for _ in 0..STEPS {
        let pairs: Vec<(Point2, Point2)> = from.iter().map(|p| (*p, closest(&(to * p), piece))).collect();
        let n = pairs.len() as f64;
        let (cp, cq) = pairs.iter().fold((Vector2::zeros(), Vector2::zeros()), |(a, b), (p, q)| {
            (a + p.coords / n, b + q.coords / n)
        });
        let (along, across) = pairs.iter().fold((0.0, 0.0), |(along, across), (p, q)| {
            let (u, v) = (p.coords - cp, q.coords - cq);
            (along + u.dot(&v), across + u.perp(&v))
        });
        let turn = UnitComplex::new(f64::atan2(across, along));
        to = Isometry2::from_parts(Translation2::from(cq - turn * cp), turn);
    }
    to
}

/// The point of a closed outline that is closest.
fn closest(p: &Point2, ring: &[Point2]) -> Point2 {
    let mut best = (f64::INFINITY, *p);
    for k in 0..ring.len() {
        let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
        let (way, length) = (b - a, (b - a).norm_squared());
        let share = if length > 0.0 { ((p - a).dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
        let q = a + way * share;
        let far = (p - q).norm_squared();
        if far < best.0 {
            best = (far, q);
        }
    }
    best.1
}

/// The farthest that either of two closed outlines is from the other, metres.
fn deviation(placed: &[Point2], outline: &PieceOutline) -> f64 {
    let to = |p: &Point2, ring: &[Point2]| (p - closest(p, ring)).norm();
    let out = placed.iter().map(|p| to(p, &outline.points)).fold(0.0, f64::max);
    outline.few.iter().map(|p| to(p, placed)).fold(out, f64::max)
}

/// The vertices along each edge: between those that are nearest to its ends.
fn edges(placed: &[Point2], vertices: &[u32], outline: &PieceOutline) -> Vec<Vec<u32>> {
    let nearest = |c: &Point2| {
        let far = |k: &usize| (placed[*k] - c).norm_squared();
        (0..placed.len()).reduce(|a, b| if far(&b) < far(&a) { b } else { a }).unwrap_or(0)
    };
    let ends: Vec<usize> = outline.corners.iter().map(|c| nearest(&outline.points[*c])).collect();
    let n = vertices.len();
    let chain = |k: usize| {
        let (from, to) = (ends[k], ends[(k + 1) % ends.len()]);
        let steps = if ends.len() == 1 { n } else { (to + n - from) % n };
        (0..=steps).map(|s| vertices[(from + s) % n]).collect()
    };
    (0..ends.len()).map(chain).collect()
}

/// For each panel which of its candidates is taken.
type Choice = Vec<Option<usize>>;

/// The search among several ways that fit.
struct LaySearch<'a> {
    garment: &'a Garment,
    pattern: &'a Pattern,
    candidates: &'a [Vec<Laid>],
}

impl LaySearch<'_> {
    fn apart(&self, chosen: &Choice) -> (f64, usize) {
        let of =
            |(k, c): (usize, &Option<usize>)| c.map(|c| &self.candidates[k][c]).map(|l| (l.piece, (k, l)));
        let laid: ByPiece<'_> = chosen.iter().enumerate().filter_map(of).collect();
        seams::ends_apart(self.garment, self.pattern, &laid)
    }

    fn piece(&self, chosen: &Choice, panel: usize) -> Option<usize> {
        chosen[panel].map(|c| self.candidates[panel][c].piece)
    }

    /// The open panels' candidates on pieces that are free.
    fn free(&self, chosen: &Choice) -> Vec<(usize, usize)> {
        let taken: Vec<Option<usize>> = (0..chosen.len()).map(|k| self.piece(chosen, k)).collect();
        let open = (0..chosen.len()).filter(|k| chosen[*k].is_none());
        let of = |k: usize| (0..self.candidates[k].len()).map(move |i| (k, i));
        open.flat_map(of).filter(|(k, i)| !taken.contains(&Some(self.candidates[*k][*i].piece))).collect()
    }

    /// All panels, laid one after another: the first is one that fits in the fewest ways, in each
    /// of them; the next is always the one whose seams with those before are nearest to closed.
    fn grown(&self) -> Choice {
        let none: Choice = vec![None; self.candidates.len()];
        let ways = |k: &usize| self.candidates[*k].len();
        let first = (0..none.len()).filter(|k| ways(k) > 0).min_by_key(ways);
        let Some(first) = first else { return none };
        let from = |i: usize| {
            let mut chosen = none.clone();
            chosen[first] = Some(i);
            self.grow(&mut chosen);
            (self.apart(&chosen).0, chosen)
        };
        let all = (0..self.candidates[first].len()).map(from);
        all.reduce(|a, b| if b.0 < a.0 { b } else { a }).map_or(none, |best| best.1)
    }

    fn grow(&self, chosen: &mut Choice) {
        loop {
            let free = self.free(chosen);
            let (far, seams) = self.apart(chosen);
            let mean = |&(k, i): &(usize, usize)| {
                let mut tried = chosen.clone();
                tried[k] = Some(i);
                let (sum, count) = self.apart(&tried);
                // Panels that no seam joins to those before come last, the best fit first.
                match count > seams {
                    true => (0, (sum - far) / (count - seams) as f64),
                    false => (1, self.candidates[k][i].deviation),
                }
            };
            let scored = free.iter().map(|c| (mean(c), *c));
            let nearer = |a: &(u8, f64), b: &(u8, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).is_lt();
            let Some((_, (k, i))) = scored.reduce(|a, b| if nearer(&b.0, &a.0) { b } else { a }) else {
                return;
            };
            chosen[k] = Some(i);
        }
    }

    /// Takes other pieces and turns as long as the ends of the seams come nearer together.
    fn improve(&self, chosen: &mut Choice) {
        if self.candidates.iter().all(|c| c.len() < 2) {
            return;
        }
        let mut least = self.apart(chosen).0;
        for _ in 0..ROUNDS {
            let before = least;
            for k in 0..self.candidates.len() {
                for i in 0..self.candidates[k].len() {
                    for tried in self.exchanges(chosen, k, i) {
                        let far = self.apart(&tried).0;
                        if far < least - 1e-9 {
                            (least, *chosen) = (far, tried);
                        }
                    }
                }
            }
            if least >= before {
                return;
            }
        }
    }

    /// The choices in which panel `k` lies as its candidate `i` says; who had that piece before
    /// takes the one that `k` had, in each way that fits.
    fn exchanges(&self, chosen: &Choice, k: usize, i: usize) -> Vec<Choice> {
        let piece = self.candidates[k][i].piece;
        let had = self.piece(chosen, k);
        let mut one = chosen.clone();
        one[k] = Some(i);
        let other = (0..chosen.len()).find(|o| *o != k && self.piece(chosen, *o) == Some(piece));
        let Some(other) = other else {
            // A panel that is taken off its piece for a free one leaves seams open that count no
            // more.
            return if had.is_none_or(|h| h == piece) { vec![one] } else { Vec::new() };
        };
        let swap = |(j, l): (usize, &Laid)| {
            (Some(l.piece) == had).then(|| {
                let mut both = one.clone();
                both[other] = Some(j);
                both
            })
        };
        self.candidates[other].iter().enumerate().filter_map(swap).collect()
    }
}

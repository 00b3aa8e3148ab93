//! Where the edges of a form begin and end on one half of an outline.
//!
//! Method: of all ways to cut the half into the form's edges, in their order, that with the least
//! sum of squares is found by dynamic programming (Bellman 1961): each edge is the cubic bow that
//! fits its stretch best, and what it misses and how unusual it is count. Far-off points count no
//! more than three spreads, so that folds and rags shift no corner. Cost: the square of the number
//! of points, a few milliseconds. Limits: corners lie on points of the outline; the fit to the
//! whole moves them.

use crate::style::block::template::bow::{Bow, basis};
use crate::style::block::template::form::{EdgeForm, Form};
use toile_core::artifact::Point2;

/// Spread of an outline about its template, as a share of the garment's size.
pub(crate) const SPREAD: f64 = 0.008;
/// What one point adds at most, in squared spreads.
const MOST: f64 = 9.0;
/// Weight of a belief beside the points of the outline, of which a half has about a hundred.
const BELIEF: f64 = 4.0;
/// A sum of squares that no cut reaches.
pub(crate) const NEVER: f64 = 1e12;

/// A half of an outline, cut.
#[derive(Debug, Clone)]
pub(crate) struct Cut {
    /// The edges.
    pub edges: Vec<Bow>,
    /// The sum of squares.
    pub cost: f64,
}

/// The best cut of a half whose points are evenly spaced; `size` is the garment's. `None` where the
/// form's edges do not fit at all.
pub(crate) fn cut(points: &[Point2], form: &Form, size: f64) -> Option<Cut> {
    let (n, edges) = (points.len(), form.edges.len());
    let mut best = vec![vec![(NEVER, 0_usize); n]; edges + 1];
    best[0][0] = (0.0, 0);
    for (k, e) in form.edges.iter().enumerate() {
        let last = k + 1 == edges;
        for j in if last { n - 1..n } else { 1..n } {
            for i in 0..j {
                let before = best[k][i].0;
                if before >= best[k + 1][j].0 {
                    continue;
                }
                let cost = before + price(&points[i..=j], e, size, best[k + 1][j].0 - before).1;
                if cost < best[k + 1][j].0 {
                    best[k + 1][j] = (cost, i);
                }
            }
        }
    }
    let cost = best[edges][n - 1].0;
    if cost >= NEVER {
        return None;
    }
    let mut at = n - 1;
    let mut found = Vec::with_capacity(edges);
    for k in (0..edges).rev() {
        let from = best[k + 1][at].1;
        let bow = price(&points[from..=at], &form.edges[k], size, NEVER).0;
        found.push(Bow { a: points[from], b: points[at], bow });
        at = from;
    }
    found.reverse();
    Some(Cut { edges: found, cost })
}

/// How unusual the chord of an edge is.
pub(crate) fn belief(e: &EdgeForm, a: Point2, b: Point2, size: f64) -> f64 {
    let d = b - a;
    let share = d.norm() / size;
    if share < e.chord[0] || share > e.chord[1] {
        return NEVER;
    }
    let off = (d.y.atan2(d.x).to_degrees() - e.way[0] + 540.0).rem_euclid(360.0) - 180.0;
    BELIEF * (off / e.way[1]).powi(2)
}

/// The bow that fits a stretch best, and what it costs; a cost above `most` need not be exact.
fn price(points: &[Point2], e: &EdgeForm, size: f64, most: f64) -> ([f64; 2], f64) {
    let (a, b) = (points[0], points[points.len() - 1]);
    let chord = belief(e, a, b, size);
    if chord >= most {
        return ([0.0; 2], NEVER);
    }
    let d = b - a;
    let length = d.norm();
    let unit = d / length;
    let local = |p: &Point2| ((p - a).dot(&unit) / length, unit.perp(&(p - a)));
    let spread = SPREAD * size;
    // Normal equations of two bows, with the belief as a ridge.
    let ridge = 1.0 / (e.bow[1] * e.bow[1]);
    let (mut m, mut r) = ([ridge, 0.0, ridge], [ridge * e.bow[0]; 2]);
    let scale = length / spread;
    for p in points {
        let (t, off) = local(p);
        let [u, v] = basis(t.clamp(0.0, 1.0)).map(|x| x * scale);
        let y = off / spread;
        m[0] += u * u;
        m[1] += u * v;
        m[2] += v * v;
        r[0] += u * y;
        r[1] += v * y;
    }
    let det = m[0] * m[2] - m[1] * m[1];
    let bow = [(r[0] * m[2] - r[1] * m[1]) / det, (m[0] * r[1] - m[1] * r[0]) / det];
    let mut cost = chord + bow.iter().map(|x| ((x - e.bow[0]) / e.bow[1]).powi(2)).sum::<f64>();
    for p in points {
        let (t, off) = local(p);
        let inside = t.clamp(0.0, 1.0);
        let [u, v] = basis(inside);
        let miss = ((off - length * (u * bow[0] + v * bow[1])) / spread).powi(2)
            + ((t - inside) * length / spread).powi(2);
        cost += miss.min(MOST);
        if cost >= most {
            return (bow, NEVER);
        }
    }
    (bow, cost)
}

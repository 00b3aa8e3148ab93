//! Half and quarter pieces unfolded at the lines where they lie on a fold of the cloth.

use super::side::{CORNER, Side, points, smooth};
use toile_core::prelude::*;

/// An edge lies on the line to this, metres.
const ON: f64 = 1e-3;
/// How far a ring that is cut open gapes on either side, metres.
const GAPE: f64 = 2.5e-4;

/// The line at which a piece is mirrored, through two points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fold {
    pub at: Point2,
    pub way: Vector2,
}

/// A loop that was unfolded.
#[derive(Debug)]
pub(super) struct Unfolded {
    pub sides: Vec<Side>,
    /// The two edges along which a ring lies open, where it is one.
    pub open: Vec<[String; 2]>,
}

/// The word behind the name of what is the image at the first fold, at the second, ...
pub(super) fn image_word(fold: usize) -> String {
    if fold == 0 { "_m".to_owned() } else { format!("_m{}", fold + 1) }
}

/// The folds of a piece: no two of them on one line.
pub(super) fn distinct<T>(folds: impl IntoIterator<Item = (Fold, T)>) -> Vec<(Fold, T)> {
    let mut out: Vec<(Fold, T)> = Vec::new();
    for (fold, with) in folds {
        let same = |o: &(Fold, T)| o.0.way.perp(&fold.way).abs() < 0.02 && o.0.distance(fold.at) <= 2.0 * ON;
        if !out.iter().any(same) {
            out.push((fold, with));
        }
    }
    out
}

/// The remark on a ring that lies open along two edges.
pub(super) fn open_ring(piece: &str, [a, b]: &[String; 2]) -> String {
    format!(
        "piece \"{piece}\" is a ring when both its folds are unfolded: it is cut open along one, to be closed by a seam of \"{a}\" and \"{b}\""
    )
}

impl Fold {
    /// None where the points are one.
    pub(super) fn through(a: Point2, b: Point2) -> Option<Self> {
        Some(Fold { at: a, way: (b - a).try_normalize(1e-9)? })
    }

    fn foot(&self, p: Point2) -> Point2 {
        self.at + self.way * (p - self.at).dot(&self.way)
    }

    fn distance(&self, p: Point2) -> f64 {
        (p - self.foot(p)).norm()
    }

    /// The image of a point.
    pub(super) fn mirror(&self, p: Point2) -> Point2 {
        let foot = self.foot(p);
        foot + (foot - p)
    }

    pub(super) fn has(&self, p: Point2) -> bool {
        self.distance(p) <= ON
    }

    /// Whether an edge of the loop lies on the line.
    pub(super) fn holds(&self, sides: &[Side]) -> bool {
        sides.iter().any(|s| self.carries(s))
    }

    fn carries(&self, side: &Side) -> bool {
        side.points().iter().all(|p| self.has(*p))
    }

    /// The runs of edges that lie on the line, each as the number of its first edge and of edges.
    fn runs(&self, sides: &[Side]) -> Vec<(usize, usize)> {
        let n = sides.len();
        let on: Vec<bool> = sides.iter().map(|s| self.carries(s)).collect();
        let first = |k: &usize| on[*k] && !on[(*k + n - 1) % n];
        let count = |k: usize| (0..n).take_while(|i| on[(k + i) % n]).count();
        (0..n).filter(first).map(|k| (k, count(k))).collect()
    }

    /// The whole loop of a half that has edges on the line; an edge that runs smoothly into its
    /// image becomes one with it. `word` stands behind the names of images. Where the half meets
    /// the line at two places the whole is a ring: it is unfolded where the fold is drawn and cut
    /// open at the others. None where no edge lies on the line.
    pub(super) fn unfolded(&self, sides: &[Side], word: &str) -> Option<Unfolded> {
        let n = sides.len();
        let runs = self.runs(sides);
        let far = |&(k, count): &(usize, usize)| {
            let middle = nalgebra::center(&sides[k].start, &sides[(k + count - 1) % n].end());
            (middle - self.at).norm()
        };
        let fold = *runs.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let mut sides = sides.to_vec();
        let slits: Vec<usize> = runs
            .iter()
            .filter(|r| **r != fold)
            .flat_map(|&(k, count)| (k..k + count).map(|i| i % n))
            .collect();
        let open =
            slits.iter().map(|&k| [sides[k].name.clone(), format!("{}{word}", sides[k].name)]).collect();
        self.gape(&mut sides, &slits);
        let m = n.checked_sub(fold.1).filter(|m| *m > 0)?;
        let mut half: Vec<Side> = (0..m).map(|k| sides[(fold.0 + fold.1 + k) % n].clone()).collect();
        // Its ends to the last bit on the line, so that the images meet them.
        if let Some(s) = half.first_mut() {
            s.start = self.foot(s.start);
        }
        if let Some(s) = half.last_mut() {
            s.end_at(self.foot(s.end()));
        }
        let image = |s: &Side| Side {
            name: format!("{}{word}", s.name),
            ..s.moved(|p| self.mirror(p), true).turned()
        };
        let whole: Vec<Side> = half.iter().cloned().chain(half.iter().rev().map(image)).collect();
        // The last side of the half meets its image, and the first one's image the first.
        let goes_on = |one: &Side, other: &Side| smooth(one, other, 2.0 * CORNER);
        let (middle, around) =
            (goes_on(whole.get(m - 1)?, whole.get(m)?), goes_on(whole.last()?, whole.first()?));
        let mut out: Vec<Side> = Vec::new();
        for (k, side) in whole.iter().enumerate() {
            match k {
                _ if k == m && middle => {
                    let before = out.pop()?;
                    out.push(before.joined(side));
                }
                _ if k == 2 * m - 1 && around && out.len() > 1 => {
                    out[0] = Side { name: out[0].name.clone(), ..side.joined(&out[0]) }
                }
                _ => out.push(side.clone()),
            }
        }
        (out.len() >= 2).then_some(Unfolded { sides: out, open })
    }

    /// Moves sides that lie on the line slightly away from it, to the side of the others.
    fn gape(&self, sides: &mut [Side], slits: &[usize]) {
        let n = sides.len();
        let across = Vector2::new(-self.way.y, self.way.x);
        let inside: f64 = points(sides).iter().map(|p| (p - self.at).dot(&across)).sum();
        let away = across * (GAPE * inside.signum());
        for &k in slits {
            sides[k] = sides[k].moved(|p| p + away, false);
            let (start, end) = (sides[k].start, sides[k].end());
            let (before, after) = ((k + n - 1) % n, (k + 1) % n);
            if !slits.contains(&before) {
                sides[before].end_at(start);
            }
            if !slits.contains(&after) {
                sides[after].start = end;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::side::split;
    use super::*;

    fn p(x: f64, y: f64) -> Point2 {
        Point2::new(x, y)
    }

    fn fold(a: Point2, b: Point2) -> Fold {
        Fold::through(a, b).unwrap()
    }

    /// A quarter of a ring about the origin, 0.1 to 0.5 m, counter-clockwise.
    fn quarter() -> Vec<Side> {
        let arc = |end, sign: f64| (EdgeCurve::Arc { bulge: sign * (std::f64::consts::PI / 8.0).tan() }, end);
        let parts = [
            (EdgeCurve::Line, p(0.5, 0.0)),
            arc(p(0.0, 0.5), 1.0),
            (EdgeCurve::Line, p(0.0, 0.1)),
            arc(p(0.1, 0.0), -1.0),
        ];
        split(p(0.1, 0.0), &parts)
    }

    #[test]
    fn a_quarter_of_a_ring_on_two_folds_becomes_a_ring_that_is_open_at_one_place() {
        let half = fold(p(0.0, 0.1), p(0.0, 0.5)).unfolded(&quarter(), "_m").unwrap();
        assert!(half.open.is_empty());
        let ring = fold(p(0.1, 0.0), p(0.5, 0.0)).unfolded(&half.sides, "_m2").unwrap();
        let [[a, b]] = &ring.open[..] else { unreachable!("{:?}", ring.open) };
        let side = |name: &String| ring.sides.iter().find(|s| s.name == *name).unwrap();
        assert!((side(a).start - side(b).end()).norm() < 1e-3 && (side(a).length() - 0.4).abs() < 1e-6);
        assert_eq!(ring.sides.len(), 4);
        let area = polygon_area(&points(&ring.sides)).abs();
        assert!((area - 0.24 * std::f64::consts::PI).abs() < 5e-4, "{area}");
    }

    #[test]
    fn a_quarter_of_a_rectangle_on_two_folds_becomes_the_whole() {
        let lines = [p(0.3, 0.0), p(0.3, 0.2), p(0.0, 0.2), p(0.0, 0.0)].map(|q| (EdgeCurve::Line, q));
        let quarter = split(p(0.0, 0.0), &lines);
        let half = fold(p(0.0, 0.0), p(0.0, 0.2)).unfolded(&quarter, "_m").unwrap();
        let whole = fold(p(0.0, 0.0), p(0.3, 0.0)).unfolded(&half.sides, "_m2").unwrap();
        assert!((polygon_area(&points(&whole.sides)).abs() - 0.24).abs() < 1e-9);
        assert_eq!((whole.sides.len(), whole.open.len()), (4, 0));
    }
}

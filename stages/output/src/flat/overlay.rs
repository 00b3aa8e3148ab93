//! How far two outlines are from each other, laid over each other as well as can be.
//!
//! Method: iterated closest points (Besl and McKay 1992): each point of the one looks for its
//! nearest point on the other, then the best turn and shift is made, until it stays. Of four
//! starts, each a quarter turn apart, the one is taken that is nearest after a few rounds with few
//! points. Cost: the product of the points, some thirty times. Limit: outlines that are far from
//! alike may end in a worse place.

use nalgebra::Rotation2;
use std::f64::consts::FRAC_PI_2;
use toile_core::prelude::*;

/// Rounds at most that choose the start.
const CHOOSING_ROUNDS: usize = 8;
/// Points of an outline, about, that choose the start.
const CHOOSING_POINTS: usize = 100;
/// Rounds at most from the chosen start to the end.
const ENDING_ROUNDS: usize = 60;
/// Points of an outline, about, from the chosen start to the end.
const ENDING_POINTS: usize = 400;
/// A round that improves the mean square by less than this share is the last.
const SETTLED: f64 = 1e-6;

/// Root mean square and greatest distance between two closed outlines, both ways; none of outlines
/// without points.
pub(super) fn outline_distance(one: &[Point2], other: &[Point2]) -> Option<(f64, f64)> {
    let (a, b) = (sampled(one, CHOOSING_POINTS)?, sampled(other, CHOOSING_POINTS)?);
    let starts = (0..4).map(|k| Rotation2::new(f64::from(k) * FRAC_PI_2));
    let rated = starts.map(|turn| (laid_over(&a, &b, turn, CHOOSING_ROUNDS).1, turn));
    let (_, turn) = rated.min_by(|x, y| x.0.total_cmp(&y.0))?;
    let (a, b) = (sampled(one, ENDING_POINTS)?, sampled(other, ENDING_POINTS)?);
    let (a, _) = laid_over(&a, &b, turn, ENDING_ROUNDS);
    let far =
        |from: &[Point2], to: &[Point2]| from.iter().map(|p| (p - nearest(p, to)).norm()).collect::<Vec<_>>();
    let all = [far(&a, &b), far(&b, &a)].concat();
    let squares: f64 = all.iter().map(|d| d * d).sum();
    Some(((squares / all.len() as f64).sqrt(), all.iter().fold(0.0, |m: f64, d| m.max(*d))))
}

/// Points after a turn, laid over others, and the sum of the squares of their distances.
fn laid_over(a: &[Point2], b: &[Point2], turn: Rotation2<f64>, rounds: usize) -> (Vec<Point2>, f64) {
    let (from, to) = (middle(a), middle(b));
    let mut a: Vec<Point2> = a.iter().map(|p| Point2::from(turn * (p.coords - from) + to)).collect();
    let mut before = f64::INFINITY;
    for _ in 0..rounds {
        let near: Vec<Point2> = a.iter().map(|p| nearest(p, b)).collect();
        let square = a.iter().zip(&near).map(|(p, q)| (p - q).norm_squared()).sum::<f64>();
        if square >= before * (1.0 - SETTLED) {
            break;
        }
        before = square;
        lay_over(&mut a, &near);
    }
    (a, before)
}

/// Corners and points between them, evenly along a closed outline.
fn sampled(outline: &[Point2], count: usize) -> Option<Vec<Point2>> {
    let next = |k: usize| outline[(k + 1) % outline.len()];
    let whole: f64 = (0..outline.len()).map(|k| (next(k) - outline[k]).norm()).sum();
    if !(whole > 0.0 && whole.is_finite()) {
        return None;
    }
    let step = whole / count as f64;
    let points = (0..outline.len()).flat_map(|k| {
        let (p, along) = (outline[k], next(k) - outline[k]);
        let n = (along.norm() / step).ceil().max(1.0) as usize;
        (0..n).map(move |i| p + along * (i as f64 / n as f64))
    });
    Some(points.collect())
}

fn middle(points: &[Point2]) -> Vector2 {
    points.iter().fold(Vector2::zeros(), |s, p| s + p.coords) / points.len().max(1) as f64
}

/// The nearest point on a closed outline.
fn nearest(p: &Point2, outline: &[Point2]) -> Point2 {
    let on = |k: usize| {
        let (a, along) = (outline[k], outline[(k + 1) % outline.len()] - outline[k]);
        let length = along.norm_squared();
        let t = if length > 0.0 { ((p - a).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
        a + along * t
    };
    let all = (0..outline.len()).map(on);
    all.min_by(|a, b| (a - p).norm_squared().total_cmp(&(b - p).norm_squared())).unwrap_or(*p)
}

/// The best turn and shift of points onto others (Kabsch 1976).
fn lay_over(points: &mut [Point2], onto: &[Point2]) {
    let (from, to) = (middle(points), middle(onto));
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (p, q) in points.iter().zip(onto) {
        let (p, q) = (p.coords - from, q.coords - to);
        cosine += p.dot(&q);
        sine += p.perp(&q);
    }
    let turn = Rotation2::new(f64::atan2(sine, cosine));
    points.iter_mut().for_each(|p| *p = Point2::from(turn * (p.coords - from) + to));
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn outline(points: &[[f64; 2]]) -> Vec<Point2> {
        points.iter().map(|p| Point2::new(p[0], p[1])).collect()
    }

    #[test]
    fn an_outline_that_is_turned_and_moved_is_the_same() {
        let piece = outline(&[[0.0, 0.0], [0.5, 0.0], [0.4, 0.6], [0.1, 0.6]]);
        for angle in [0.1, 1.7, 3.0, -1.2] {
            let turn = Rotation2::new(angle);
            let moved: Vec<Point2> = piece.iter().map(|p| turn * p + Vector2::new(3.0, -2.0)).collect();
            assert!(outline_distance(&piece, &moved).unwrap().1 < 1e-4, "{angle}");
        }
    }

    #[test]
    fn a_corner_that_was_drawn_out_is_seen() {
        let piece = outline(&[[0.0, 0.0], [0.5, 0.0], [0.5, 0.6], [0.0, 0.6]]);
        let mut longer = piece.clone();
        longer[2] += Vector2::new(0.004, 0.0);
        let (rms, most) = outline_distance(&piece, &longer).unwrap();
        assert!((0.002..0.004).contains(&most) && rms < most, "{rms} {most}");
        assert_eq!(outline_distance(&piece, &[]), None);
    }
}

//! An outline stood upright, and its two halves.

use crate::style::block::template::axis::Axis;
use nalgebra::Rotation2;
use toile_core::artifact::{Outline, Point2};

/// Points of a half.
pub(crate) const POINTS: usize = 100;

/// Rows of which the middles are taken.
const ROWS: usize = 60;

/// An upright outline with its halves.
#[derive(Debug, Clone)]
pub(crate) struct Upright {
    /// The outline: the points of both halves.
    pub points: Vec<Point2>,
    /// Each half from the axis below to the axis above, counter-clockwise, the left one seen in a
    /// mirror.
    pub halves: [Vec<Point2>; 2],
    /// The root of the area, metres.
    pub size: f64,
    /// Tilt of the axis in the photo, degrees.
    pub tilt: f64,
    /// Where the upright origin lies in the outline.
    pub centre: Point2,
    /// Which points lie where the frame cut the garment off; none where that is not asked for.
    pub unseen: Vec<bool>,
}

impl Upright {
    /// `None` for an outline without area, or that its axis does not cut.
    pub(crate) fn of(outline: &Outline) -> Option<Upright> {
        let axis = Axis::of(&outline.outer.points)?;
        let points: Vec<Point2> = outline.outer.points.iter().map(|p| axis.upright(*p)).collect();
        let mirrored: Vec<Point2> = points.iter().rev().map(|p| Point2::new(-p.x, p.y)).collect();
        let halves = [half(&points)?, half(&mirrored)?];
        let points = joined(&halves);
        let unseen = vec![false; points.len()];
        let Axis { size, tilt, centre } = axis;
        Some(Upright { points, halves, size, tilt, centre, unseen })
    }

    /// The same outline about the axis through the middles of most of its rows, which a sleeve that
    /// is hidden on one side does not move: the median of their places and slopes (Theil 1950, Sen
    /// 1968). `None` where that axis does not cut it.
    pub(crate) fn about_its_rows(&self) -> Option<Upright> {
        let middles = middles(&self.points);
        let slopes = middles.iter().enumerate().flat_map(|(i, p)| {
            let far = middles[i + 1..].iter().filter(move |q| q.y - p.y > 0.3 * self.size);
            far.map(move |q| (q.x - p.x) / (q.y - p.y))
        });
        let slope = median(slopes.collect())?;
        let place = median(middles.iter().map(|p| p.x - slope * p.y).collect())?;
        let turn = -slope.atan();
        let moved = |p: &Point2| Rotation2::new(-turn) * Point2::new(p.x - place, p.y);
        let points: Vec<Point2> = self.points.iter().map(moved).collect();
        let mirrored: Vec<Point2> = points.iter().rev().map(|p| Point2::new(-p.x, p.y)).collect();
        let halves = [half(&points)?, half(&mirrored)?];
        let points = joined(&halves);
        Some(Upright {
            unseen: vec![false; points.len()],
            points,
            halves,
            tilt: self.tilt + turn.to_degrees(),
            centre: self.given(Point2::new(place, 0.0)),
            size: self.size,
        })
    }

    /// The mirror image of the outline.
    pub(crate) fn mirrored(&self) -> Upright {
        let [right, left] = self.halves.clone();
        let halves = [left, right];
        // Both begin where the axis meets the outline below, and run the other way around.
        let n = self.points.len();
        let at = |k: usize| (n - k) % n;
        Upright {
            points: joined(&halves),
            unseen: (0..n).map(|k| self.unseen[at(k)]).collect(),
            tilt: -self.tilt,
            centre: Point2::new(-self.centre.x, self.centre.y),
            size: self.size,
            halves,
        }
    }

    /// A place of the outline as it was given, upright.
    pub(crate) fn stood(&self, p: Point2) -> Point2 {
        Point2::from(Rotation2::new(-self.tilt.to_radians()) * (p - self.centre))
    }

    /// A place of the upright outline in the outline as it was given.
    pub(crate) fn given(&self, p: Point2) -> Point2 {
        self.centre + (Rotation2::new(self.tilt.to_radians()) * p).coords
    }
}

/// The middles of the rows of a closed line, from below to above.
fn middles(points: &[Point2]) -> Vec<Point2> {
    let (low, high) =
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.y), b.max(p.y)));
    let n = points.len();
    let row = |k: usize| {
        let y = low + (high - low) * (k as f64 + 0.5) / ROWS as f64;
        let sides = (0..n).map(|i| (points[i], points[(i + 1) % n]));
        let crossings = sides
            .filter(|(a, b)| (a.y > y) != (b.y > y))
            .map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        let (left, right) =
            crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, r), x| (l.min(x), r.max(x)));
        (left <= right).then(|| Point2::new(0.5 * (left + right), y))
    };
    (0..ROWS).filter_map(row).collect()
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The stretch at positive u from the lowest to the highest crossing of the axis, evenly spaced.
fn half(points: &[Point2]) -> Option<Vec<Point2>> {
    let n = points.len();
    let crossing = |i: usize| {
        let (a, b) = (points[i], points[(i + 1) % n]);
        ((a.x > 0.0) != (b.x > 0.0)).then(|| (i, a + (b - a) * (a.x / (a.x - b.x))))
    };
    let crossings: Vec<(usize, Point2)> = (0..n).filter_map(crossing).collect();
    let height = |c: &&(usize, Point2), d: &&(usize, Point2)| c.1.y.total_cmp(&d.1.y);
    let (low, top) = (crossings.iter().min_by(height)?, crossings.iter().max_by(height)?);
    let count = (top.0 + n - low.0) % n;
    let inner = (1..=count).map(|k| points[(low.0 + k) % n]);
    let path: Vec<Point2> = std::iter::once(low.1).chain(inner).chain([top.1]).collect();
    let right = path.iter().filter(|p| p.x > 0.0).count();
    (2 * right > path.len()).then(|| even(&path, POINTS))
}

/// Both halves as one closed outline, so that its points on the axis (a crotch) are among it.
fn joined([right, left]: &[Vec<Point2>; 2]) -> Vec<Point2> {
    let back = left[1..left.len() - 1].iter().rev().map(|p| Point2::new(-p.x, p.y));
    right.iter().copied().chain(back).collect()
}

/// Evenly spaced points of a path, both ends included.
fn even(path: &[Point2], count: usize) -> Vec<Point2> {
    let mut along = vec![0.0];
    for w in path.windows(2) {
        along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
    }
    let total = along[along.len() - 1];
    let at = |k: usize| {
        let s = total * k as f64 / (count - 1) as f64;
        let i = along.partition_point(|a| *a < s).clamp(1, path.len() - 1);
        let piece = along[i] - along[i - 1];
        let t = if piece > 0.0 { (s - along[i - 1]) / piece } else { 0.0 };
        path[i - 1] + (path[i] - path[i - 1]) * t.min(1.0)
    };
    (0..count).map(at).collect()
}

//! A garment's outline stood upright, for styles to look at.
//!
//! Method: the axis of symmetry is sought by reflecting the outline in lines through its centroid,
//! up to [`MAX_TILT`] from upright; in the frame of that axis (u across, v up) landmarks are
//! extreme points in tell-tale directions, or the points farthest from a chord. A landmark then
//! snaps to a detected corner near it. So a missing corner is made up for by shape, and one too
//! many does no harm. Cost: a few milliseconds. Limits: the garment must be roughly symmetric and
//! not upside down.

use nalgebra::Rotation2;
use std::ops::RangeInclusive;
use toile_core::artifact::{Outline, Point2, Vector2, polygon_area};

/// How far a garment may lie askew in its photo, degrees.
pub(super) const MAX_TILT: f64 = 20.0;
/// A landmark snaps to a corner within this share of the garment's size (3 cm of a vest): about the
/// size of a rounded corner.
const SNAP: f64 = 0.06;
/// How far behind the extreme point a corner may lie, as a share of its distance from it.
const MAX_LAG: f64 = 0.5;
/// Outline points that the search for the axis looks at.
const AXIS_POINTS: usize = 160;
/// Length over which the turn of a corner is measured, as a share of the garment's size.
const TURN_ARM: f64 = 0.02;

/// An outline in the frame of its axis of symmetry; indices are those of the outline's outer loop,
/// or run the other way round for a mirrored shape.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    points: Vec<Point2>,
    corners: Vec<usize>,
    mirrored: bool,
    /// Root of the area.
    pub(super) size: f64,
    /// Tilt of the axis, degrees, positive where the garment leans to the left.
    pub(super) tilt: f64,
    /// The outline's centroid, which is the frame's origin.
    pub(super) centre: Point2,
    /// Mean distance between the outline and its mirror image, as a share of the size.
    pub(super) asymmetry: f64,
    /// Box in the frame: least and greatest corner.
    pub(super) bounds: [Point2; 2],
}

/// A stretch of the loop, counter-clockwise, from one index to another, both included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    pub(super) from: usize,
    pub(super) to: usize,
}

/// Which way a corner turns on a counter-clockwise loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// Outwards, as a hem's corner.
    Convex,
    /// Inwards, as a sleeve's armpit.
    Concave,
}

impl Shape {
    /// Finds the axis of an outline and stands it upright. `None` for an outline without area.
    pub(super) fn new(outline: &Outline) -> Option<Shape> {
        let points = &outline.outer.points;
        let size = polygon_area(points).abs().sqrt();
        if points.len() < 8 || !(size.is_finite() && size > 0.0) {
            return None;
        }
        let centre = centroid(points);
        let sample: Vec<Point2> = even_sample(points, AXIS_POINTS);
        let misfit = |tilt: f64| asymmetry(&sample, centre, tilt);
        let tilt = best_tilt(misfit);
        let turn = Rotation2::new(-tilt.to_radians());
        let upright: Vec<Point2> = points.iter().map(|p| Point2::from(turn * (p - centre))).collect();
        let (lo, hi) = upright.iter().fold((upright[0], upright[0]), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
        Some(Shape {
            points: upright,
            corners: outline.outer.corners.clone(),
            mirrored: false,
            size,
            tilt,
            centre,
            asymmetry: misfit(tilt) / size,
            bounds: [lo, hi],
        })
    }

    /// The same shape seen in a mirror, so that its other half lies at positive u.
    pub(super) fn mirror(&self) -> Shape {
        let n = self.points.len();
        let flip = |p: &Point2| Point2::new(-p.x, p.y);
        let [lo, hi] = self.bounds;
        Shape {
            points: self.points.iter().rev().map(flip).collect(),
            corners: self.corners.iter().rev().map(|&c| n - 1 - c).collect(),
            mirrored: !self.mirrored,
            bounds: [Point2::new(-hi.x, lo.y), Point2::new(-lo.x, hi.y)],
            ..*self
        }
    }

    /// The index in the outline's own loop.
    pub(super) fn index(&self, i: usize) -> usize {
        if self.mirrored { self.points.len() - 1 - i } else { i }
    }

    pub(super) fn at(&self, i: usize) -> Point2 {
        self.points[i]
    }

    pub(super) fn width(&self) -> f64 {
        self.bounds[1].x - self.bounds[0].x
    }

    pub(super) fn height(&self) -> f64 {
        self.bounds[1].y - self.bounds[0].y
    }

    fn steps(&self, path: Path) -> usize {
        let n = self.points.len();
        (path.to + n - path.from) % n
    }

    fn indices(&self, path: Path) -> impl Iterator<Item = usize> + '_ {
        let n = self.points.len();
        (0..=self.steps(path)).map(move |k| (path.from + k) % n)
    }

    /// True where `i` lies on the path.
    pub(super) fn holds(&self, path: Path, i: usize) -> bool {
        self.steps(Path { from: path.from, to: i }) <= self.steps(path)
    }

    /// True where `i` lies on the path and is none of its ends, which are landmarks already.
    fn within(&self, path: Path, i: usize) -> bool {
        i != path.from && i != path.to && self.holds(path, i)
    }

    pub(super) fn length(&self, path: Path) -> f64 {
        let i: Vec<usize> = self.indices(path).collect();
        i.windows(2).map(|w| (self.at(w[1]) - self.at(w[0])).norm()).sum()
    }

    /// The right half's extreme point in a direction, snapped to a convex corner.
    pub(super) fn extreme_right(&self, direction: Vector2) -> Option<usize> {
        let right = (0..self.points.len()).filter(|&i| self.at(i).x > 0.0);
        let found = right.max_by(|&a, &b| self.along(a, direction).total_cmp(&self.along(b, direction)))?;
        let ahead = self.ahead(found, direction);
        Some(self.snap(found, Bend::Convex, |i| self.at(i).x > 0.0 && ahead(i)))
    }

    /// The path's extreme point in a direction, snapped to a corner.
    pub(super) fn extreme(&self, path: Path, direction: Vector2, bend: Bend) -> Option<usize> {
        let key = |i: &usize| self.along(*i, direction);
        let found = self.indices(path).max_by(|a, b| key(a).total_cmp(&key(b)))?;
        let ahead = self.ahead(found, direction);
        Some(self.snap(found, bend, |i| self.within(path, i) && ahead(i)))
    }

    /// A corner far behind the extreme point is another landmark: a shoulder's rounded end must not
    /// snap to the neck.
    fn ahead(&self, extreme: usize, direction: Vector2) -> impl Fn(usize) -> bool + '_ {
        let unit = direction.normalize();
        move |i| {
            let d = self.at(extreme) - self.at(i);
            d.dot(&unit) <= MAX_LAG * d.norm()
        }
    }

    /// The path's point farthest to the right (positive) or left (negative) of the chord through
    /// its ends, looking from its start, snapped to a corner; and how far that is.
    pub(super) fn farthest(&self, path: Path, side: f64, bend: Bend) -> Option<(usize, f64)> {
        let (a, b) = (self.at(path.from), self.at(path.to));
        let chord = (b - a).try_normalize(1e-12)?;
        let off = |i: &usize| -side * chord.perp(&(self.at(*i) - a));
        let found = self.indices(path).max_by(|a, b| off(a).total_cmp(&off(b)))?;
        Some((self.snap(found, bend, |i| self.within(path, i)), off(&found)))
    }

    fn along(&self, i: usize, direction: Vector2) -> f64 {
        self.at(i).coords.dot(&direction)
    }

    /// The nearest corner of that bend within reach, or the point itself.
    fn snap(&self, i: usize, bend: Bend, allowed: impl Fn(usize) -> bool) -> usize {
        let reach = |c: usize| (self.at(c) - self.at(i)).norm();
        let fits = |c: &usize| allowed(*c) && self.bend(*c) == bend && reach(*c) <= SNAP * self.size;
        self.corners.iter().copied().filter(fits).min_by(|a, b| reach(*a).total_cmp(&reach(*b))).unwrap_or(i)
    }

    /// The sharpest corner of that bend on a path, and its turn in degrees.
    pub(super) fn sharpest(&self, path: Path, bend: Bend) -> Option<(usize, f64)> {
        let fits = |c: &usize| self.within(path, *c) && self.bend(*c) == bend;
        let turn = |c: usize| (c, self.turn(c).abs().to_degrees());
        self.corners.iter().copied().filter(fits).map(turn).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The detected corners.
    pub(super) fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// The loop's point nearest to a place.
    pub(super) fn nearest(&self, to: Point2) -> Option<usize> {
        let far = |i: &usize| (self.at(*i) - to).norm_squared();
        (0..self.points.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    fn bend(&self, i: usize) -> Bend {
        if self.turn(i) >= 0.0 { Bend::Convex } else { Bend::Concave }
    }

    fn turn(&self, i: usize) -> f64 {
        self.turn_over(i, TURN_ARM)
    }

    /// The turn of the loop at a point between chords of a length (a share of the size), radians,
    /// positive to the left.
    pub(super) fn turn_over(&self, i: usize, arm: f64) -> f64 {
        let n = self.points.len();
        let walk = |step: usize| {
            let mut j = i;
            while (self.at(j) - self.at(i)).norm() < arm * self.size {
                j = (j + step) % n;
                if j == i {
                    break;
                }
            }
            self.at(j)
        };
        let (before, after) = (self.at(i) - walk(n - 1), walk(1) - self.at(i));
        before.perp(&after).atan2(before.dot(&after))
    }

    /// The greatest height of the loop at u = 0, or the least.
    pub(super) fn middle(&self, top: bool) -> Option<f64> {
        let n = self.points.len();
        let crossing = |i: usize| {
            let (a, b) = (self.at(i), self.at((i + 1) % n));
            ((a.x > 0.0) != (b.x > 0.0)).then(|| a.y + (b.y - a.y) * a.x / (a.x - b.x))
        };
        let order = |a: &f64, b: &f64| a.total_cmp(b);
        let heights = (0..n).filter_map(crossing);
        if top { heights.max_by(order) } else { heights.min_by(order) }
    }
}

fn centroid(points: &[Point2]) -> Point2 {
    let n = points.len();
    // About the first point, so that far-off outlines lose no digits.
    let o = points[0];
    let (mut twice, mut sum) = (0.0, Vector2::zeros());
    for i in 0..n {
        let (a, b) = (points[i] - o, points[(i + 1) % n] - o);
        let cross = a.perp(&b);
        twice += cross;
        sum += (a + b) * cross;
    }
    o + sum / (3.0 * twice)
}

fn even_sample(points: &[Point2], count: usize) -> Vec<Point2> {
    let n = points.len();
    let piece = |i: usize| (points[(i + 1) % n] - points[i]).norm();
    let total: f64 = (0..n).map(piece).sum();
    let (mut i, mut passed) = (0, 0.0);
    let place = |k: usize| {
        let s = total * k as f64 / count as f64;
        while i + 1 < n && passed + piece(i) < s {
            passed += piece(i);
            i += 1;
        }
        let t = ((s - passed) / piece(i).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        points[i] + (points[(i + 1) % n] - points[i]) * t
    };
    (0..count).map(place).collect()
}

/// Mean distance between the outline and its mirror image in the line through `centre` that is
/// `tilt` degrees off the vertical.
fn asymmetry(sample: &[Point2], centre: Point2, tilt: f64) -> f64 {
    let axis = Rotation2::new(tilt.to_radians()) * Vector2::y();
    let n = sample.len();
    let reflected = |p: &Point2| {
        let d = p - centre;
        centre + axis * (2.0 * axis.dot(&d)) - d
    };
    let distance = |p: Point2| {
        (0..n).map(|i| to_segment(p, sample[i], sample[(i + 1) % n])).fold(f64::INFINITY, f64::min)
    };
    sample.iter().map(|p| distance(reflected(p))).sum::<f64>() / n as f64
}

fn to_segment(p: Point2, a: Point2, b: Point2) -> f64 {
    let u = b - a;
    let t = ((p - a).dot(&u) / u.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (a + u * t - p).norm()
}

/// Coarse search, then thirds.
fn best_tilt(misfit: impl Fn(f64) -> f64) -> f64 {
    let coarse: RangeInclusive<i32> = -10..=10;
    let step = MAX_TILT / 10.0;
    let start = coarse.map(|k| f64::from(k) * step).min_by(|a, b| misfit(*a).total_cmp(&misfit(*b)));
    let start = start.unwrap_or(0.0);
    let (mut low, mut high) = (start - step, start + step);
    for _ in 0..14 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if misfit(a) <= misfit(b) { high = b } else { low = a }
    }
    (low + high) / 2.0
}

//! Two outlines laid over each other: the one and the mirrored other.
//!
//! Both are sampled evenly along their lengths; of all shifts of the one against the other that is
//! taken whose best rigid motion (Procrustes) leaves least distance. Corners and seam ends that
//! then lie near each other are knots; in between, lengths correspond in proportion. Cost O(k^2)
//! for k samples.

use nalgebra::{Matrix3, Point2, Rotation2, Vector2, Vector3};

/// Samples an outline: corners far apart decide, so few are enough.
const SAMPLES: usize = 128;

/// A closed line, counter-clockwise, with the length up to each of its points.
#[derive(Debug, Clone)]
pub(super) struct MeasuredOutline {
    places: Vec<Point2<f64>>,
    arcs: Vec<f64>,
}

impl MeasuredOutline {
    pub(super) fn new(places: Vec<Point2<f64>>) -> Self {
        let mut arcs = vec![0.0];
        let mut gone = 0.0;
        for (p, q) in places.iter().zip(places.iter().cycle().skip(1)) {
            gone += (q - p).norm();
            arcs.push(gone);
        }
        Self { places, arcs }
    }

    pub(super) fn length(&self) -> f64 {
        self.arcs[self.places.len()]
    }

    pub(super) fn places(&self) -> &[Point2<f64>] {
        &self.places
    }

    /// The length up to a point of the list.
    pub(super) fn arc(&self, point: usize) -> f64 {
        self.arcs[point]
    }

    /// The place at a length, which may go round more than once.
    pub(super) fn at(&self, arc: f64) -> Point2<f64> {
        let arc = arc.rem_euclid(self.length());
        let next = self.arcs.partition_point(|&a| a <= arc).clamp(1, self.places.len());
        let (from, to) = (self.places[next - 1], self.places[next % self.places.len()]);
        let step = self.arcs[next] - self.arcs[next - 1];
        if step > 0.0 { from + (to - from) * ((arc - self.arcs[next - 1]) / step) } else { from }
    }

    /// The distance of a point from the line.
    pub(super) fn distance(&self, p: &Point2<f64>) -> f64 {
        (self.nearest(p) - p).norm()
    }

    /// The place on the line that is nearest to a point.
    pub(super) fn nearest(&self, p: &Point2<f64>) -> Point2<f64> {
        self.nearest_edge(p).1
    }

    /// The edge that is nearest to a point, by its first vertex, and the place on it.
    pub(super) fn nearest_edge(&self, p: &Point2<f64>) -> (usize, Point2<f64>) {
        let edges = self.places.iter().zip(self.places.iter().cycle().skip(1));
        let on_edge = |(a, b): (&Point2<f64>, &Point2<f64>)| {
            let along = b - a;
            let share = ((p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            a + along * share
        };
        let off = |q: &Point2<f64>| (q - p).norm_squared();
        let places = edges.map(on_edge).enumerate();
        places.min_by(|(_, q), (_, r)| off(q).total_cmp(&off(r))).unwrap_or((0, *p))
    }

    /// The point of the list that is nearest to a length, along the line.
    pub(super) fn vertex_near(&self, arc: f64) -> usize {
        let arc = arc.rem_euclid(self.length());
        let next = self.arcs.partition_point(|&a| a <= arc).clamp(1, self.places.len());
        let is_next = self.arcs[next] - arc < arc - self.arcs[next - 1];
        if is_next { next % self.places.len() } else { next - 1 }
    }

    pub(super) fn moved(&self, motion: &RigidMotion) -> Self {
        Self { places: self.places.iter().map(|p| motion.of(p)).collect(), arcs: self.arcs.clone() }
    }

    fn samples(&self) -> Vec<Point2<f64>> {
        (0..SAMPLES).map(|k| self.at(self.length() * k as f64 / SAMPLES as f64)).collect()
    }
}

/// A rigid motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct RigidMotion {
    from: Vector2<f64>,
    turn: Rotation2<f64>,
    to: Vector2<f64>,
}

impl RigidMotion {
    pub(super) fn of(&self, p: &Point2<f64>) -> Point2<f64> {
        Point2::from(self.turn * (p.coords - self.from) + self.to)
    }

    /// Half of its turn, backwards.
    pub(super) fn half_turned_back(&self) -> Rotation2<f64> {
        Rotation2::new(-self.turn.angle() / 2.0)
    }

    /// The motion after one step that brings the moved `second` nearer to the points of `first`:
    /// least squares of the distances across its line, so that long edges may slide along each
    /// other (Chen and Medioni 1992).
    pub(super) fn nearer(&self, first: &MeasuredOutline, second: &MeasuredOutline) -> Self {
        let moved = second.moved(self);
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for p in first.places() {
            let q = moved.nearest(p);
            let Some(n) = (p - q).try_normalize(f64::MIN_POSITIVE) else { continue };
            // A turn by a small angle about `to` moves q at right angles to its arm.
            let row = Vector3::new(n.x, n.y, (q.coords - self.to).perp(&n));
            matrix += row * row.transpose();
            right += row * (p - q).dot(&n);
        }
        let step = matrix.cholesky().map_or_else(Vector3::zeros, |c| c.solve(&right));
        let turn = Rotation2::new(step.z) * self.turn;
        Self { turn, to: self.to + Vector2::new(step.x, step.y), ..*self }
    }

    pub(super) fn undone(&self, p: &Point2<f64>) -> Point2<f64> {
        Point2::from(self.turn.inverse() * (p.coords - self.to) + self.from)
    }
}

/// The motion that lays `q` over `p`, point by point, with the least sum of squared distances.
pub(super) fn fit(p: &[Point2<f64>], q: &[Point2<f64>]) -> RigidMotion {
    let middle =
        |s: &[Point2<f64>]| s.iter().fold(Vector2::zeros(), |m, p| m + p.coords) / s.len().max(1) as f64;
    let (to, from) = (middle(p), middle(q));
    let sum = p.iter().zip(q).fold(Vector2::zeros(), |sum: Vector2<f64>, (p, q)| {
        let (p, q) = (p.coords - to, q.coords - from);
        sum + Vector2::new(q.dot(&p), q.perp(&p))
    });
    RigidMotion { from, turn: Rotation2::new(sum.y.atan2(sum.x)), to }
}

/// The motion that lays `b` over `a` but for the spacing of the samples, and the share of its
/// length where `a` begins on it.
pub(super) fn align(a: &MeasuredOutline, b: &MeasuredOutline) -> (RigidMotion, f64) {
    let (p, q) = (a.samples(), b.samples());
    let middle = |s: &[Point2<f64>]| s.iter().fold(Vector2::zeros(), |m, p| m + p.coords) / SAMPLES as f64;
    let (to, from) = (middle(&p), middle(&q));
    // Sums of products of complex numbers: the turn is their angle, the fit their length.
    let sum = |shift: usize| {
        (0..SAMPLES).fold(Vector2::zeros(), |sum: Vector2<f64>, k| {
            let (p, q) = (p[k].coords - to, q[(k + shift) % SAMPLES].coords - from);
            sum + Vector2::new(q.dot(&p), q.perp(&p))
        })
    };
    let fits = (0..SAMPLES).map(|k| (k, sum(k)));
    let best = fits.max_by(|x, y| x.1.norm().total_cmp(&y.1.norm()));
    let shift = best.map_or(0, |b| b.0);
    let shifted: Vec<_> = (0..SAMPLES).map(|k| q[(k + shift) % SAMPLES]).collect();
    (fit(&p, &shifted), shift as f64 / SAMPLES as f64)
}

/// Which length of one outline is which of the other.
#[derive(Debug, Clone)]
pub(super) struct Correspondence {
    /// Pairs of lengths, the first increasing within one round, the second within one round from
    /// its first.
    knots: Vec<[f64; 2]>,
    rounds: [f64; 2],
}

impl Correspondence {
    /// From points of both outlines (already laid over each other) that may be knots, those that
    /// must first, and the shift of [`align`].
    pub(super) fn new(
        a: &MeasuredOutline,
        b: &MeasuredOutline,
        points: &[[Vec<usize>; 2]],
        shift: f64,
        reach: f64,
    ) -> Self {
        let rounds = [a.length(), b.length()];
        let spacing = rounds[0] / a.places.len() as f64 + rounds[1] / b.places.len() as f64;
        let mut knots: Vec<[f64; 2]> = Vec::new();
        for points in points {
            let away = |k: &[f64; 2]| knots.iter().all(|other| other[0] != k[0] && other[1] != k[1]);
            let more: Vec<_> = mutual_pairs(a, b, points, reach).into_iter().filter(away).collect();
            knots.extend(more);
        }
        // A corner that the other outline does not have takes its nearest vertex, away from other
        // knots.
        let [points_a, points_b] = points.last().map_or([&[][..]; 2], |p| [&p[0], &p[1]]);
        let all = |x: &MeasuredOutline| (0..x.places.len()).collect::<Vec<_>>();
        let singles_a =
            points_a.iter().filter_map(|&i| Some([a.arc(i), b.arc(nearest(a, i, b, &all(b), reach)?)]));
        let singles_b =
            points_b.iter().filter_map(|&j| Some([a.arc(nearest(b, j, a, &all(a), reach)?), b.arc(j)]));
        for single in singles_a.chain(singles_b).collect::<Vec<_>>() {
            if knots.iter().all(|k| (k[0] - single[0]).abs() > spacing) {
                knots.push(single);
            }
        }
        knots.sort_by(|x, y| x[0].total_cmp(&y[0]));
        if knots.is_empty() {
            knots.push([0.0, shift * rounds[1]]);
        }
        let first = knots[0][1];
        let mut last = first;
        // A knot that would run backwards is a mistaken pair.
        let mut kept = vec![knots[0]];
        for k in &knots[1..] {
            let unrolled = first + (k[1] - first).rem_euclid(rounds[1]);
            if unrolled > last {
                last = unrolled;
                kept.push([k[0], unrolled]);
            }
        }
        Self { knots: kept, rounds }
    }

    /// The length on the second outline for one on the first.
    pub(super) fn forward(&self, arc: f64) -> f64 {
        self.map(arc, 0, 1)
    }

    /// The length on the first outline for one on the second.
    pub(super) fn back(&self, arc: f64) -> f64 {
        self.map(arc, 1, 0)
    }

    fn map(&self, arc: f64, from: usize, to: usize) -> f64 {
        let first = self.knots[0];
        let arc = first[from] + (arc - first[from]).rem_euclid(self.rounds[from]);
        let next = self.knots.partition_point(|k| k[from] <= arc).max(1);
        let low = self.knots[next - 1];
        let high = match self.knots.get(next) {
            Some(k) => *k,
            None => [first[0] + self.rounds[0], first[1] + self.rounds[1]],
        };
        let step = high[from] - low[from];
        let share = if step > 0.0 { (arc - low[from]) / step } else { 0.0 };
        low[to] + share * (high[to] - low[to])
    }
}

/// Points of both lists that are nearest to each other, by their lengths.
fn mutual_pairs(
    a: &MeasuredOutline,
    b: &MeasuredOutline,
    points: &[Vec<usize>; 2],
    reach: f64,
) -> Vec<[f64; 2]> {
    let pairs = points[0].iter().filter_map(|&i| {
        let j = nearest(a, i, b, &points[1], reach)?;
        (nearest(b, j, a, &points[0], reach) == Some(i)).then(|| [a.arc(i), b.arc(j)])
    });
    pairs.collect()
}

/// The point of `y` among `others` that is nearest to point `i` of `x`, if it is within reach.
fn nearest(
    x: &MeasuredOutline,
    i: usize,
    y: &MeasuredOutline,
    others: &[usize],
    reach: f64,
) -> Option<usize> {
    let distance = |j: &usize| (x.places[i] - y.places[*j]).norm();
    let nearest = others.iter().copied().min_by(|j, k| distance(j).total_cmp(&distance(k)));
    nearest.filter(|j| distance(j) <= reach)
}

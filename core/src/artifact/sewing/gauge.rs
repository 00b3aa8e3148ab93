//! Into how many parts an edge is divided, the same for both edges of a seam.
//!
//! Method: for each length of a geometric sequence of chord lengths, the *sag* is the greatest
//! distance between the curve and any chord of that length. A mesher takes the longest chord whose
//! sag its edge length allows. The sag of the shortest chord is the noise of the outline, and is
//! never a reason to divide. Two edges that are sewn together take the longer length and the
//! greater sag of both, so that both get the same count although each is divided alone. Cost:
//! linear in the points of the edge times the points under the longest chord, once per edge.

use crate::artifact::{Point2, Vector2};

/// The share of the edge length by which a chord may leave the curve: outlines stay this true.
pub const CHORD_TOLERANCE: f64 = 0.02;

/// Number of chord lengths in the sequence.
const RUNGS: usize = 24;
/// The shortest chord length, metres: below it an outline from a photo is noise only.
const SHORTEST: f64 = 1.5e-3;
/// Ratio of a chord length to the one before it; 24 lengths reach 10 cm.
const RATIO: f64 = 1.2;
/// Sag of up to this many times that of the shortest chord is noise.
const NOISE: f64 = 1.5;
/// Points of the curve lie no farther apart than this, metres, or than [`SPACING_SHARE`] of it.
const SPACING: f64 = 5e-4;
/// The share of a curve's length that its points may lie apart where that is more than [`SPACING`].
const SPACING_SHARE: f64 = 5e-5;
/// Chords shorter than this share of the edge length come from a missed corner, not from the curve.
const LEAST_SHARE: f64 = 1.0 / 8.0;

/// Length and sag that two edges that are sewn together share, so that every mesher divides both
/// alike.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gauge {
    /// The length that fixes the number of divisions, metres: the longer of both edges.
    pub length: f64,
    /// For each chord length, the greatest distance between chord and curve, metres.
    sag: [f64; RUNGS],
}

impl Gauge {
    /// The gauge of one edge from its points, metres, both ends included; `corners` are indices of
    /// points at which the curve bends by intent and which become vertices whatever the division.
    pub fn of(points: &[Point2], corners: &[usize]) -> Self {
        let length = crate::artifact::polyline_length(points);
        let (points, stops) = filled(points, corners);
        let along = lengths(&points);
        let mut sag = [0.0; RUNGS];
        for (k, sag) in sag.iter_mut().enumerate() {
            let worst = stops.windows(2).map(|w| worst_sag(&points, &along, w[0], w[1], rung(k)));
            *sag = worst.fold(0.0, f64::max);
        }
        Gauge { length, sag }
    }

    /// A straight edge of that length, metres.
    pub fn straight(length: f64) -> Self {
        Gauge { length, sag: [0.0; RUNGS] }
    }

    /// What both edges of a seam take.
    pub fn shared(&self, other: &Gauge) -> Gauge {
        let mut sag = self.sag;
        sag.iter_mut().zip(&other.sag).for_each(|(a, b)| *a = a.max(*b));
        Gauge { length: self.length.max(other.length), sag }
    }

    /// Into how many equal parts (by arc length) an edge is divided at a target edge length `h`
    /// (metres). At least one.
    ///
    /// The parts are no longer than `h`, and their chords leave the curve by no more than half of
    /// [`CHORD_TOLERANCE`] times `h`; the other half is left to divisions that slide onto corners.
    pub fn divisions(&self, h: f64) -> usize {
        let s = self.chord(h).max(h * LEAST_SHARE);
        ((self.length / s - 1e-9).ceil() as usize).max(1)
    }

    /// The longest chord that stays true at an edge length `h`.
    fn chord(&self, h: f64) -> f64 {
        let allowed = (0.5 * CHORD_TOLERANCE * h).max(NOISE * self.sag[0]);
        let beyond = h / rung(RUNGS - 1);
        if beyond > 1.0 && self.sag.iter().all(|s| s * beyond * beyond <= allowed) {
            return h;
        }
        // A chord of `h` is judged by the next longer length of the sequence.
        let covers = (0..RUNGS).find(|&k| rung(k) >= h).unwrap_or(RUNGS - 1);
        match (0..=covers).rev().find(|&k| self.sag[..=k].iter().all(|s| *s <= allowed)) {
            Some(k) => h.min(rung(k)),
            None => SHORTEST.min(h),
        }
    }

    /// The length, then the sag of every chord length.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> + use<> {
        std::iter::once(self.length).chain(self.sag)
    }

    /// The gauge of such numbers.
    pub(crate) fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let (length, sag) = numbers.split_first()?;
        Some(Gauge { length: *length, sag: sag.try_into().ok()? })
    }

    /// Whether the length and every sag are finite and not negative.
    pub(crate) fn is_sound(&self) -> bool {
        let sound = |x: &f64| x.is_finite() && *x >= 0.0;
        sound(&self.length) && self.sag.iter().all(sound)
    }
}

/// The chord length number `k` of the sequence, metres.
fn rung(k: usize) -> f64 {
    SHORTEST * RATIO.powi(k as i32)
}

/// Arc length at every point.
fn lengths(points: &[Point2]) -> Vec<f64> {
    let mut along = Vec::with_capacity(points.len());
    let mut sum = 0.0;
    for (i, p) in points.iter().enumerate() {
        sum += if i > 0 { (p - points[i - 1]).norm() } else { 0.0 };
        along.push(sum);
    }
    along
}

/// The curve with points near each other, and the indices of its ends and corners, ascending.
fn filled(points: &[Point2], corners: &[usize]) -> (Vec<Point2>, Vec<usize>) {
    let total: f64 = points.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let spacing = SPACING.max(total * SPACING_SHARE);
    let (mut dense, mut stops) = (Vec::with_capacity(points.len()), Vec::new());
    for (i, p) in points.iter().enumerate() {
        let before = points[i.saturating_sub(1)];
        let parts = ((p - before).norm() / spacing).ceil().max(1.0);
        dense.extend((1..parts as usize).map(|k| before + (p - before) * (k as f64 / parts)));
        if i == 0 || i + 1 == points.len() || corners.contains(&i) {
            stops.push(dense.len());
        }
        dense.push(*p);
    }
    (dense, stops)
}

/// The farthest that a chord over an arc of length `s` leaves the curve between two of its points.
fn worst_sag(points: &[Point2], along: &[f64], from: usize, to: usize, s: f64) -> f64 {
    let (mut worst, mut j) = (0.0, from);
    for i in from..to {
        while j < to && along[j] < along[i] + s {
            j += 1;
        }
        worst = off_chord(&points[i + 1..j.max(i + 1)], points[i], points[j], worst);
        if j == to {
            break;
        }
    }
    worst.sqrt()
}

/// The greatest squared distance of the points from a chord, or `least`.
fn off_chord(points: &[Point2], a: Point2, b: Point2, least: f64) -> f64 {
    let d = b - a;
    let squared = d.norm_squared();
    let whole = if squared > 0.0 { squared } else { 1.0 };
    let distance = |p: &Point2| {
        let v: Vector2 = p - a;
        (v - d * (v.dot(&d) / whole).clamp(0.0, 1.0)).norm_squared()
    };
    points.iter().map(distance).fold(least, |worst, x| if x > worst { x } else { worst })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arc of a circle, points 0.5 mm apart.
    fn arc(radius: f64, length: f64) -> Vec<Point2> {
        let n = (length / 5e-4) as usize;
        let at = |k: usize| (length * k as f64 / n as f64) / radius;
        (0..=n).map(|k| Point2::new(radius * at(k).cos(), radius * at(k).sin())).collect()
    }

    #[test]
    fn a_straight_edge_is_cut_by_length_alone() {
        let line = [Point2::new(0.0, 0.0), Point2::new(0.3, 0.4)];
        let gauge = Gauge::of(&line, &[]);
        assert!((gauge.length - 0.5).abs() < 1e-12 && gauge.sag.iter().all(|s| *s < 1e-12));
        assert_eq!([0.6, 0.5, 0.25, 0.1, 0.012].map(|h| gauge.divisions(h)), [1, 1, 2, 5, 42]);
    }

    #[test]
    fn chords_of_an_arc_stay_within_half_of_the_tolerance() {
        for radius in [0.02, 0.05, 0.1, 0.4] {
            for h in [0.006, 0.012, 0.016, 0.03, 0.06] {
                let gauge = Gauge::of(&arc(radius, 0.2), &[]);
                let s = gauge.length / gauge.divisions(h) as f64;
                let sag = s * s / (8.0 * radius);
                assert!(
                    sag <= 0.5 * CHORD_TOLERANCE * h * 1.01 || s <= SHORTEST,
                    "r {radius} h {h}: {s} {sag}"
                );
                let needed = (8.0 * radius * 0.5 * CHORD_TOLERANCE * h).sqrt().min(h);
                assert!(s > needed / 1.5, "r {radius} h {h}: {s} is needlessly short, {needed} would do");
            }
        }
    }

    #[test]
    fn noise_of_the_outline_asks_for_no_division() {
        let rough: Vec<Point2> =
            (0..400).map(|k| Point2::new(5e-4 * f64::from(k), 3e-5 * f64::from(k * 7 % 5))).collect();
        let gauge = Gauge::of(&rough, &[]);
        assert_eq!(gauge.divisions(0.004), Gauge::straight(gauge.length).divisions(0.004));
    }

    #[test]
    fn a_corner_within_the_edge_is_no_curve() {
        let (a, b, c) = (Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.1, 0.1));
        assert_eq!(Gauge::of(&[a, b, c], &[1]).divisions(0.01), 20);
        assert!(Gauge::of(&[a, b, c], &[]).divisions(0.01) > 20);
    }

    #[test]
    fn both_edges_of_a_seam_take_what_either_needs() {
        let (bent, long) = (Gauge::of(&arc(0.05, 0.2), &[]), Gauge::straight(0.25));
        assert_eq!(bent.shared(&long), long.shared(&bent));
        assert!(bent.shared(&long).divisions(0.02) >= bent.divisions(0.02).max(long.divisions(0.02)));
    }
}

//! Corners of a closed curve.
//!
//! Method: at each place two arms of the curve, one behind and one ahead, are fitted with parabolas
//! over the arc length (least squares); the angle between their tangents at the place is the
//! corner's turn. A smooth curve continues its own parabola, so its turn is about zero however
//! tightly it bends, which a plain chord angle (Rosenfeld and Johnston, *Angle detection on digital
//! curves*, 1973) would take for a corner. Places where the turn peaks are corners; the exact point
//! is where both parabolas cross, so rounding by lens, pixels and operator does not shift it. Cost:
//! arm length times curve length. Limits: two corners nearer than an arm are seen as one, and a
//! corner rounder than about a third of an arm is none.

use super::curve::{Closed, CurveCorner};
use toile_core::artifact::{Point2, Vector2};

/// What counts as a corner; lengths in the curve's units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CornerScale {
    /// Length of an arm: longer arms are surer but overlook corners near each other.
    pub(crate) arm: f64,
    /// The stretch next to the corner that is not trusted, because lens and operator round it.
    pub(crate) gap: f64,
    /// Least turn, radians.
    pub(crate) least_turn: f64,
}

/// A parabola over the arc length: `p + v s + a s^2`.
#[derive(Debug, Clone, Copy)]
struct CornerArm {
    p: Vector2,
    v: Vector2,
    a: Vector2,
}

impl CornerArm {
    fn at(&self, s: f64) -> Vector2 {
        self.p + self.v * s + self.a * (s * s)
    }
}

/// All corners in the order of the curve.
pub(crate) fn find(curve: &Closed, scale: CornerScale) -> Vec<CurveCorner> {
    let n = curve.points.len();
    let turns: Vec<f64> = (0..n).map(|i| turn_at(curve, i as f64 * curve.step, scale)).collect();
    let reach = ((scale.arm / curve.step) as usize).min(n.saturating_sub(1) / 2);
    let peaks = (0..n).filter(|&i| {
        let here = turns[i].abs();
        let beaten = |d: usize| {
            let (before, after) = (turns[(i + n - d) % n].abs(), turns[(i + d) % n].abs());
            before >= here || after > here
        };
        here >= scale.least_turn && !(1..=reach).any(beaten)
    });
    let mut corners: Vec<CurveCorner> =
        peaks.filter_map(|i| locate(curve, i as f64 * curve.step, scale)).collect();
    corners.sort_by(|a, b| a.at.total_cmp(&b.at));
    corners
}

fn turn_at(curve: &Closed, s: f64, scale: CornerScale) -> f64 {
    let (behind, ahead) = (fit(curve, s, -1.0, scale), fit(curve, s, 1.0, scale));
    behind.v.perp(&ahead.v).atan2(behind.v.dot(&ahead.v))
}

/// Least-squares parabola over the arm on one side (`side` is 1 ahead, -1 behind).
fn fit(curve: &Closed, s: f64, side: f64, scale: CornerScale) -> CornerArm {
    let count = (((scale.arm - scale.gap) / curve.step).ceil() as usize).max(4);
    let place = |k: usize| scale.gap + (scale.arm - scale.gap) * k as f64 / (count - 1) as f64;
    // Moments are taken about the arm's length, so that the system is well conditioned.
    let mut m = [0.0; 5];
    let mut r = [Vector2::zeros(); 3];
    for k in 0..count {
        let u = place(k) / scale.arm;
        let q = curve.at(s + side * place(k)).coords;
        let mut power = 1.0;
        for (j, sum) in m.iter_mut().enumerate() {
            *sum += power;
            if j < 3 {
                r[j] += q * power;
            }
            power *= u;
        }
    }
    let system = nalgebra::Matrix3::new(m[0], m[1], m[2], m[1], m[2], m[3], m[2], m[3], m[4]);
    let solve = |k: usize| {
        let right = nalgebra::Vector3::new(r[0][k], r[1][k], r[2][k]);
        system.cholesky().map_or_else(nalgebra::Vector3::zeros, |c| c.solve(&right))
    };
    let (x, y) = (solve(0), solve(1));
    let row = |j: usize, scale: f64| Vector2::new(x[j], y[j]) * scale;
    CornerArm { p: row(0, 1.0), v: row(1, side / scale.arm), a: row(2, 1.0 / (scale.arm * scale.arm)) }
}

/// How far a corner may stand off the curve that rounds it, in gaps: farther ones are curves whose
/// parabolas happen to cross.
const MAX_OFF: f64 = 2.5;
/// How often the arms are fitted anew about the corner they gave.
const ROUNDS: usize = 3;

/// The exact corner near `s`: where both arms' parabolas cross.
fn locate(curve: &Closed, mut s: f64, scale: CornerScale) -> Option<CurveCorner> {
    let mut found = None;
    for _ in 0..ROUNDS {
        let (behind, ahead) = (fit(curve, s, -1.0, scale), fit(curve, s, 1.0, scale));
        let (u, v) = crossing(&behind, &ahead, scale.arm / 2.0)?;
        let (t0, t1) = (behind.v + behind.a * (2.0 * u), ahead.v + ahead.a * (2.0 * v));
        let turn = t0.perp(&t1).atan2(t0.dot(&t1));
        let point = Point2::from((behind.at(u) + ahead.at(v)) / 2.0);
        // The curve cuts the corner: it passes it half-way between both arms' parameters.
        s += (u + v) / 2.0;
        found = Some(CurveCorner { at: s.rem_euclid(curve.length()), point, turn });
    }
    found.filter(|c| {
        let off = (curve.at(c.at) - c.point).norm();
        c.turn.abs() >= 0.8 * scale.least_turn && off <= MAX_OFF * scale.gap
    })
}

/// Newton's method for `behind(u) = ahead(v)` from the tangents' crossing; none where they run
/// alongside each other or cross farther off than `limit`.
fn crossing(behind: &CornerArm, ahead: &CornerArm, limit: f64) -> Option<(f64, f64)> {
    let (mut u, mut v) = (0.0, 0.0);
    for _ in 0..12 {
        let gap = ahead.at(v) - behind.at(u);
        let (t0, t1) = (behind.v + behind.a * (2.0 * u), ahead.v + ahead.a * (2.0 * v));
        let cross = t0.perp(&t1);
        if cross.abs() < 1e-9 {
            return None;
        }
        u += gap.perp(&t1) / cross;
        v += gap.perp(&t0) / cross;
        if !(u.abs() <= limit && v.abs() <= limit) {
            return None;
        }
    }
    Some((u, v))
}

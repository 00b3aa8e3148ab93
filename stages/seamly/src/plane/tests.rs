#![allow(clippy::unwrap_used)]
use super::*;
use kurbo::{Affine, CubicBez};

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn near(a: Point, b: Point) {
    assert!((a - b).hypot() < 1e-6, "{a} is not {b}");
}

/// A straight line as a cubic, so that lengths are known.
fn straight(a: Point, b: Point) -> DraftCurve {
    let d = (b - a) / 3.0;
    DraftCurve::single(DraftStroke::Cubic(CubicBez::new(a, a + d, a + d * 2.0, b)), "A", "B")
}

#[test]
fn lines_and_circles_meet_where_they_should() {
    near(lines(p(0.0, 0.0), Vec2::new(1.0, 1.0), p(4.0, 0.0), Vec2::new(0.0, 1.0)).unwrap(), p(4.0, 4.0));
    assert_eq!(lines(p(0.0, 0.0), Vec2::new(1.0, 0.0), p(0.0, 1.0), Vec2::new(-2.0, 0.0)), None);
    let [ahead, behind] = line_and_circle(p(0.0, 3.0), Vec2::new(1.0, 0.0), p(0.0, 0.0), 5.0).unwrap();
    near(ahead, p(4.0, 3.0));
    near(behind, p(-4.0, 3.0));
    assert_eq!(line_and_circle(p(0.0, 6.0), Vec2::new(1.0, 0.0), p(0.0, 0.0), 5.0), None);
    // To the right of the way along x is below.
    let [right, left] = circles(p(0.0, 0.0), 5.0, p(8.0, 0.0), 5.0).unwrap();
    near(right, p(4.0, -3.0));
    near(left, p(4.0, 3.0));
    assert_eq!(circles(p(0.0, 0.0), 1.0, p(8.0, 0.0), 5.0), None);
    assert_eq!(circles(p(0.0, 0.0), 1.0, p(0.0, 0.0), 1.0), None);
}

#[test]
fn arcs_have_their_ends_and_lengths() {
    let quarter = DraftCurve::arc(p(1.0, 1.0), 2.0, [0.0, 90.0]);
    near(quarter.start(), p(3.0, 1.0));
    near(quarter.end(), p(1.0, 3.0));
    assert!((quarter.length() - std::f64::consts::PI).abs() < 1e-12);
    assert!((quarter.start_angle() - 90.0).abs() < 1e-9 && quarter.end_angle().abs() < 1e-9);
    let back = DraftCurve::arc(p(1.0, 1.0), -2.0, [0.0, 90.0]);
    assert!((back.length() - 3.0 * std::f64::consts::PI).abs() < 1e-12);
    assert!((DraftCurve::arc(p(0.0, 0.0), 1.0, [30.0, 30.0]).length() - std::f64::consts::TAU).abs() < 1e-12);
    let half = DraftCurve::arc_of_length(p(0.0, 0.0), 2.0, 90.0, 2.0 * std::f64::consts::PI);
    near(half.end(), p(0.0, -2.0));
    let mirrored = quarter.moved(Affine::FLIP_X, "m");
    near(mirrored.start(), p(-3.0, 1.0));
    near(mirrored.end(), p(-1.0, 3.0));
    near(mirrored.at(mirrored.length() / 2.0), p(-1.0 - 2.0_f64.sqrt(), 1.0 + 2.0_f64.sqrt()));
}

#[test]
fn arcs_of_ellipses_end_at_the_angles_that_they_are_seen_at() {
    let whole = DraftCurve::ellipse(p(0.0, 0.0), [3.0, 3.0], [0.0, 0.0], 0.0);
    assert!((whole.length() - 6.0 * std::f64::consts::PI).abs() < 1e-5);
    let part = DraftCurve::ellipse(p(0.0, 0.0), [4.0, 2.0], [45.0, 180.0], 90.0);
    // At 45 degrees x is y: x squared (1/16 + 1/4) is 1; then it is turned by 90 degrees.
    let x = (1.0_f64 / (1.0 / 16.0 + 0.25)).sqrt();
    near(part.start(), p(-x, x));
    near(part.end(), p(0.0, -4.0));
}

#[test]
fn curves_are_cut_at_lengths_and_found_by_points() {
    let line = straight(p(0.0, 0.0), p(10.0, 0.0));
    let [a, b] = line.cut(4.0, "C");
    near(a.end(), p(4.0, 0.0));
    assert_eq!(
        (a.labels.clone(), b.labels.clone()),
        (vec!["A".into(), "C".into()], vec!["C".into(), "B".into()])
    );
    assert!((b.length() - 6.0).abs() < 1e-6);
    let (far, along) = line.nearest(p(3.0, 2.0));
    assert!((far - 2.0).abs() < 1e-6 && (along - 3.0).abs() < 1e-4);
    let arc = DraftCurve::arc(p(0.0, 0.0), 1.0, [0.0, 180.0]);
    let [one, other] = arc.cut(std::f64::consts::FRAC_PI_2, "T");
    near(one.end(), p(0.0, 1.0));
    near(other.end(), p(-1.0, 0.0));
    near(arc.reversed().start(), p(-1.0, 0.0));
}

#[test]
fn curves_meet_lines_and_each_other() {
    let arc = DraftCurve::arc(p(0.0, 0.0), 5.0, [0.0, 180.0]);
    near(on_ray(&arc, p(3.0, 0.0), 90.0).unwrap(), p(3.0, 4.0));
    // Nothing lies ahead: the line is followed backwards.
    near(on_ray(&arc, p(3.0, 0.0), 270.0).unwrap(), p(3.0, 4.0));
    assert_eq!(on_ray(&arc, p(9.0, 0.0), 90.0), None);
    let line = straight(p(-3.0, -1.0), p(-3.0, 9.0));
    let met = crossings(&arc, &line, &mut 0);
    assert_eq!(met.len(), 1);
    near(met[0], p(-3.0, 4.0));
    let other = DraftCurve::arc(p(6.0, 0.0), 5.0, [0.0, 180.0]);
    let met = crossings(&arc, &other, &mut 0);
    assert_eq!(met.len(), 1);
    near(met[0], p(3.0, 4.0));
    // A curve on itself ends, too.
    crossings(&line, &line, &mut 0);
}

#[test]
fn directions_along_the_axes_are_exact() {
    for (degrees, x, y) in [(0.0, 1.0, 0.0), (90.0, 0.0, 1.0), (-90.0, 0.0, -1.0), (540.0, -1.0, 0.0)] {
        assert_eq!(direction(degrees), Vec2::new(x, y));
    }
    assert!((angle(direction(213.0)) - 213.0).abs() < 1e-9);
}

#[test]
fn a_curve_of_any_size_is_cut_at_once() {
    // An ease of -2^63 cm: the fuzzing found that such a curve took minutes.
    let far = -2.3e18;
    let c = CubicBez::new(p(far, -3.0), p(far, -18.0), p(far + 40.0, 1e17), p(far / 3.0, far));
    let curve = DraftCurve::single(DraftStroke::Cubic(c), "A", "B");
    let half = 0.5 * curve.length();
    let [one, _] = curve.cut(half, "C");
    assert!((one.length() / half - 1.0).abs() < 1e-9);
    assert!(curve.nearest(p(0.0, 0.0)).0.is_finite());
}

//! Where lines, circles and curves meet.
//!
//! Method: lines and circles in closed form; a line and a cubic by the roots of a cubic equation;
//! two curves by halving both until their boxes are smaller than [`FINE`]. Limits: [`MOST_BOXES`]
//! boxes of two curves and [`MOST_OF_ALL`] of all together, which curves that lie on each other use
//! up; what was found until then is given.

use super::arc::DraftArc;
use super::curve::DraftCurve;
use super::stroke::DraftStroke;
use super::{angle, direction};
use kurbo::{CubicBez, ParamCurve, Point, Rect, Vec2};

/// Curves meet where boxes of this size do, in the pattern's unit.
const FINE: f64 = 1e-7;
/// Meetings this near to each other are one, in the pattern's unit.
const SAME: f64 = 1e-5;
/// Pairs of boxes that are looked at for two curves.
const MOST_BOXES: usize = 60_000;
/// And for all curves of a file together.
const MOST_OF_ALL: usize = 20_000_000;

/// Where two lines meet, each through a point in a direction; none where they are parallel.
pub(crate) fn lines(a: Point, u: Vec2, b: Point, v: Vec2) -> Option<Point> {
    let cross = u.cross(v);
    let parallel = cross.abs() <= 1e-12 * u.hypot() * v.hypot();
    (!parallel).then(|| a + u * ((b - a).cross(v) / cross))
}

/// Where a line through a point meets a circle: the farther point in the line's direction first;
/// one twice where the line touches.
pub(crate) fn line_and_circle(a: Point, u: Vec2, centre: Point, radius: f64) -> Option<[Point; 2]> {
    let foot = super::foot(a, a + u, centre)?;
    let far = (foot - centre).hypot();
    let half = radius * radius - far * far;
    // Touching to a millionth of the radius is touching.
    let half = if far <= radius * (1.0 + 1e-6) { half.max(0.0).sqrt() } else { return None };
    let way = u / u.hypot();
    Some([foot + way * half, foot - way * half])
}

/// Where two circles meet: first the point to the right of the way from the first centre to the
/// second, then the one to the left.
pub(crate) fn circles(a: Point, r: f64, b: Point, s: f64) -> Option<[Point; 2]> {
    let d = b - a;
    let far = d.hypot();
    if far <= 1e-12 || far > (r + s) * (1.0 + 1e-6) || far < (r - s).abs() * (1.0 - 1e-6) {
        return None;
    }
    let along = (far * far + r * r - s * s) / (2.0 * far);
    let aside = (r * r - along * along).max(0.0).sqrt();
    let way = d / far;
    let foot = a + way * along;
    let left = Vec2::new(-way.y, way.x);
    Some([foot - left * aside, foot + left * aside])
}

/// The point of a curve that is nearest to a point on the ray from it; where none is ahead, the
/// nearest behind; the point itself where it lies on the curve.
pub(crate) fn on_ray(curve: &DraftCurve, from: Point, degrees: f64) -> Option<Point> {
    let way = direction(degrees);
    let mut ahead: Option<f64> = None;
    let mut behind: Option<f64> = None;
    for stroke in &curve.strokes {
        for p in line_and_stroke(stroke, from, way) {
            let far = (p - from).dot(way);
            match far {
                f if f > SAME => ahead = Some(ahead.map_or(f, |a| a.min(f))),
                f if f < -SAME => behind = Some(behind.map_or(f, |b| b.max(f))),
                _ => {}
            }
        }
    }
    let on = || (curve.nearest(from).0 <= SAME).then_some(0.0);
    ahead.or(behind).or_else(on).map(|far| from + way * far)
}

/// Where an endless line meets a stroke.
fn line_and_stroke(stroke: &DraftStroke, from: Point, way: Vec2) -> Vec<Point> {
    match stroke {
        DraftStroke::Arc(arc) => {
            let on = |p: &Point| arc.share(angle(*p - arc.centre)).is_some();
            let both = line_and_circle(from, way, arc.centre, arc.radius);
            both.into_iter().flatten().filter(on).collect()
        }
        DraftStroke::Cubic(c) => {
            let [a, b, d, e] = [c.p0, c.p1, c.p2, c.p3].map(|p| way.cross(p - from));
            let roots = kurbo::common::solve_cubic(
                a,
                3.0 * (b - a),
                3.0 * (a - 2.0 * b + d),
                e - 3.0 * d + 3.0 * b - a,
            );
            let on = |t: &f64| (-1e-7..=1.0 + 1e-7).contains(t);
            roots.into_iter().filter(on).map(|t| c.eval(t.clamp(0.0, 1.0))).collect()
        }
    }
}

/// Where two curves meet, in the order of the first; `used` counts the boxes of all of them.
pub(crate) fn crossings(one: &DraftCurve, other: &DraftCurve, used: &mut usize) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    let most = MOST_BOXES.min(MOST_OF_ALL.saturating_sub(*used));
    let mut left = most;
    for a in &one.strokes {
        for b in &other.strokes {
            let found = match (a, b) {
                (DraftStroke::Arc(a), DraftStroke::Arc(b)) => arcs(a, b),
                _ => cubics(&a.cubics(), &b.cubics(), &mut left),
            };
            for p in found {
                if !out.iter().any(|q| (*q - p).hypot() <= SAME) {
                    out.push(p);
                }
            }
        }
    }
    *used += most - left;
    out.sort_by(|p, q| one.nearest(*p).1.total_cmp(&one.nearest(*q).1));
    out
}

/// Where two arcs meet: as [`circles`], without what is beyond their ends.
pub(super) fn arcs(a: &DraftArc, b: &DraftArc) -> Vec<Point> {
    let on = |p: &Point| [a, b].iter().all(|arc| arc.share(angle(*p - arc.centre)).is_some());
    circles(a.centre, a.radius, b.centre, b.radius).into_iter().flatten().filter(on).collect()
}

fn cubics(all: &[CubicBez], others: &[CubicBez], left: &mut usize) -> Vec<Point> {
    let mut open: Vec<(CubicBez, CubicBez)> =
        all.iter().flat_map(|a| others.iter().map(move |b| (*a, *b))).collect();
    let mut out: Vec<Point> = Vec::new();
    while let Some((a, b)) = open.pop() {
        if *left == 0 {
            break;
        }
        *left -= 1;
        let (one, other) = (hull(&a), hull(&b));
        let apart = one.x0 > other.x1 + FINE
            || other.x0 > one.x1 + FINE
            || one.y0 > other.y1 + FINE
            || other.y0 > one.y1 + FINE;
        if apart {
            continue;
        }
        let size = |r: Rect| r.width().max(r.height());
        match (size(one), size(other)) {
            (s, t) if s <= FINE && t <= FINE => {
                let p = a.eval(0.5);
                if !out.iter().any(|q| (*q - p).hypot() <= SAME) {
                    out.push(p);
                }
            }
            (s, t) if s >= t => {
                let (x, y) = a.subdivide();
                open.extend([(x, b), (y, b)]);
            }
            _ => {
                let (x, y) = b.subdivide();
                open.extend([(a, x), (a, y)]);
            }
        }
    }
    out
}

/// The box of the control points, which holds the curve.
fn hull(c: &CubicBez) -> Rect {
    Rect::from_points(c.p0, c.p3).union_pt(c.p1).union_pt(c.p2)
}

//! Tools that draw the point where circles, arcs or curves meet.
//!
//! Of two circles the first point lies to the right of the way from the first centre to the second.

use super::super::plane::{DraftStroke, circles, crossings, on_ray};
use super::cuts;
use super::drafting::{DraftTool, Drafting};
use super::object::{CurveFamily, DrawnCurve};
use super::values::Failed;
use kurbo::Point;

/// The first or the second point, as the tool asks.
fn chosen(tool: &DraftTool<'_, '_>, [first, second]: [Point; 2]) -> Point {
    if tool.name("crossPoint") == "2" { second } else { first }
}

pub(super) fn of_circles(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "c1Center")?, d.point(tool, "c2Center")?);
    let (r, s) = (d.formula(tool, "c1Radius")?, d.formula(tool, "c2Radius")?);
    let met = circles(a, r.abs(), b, s.abs());
    met.map(|both| chosen(tool, both)).ok_or_else(|| d.impossible(tool, "its circles do not meet"))
}

/// Where the tangents from a point touch a circle: first the one to the right of the way from the
/// point to the centre.
fn touched(p: Point, centre: Point, radius: f64) -> Option<[Point; 2]> {
    let far = (centre - p).hypot();
    match far - radius {
        gap if gap.abs() <= 1e-9 * radius.max(1.0) => Some([p, p]),
        gap if gap < 0.0 => None,
        _ => circles(p, (far * far - radius * radius).max(0.0).sqrt(), centre, radius),
    }
}

const WITHIN: &str = "its point lies within the circle, which no tangent from there touches";

pub(super) fn of_circle_and_tangent(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (p, centre) = (d.point(tool, "tangent")?, d.point(tool, "cCenter")?);
    let radius = d.formula(tool, "cRadius")?.abs();
    let met = touched(p, centre, radius);
    met.map(|both| chosen(tool, both)).ok_or_else(|| d.impossible(tool, WITHIN))
}

pub(super) fn of_arc_and_tangent(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let p = d.point(tool, "tangent")?;
    let drawn = d.curve(tool, "arc")?;
    let [DraftStroke::Arc(arc)] = drawn.curve.strokes[..] else {
        return Err(d.impossible(tool, "its curve is no arc of a circle"));
    };
    let Some(both) = touched(p, arc.centre, arc.radius) else { return Err(d.impossible(tool, WITHIN)) };
    on_all(tool, both, &[&drawn])
        .ok_or_else(|| d.impossible(tool, "no tangent from its point touches the arc"))
}

/// The point that a tool asks for; the other where that one does not lie on the curves.
fn on_all(tool: &DraftTool<'_, '_>, both: [Point; 2], curves: &[&DrawnCurve]) -> Option<Point> {
    let on = |p: &Point| curves.iter().all(|c| c.curve.nearest(*p).0 <= 1e-6);
    let wanted = chosen(tool, both);
    std::iter::once(wanted).chain(both).find(on)
}

pub(super) fn of_arcs(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (one, other) = (d.curve(tool, "firstArc")?, d.curve(tool, "secondArc")?);
    let ([DraftStroke::Arc(a)], [DraftStroke::Arc(b)]) = (&one.curve.strokes[..], &other.curve.strokes[..])
    else {
        return Err(d.impossible(tool, "its curves are no arcs of circles"));
    };
    let met = circles(a.centre, a.radius, b.centre, b.radius);
    let at = met.and_then(|both| on_all(tool, both, &[&one, &other]));
    let at = at.ok_or_else(|| d.impossible(tool, "its arcs do not meet"))?;
    meet(d, tool, at, &[one, other]);
    Ok(())
}

/// Of several meetings the highest or the lowest, of those the leftmost or the rightmost.
pub(super) fn of_curves(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (one, other) = (d.curve(tool, "curve1")?, d.curve(tool, "curve2")?);
    let (lowest, rightmost) = (tool.name("vCrossPoint") == "2", tool.name("hCrossPoint") == "2");
    let before = |p: &Point, q: &Point| {
        let up = if lowest { p.y - q.y } else { q.y - p.y };
        let across = if rightmost { q.x - p.x } else { p.x - q.x };
        let by = if up.abs() > 1e-6 { up } else { across };
        by.total_cmp(&0.0)
    };
    let met = crossings(&one.curve, &other.curve, &mut d.boxes).into_iter().min_by(before);
    let at = met.ok_or_else(|| d.impossible(tool, "its curves do not meet"))?;
    meet(d, tool, at, &[one, other]);
    Ok(())
}

pub(super) fn of_curve_and_axis(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (from, degrees) = (d.point(tool, "basePoint")?, d.formula(tool, "angle")?);
    let drawn = d.curve(tool, "curve")?;
    let at = on_ray(&drawn.curve, from, degrees)
        .ok_or_else(|| d.impossible(tool, "its curve and its axis do not meet"))?;
    meet(d, tool, at, &[drawn]);
    Ok(())
}

/// Puts the point, and the parts into which it cuts the curves.
fn meet(d: &mut Drafting, tool: &DraftTool<'_, '_>, at: Point, curves: &[DrawnCurve]) {
    d.put_point(tool.id(), tool.name("name"), at);
    for (k, drawn) in curves.iter().enumerate() {
        let along = drawn.curve.nearest(at).1;
        cuts::put_parts(d, tool, drawn, along, k);
    }
}

/// Whether a curve is an arc of a circle or of an ellipse.
pub(super) fn is_arc(drawn: &DrawnCurve) -> bool {
    matches!(drawn.family, CurveFamily::Arc | CurveFamily::Ellipse)
}

//! Tools that draw one point from points and lengths.
//!
//! Angles are counter-clockwise from the x axis, degrees; y runs up, while the file counts it down.

use super::super::plane::{angle, direction, foot, line_and_circle, lines};
use super::drafting::{DraftTool, Drafting};
use super::values::Failed;
use super::{cuts, darts, meetings};
use kurbo::{Point, Vec2};

/// Draws the point of a tool.
pub(super) fn point(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let at = match tool.kind() {
        "single" => Point::new(d.figure(tool, "x", 0.0)?, -d.figure(tool, "y", 0.0)?),
        "endLine" => {
            d.point(tool, "basePoint")? + direction(d.formula(tool, "angle")?) * d.formula(tool, "length")?
        }
        "alongLine" => along_line(d, tool)?,
        "shoulder" => shoulder(d, tool)?,
        "normal" => normal(d, tool)?,
        "bisector" => bisector(d, tool)?,
        "lineIntersect" => line_intersect(d, tool)?,
        "lineIntersectAxis" => line_intersect_axis(d, tool)?,
        "height" => height(d, tool)?,
        "triangle" => triangle(d, tool)?,
        // The same tool of Valentina and of Seamly2D.
        "pointOfIntersection" | "intersectXY" => {
            Point::new(d.point(tool, "firstPoint")?.x, d.point(tool, "secondPoint")?.y)
        }
        // The older and the newer name of one tool.
        "contact" | "pointOfContact" => contact(d, tool)?,
        "pointOfIntersectionCircles" => meetings::of_circles(d, tool)?,
        "pointFromCircleAndTangent" => meetings::of_circle_and_tangent(d, tool)?,
        "pointFromArcAndTangent" => meetings::of_arc_and_tangent(d, tool)?,
        "pointOfIntersectionArcs" => return meetings::of_arcs(d, tool),
        "pointOfIntersectionCurves" => return meetings::of_curves(d, tool),
        "curveIntersectAxis" => return meetings::of_curve_and_axis(d, tool),
        "cutSpline" | "cutSplinePath" | "cutArc" => return cuts::cut(d, tool),
        "trueDarts" => return darts::true_darts(d, tool),
        _ => return Err(d.unsupported(tool)),
    };
    d.put_point(tool.id(), tool.name("name"), at);
    Ok(())
}

/// The direction from one point to another.
fn way(d: &mut Drafting, tool: &DraftTool<'_, '_>, a: Point, b: Point) -> Result<Vec2, Failed> {
    match (b - a).hypot() {
        length if length > 1e-12 => Ok((b - a) / length),
        _ => Err(d.impossible(tool, "its two points lie on each other and give no direction")),
    }
}

fn along_line(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "firstPoint")?, d.point(tool, "secondPoint")?);
    d.values.current = Some((b - a).hypot());
    let length = d.formula(tool, "length");
    d.values.current = None;
    let length = length?;
    if length == 0.0 {
        return Ok(a);
    }
    Ok(a + way(d, tool, a, b)? * length)
}

/// The point beyond the end of a line that is so far from the shoulder's point; the line's end
/// where there is none.
fn shoulder(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "p1Line")?, d.point(tool, "p2Line")?);
    let (from, length) = (d.point(tool, "pShoulder")?, d.formula(tool, "length")?);
    let ahead = way(d, tool, a, b)?;
    let met = line_and_circle(a, ahead, from, length.max(0.0)).map(|[far, _]| far);
    match met.filter(|p| (*p - b).dot(ahead) > 0.0) {
        Some(p) => Ok(p),
        None => {
            d.warnings.push(format!(
                "{}: its length does not reach beyond the line: its point lies at the end of the line",
                tool.place
            ));
            Ok(b)
        }
    }
}

fn normal(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "firstPoint")?, d.point(tool, "secondPoint")?);
    let (length, turned) = (d.formula(tool, "length")?, d.formula_or(tool, "angle", 0.0)?);
    let left = angle(way(d, tool, a, b)?) + 90.0;
    Ok(a + direction(left + turned) * length)
}

/// On the line that halves the smaller angle at the second point.
fn bisector(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "firstPoint")?, d.point(tool, "secondPoint")?);
    let (c, length) = (d.point(tool, "thirdPoint")?, d.formula(tool, "length")?);
    let (one, other) = (angle(way(d, tool, b, a)?), angle(way(d, tool, b, c)?));
    let between = (other - one).rem_euclid(360.0);
    let halved = if between > 180.0 { one - (360.0 - between) / 2.0 } else { one + between / 2.0 };
    Ok(b + direction(halved) * length)
}

fn line_intersect(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "p1Line1")?, d.point(tool, "p2Line1")?);
    let (e, f) = (d.point(tool, "p1Line2")?, d.point(tool, "p2Line2")?);
    lines(a, b - a, e, f - e).ok_or_else(|| d.impossible(tool, "its lines are parallel and do not meet"))
}

fn line_intersect_axis(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (from, axis) = (d.point(tool, "basePoint")?, direction(d.formula(tool, "angle")?));
    let (a, b) = (d.point(tool, "p1Line")?, d.point(tool, "p2Line")?);
    lines(from, axis, a, b - a)
        .ok_or_else(|| d.impossible(tool, "its line and its axis are parallel and do not meet"))
}

fn height(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let p = d.point(tool, "basePoint")?;
    let (a, b) = (d.point(tool, "p1Line")?, d.point(tool, "p2Line")?);
    foot(a, b, p).ok_or_else(|| d.impossible(tool, "its two points lie on each other and give no direction"))
}

/// The point ahead on the axis from which the hypotenuse is seen under a right angle, which lies on
/// the circle over it.
fn triangle(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "axisP1")?, d.point(tool, "axisP2")?);
    let (e, f) = (d.point(tool, "firstPoint")?, d.point(tool, "secondPoint")?);
    let start = lines(a, b - a, e, f - e)
        .ok_or_else(|| d.impossible(tool, "its axis and its hypotenuse are parallel and do not meet"))?;
    let middle = e.midpoint(f);
    let met = line_and_circle(start, b - a, middle, (f - e).hypot() / 2.0);
    Ok(met.map(|[ahead, _]| ahead).filter(|p| (*p - start).dot(b - a) > 0.0).unwrap_or(start))
}

/// Where a line meets a circle: on the line between its points if it can be, else the meeting that
/// is nearer to the first.
fn contact(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<Point, Failed> {
    let (a, b) = (d.point(tool, "firstPoint")?, d.point(tool, "secondPoint")?);
    let (centre, radius) = (d.point(tool, "center")?, d.formula(tool, "radius")?);
    let u = way(d, tool, a, b)?;
    let Some(both) = line_and_circle(a, u, centre, radius.abs()) else {
        return Err(d.impossible(tool, "its line and its circle do not meet"));
    };
    let length = (b - a).hypot();
    let on = |p: &Point| (-1e-6..=length + 1e-6).contains(&(*p - a).dot(u));
    let far = |p: &Point| (*p - a).hypot();
    let between: Vec<Point> = both.into_iter().filter(on).collect();
    let of = if between.is_empty() { both.to_vec() } else { between };
    Ok(of.into_iter().min_by(|p, q| far(p).total_cmp(&far(q))).unwrap_or(a))
}

//! Tools that draw arcs and curves.

use super::super::plane::{DraftCurve, DraftStroke, direction};
use super::super::source::{attribute, children};
use super::drafting::{DraftTool, Drafting};
use super::object::{CurveFamily, DrawnCurve};
use super::values::Failed;
use kurbo::{CubicBez, Point};

/// Points of a path.
const MOST_POINTS: usize = 200;
/// Halvings by which the end of an arc of an ellipse is found from its length.
const HALVINGS: usize = 60;

pub(super) fn arc(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (name, centre) = d.named_point(tool, "center")?;
    let (radius, from) = (d.formula(tool, "radius")?, d.formula(tool, "angle1")?);
    let curve = match tool.kind() {
        "arcWithLength" => {
            let length = d.formula(tool, "length")?;
            if radius == 0.0 || length == 0.0 {
                return Err(d.impossible(tool, "its radius or its length is 0"));
            }
            DraftCurve::arc_of_length(centre, radius, from, length)
        }
        "simple" | "" => {
            let to = d.formula(tool, "angle2")?;
            if radius == 0.0 {
                return Err(d.impossible(tool, "its radius is 0"));
            }
            DraftCurve::arc(centre, radius, [from, to])
        }
        _ => return Err(d.unsupported(tool)),
    };
    put(
        d,
        tool,
        DrawnCurve { curve, family: CurveFamily::Arc, name: String::new(), centre: name, angles: None },
    );
    Ok(())
}

pub(super) fn ellipse(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (name, centre) = d.named_point(tool, "center")?;
    let radii = [d.formula(tool, "radius1")?, d.formula(tool, "radius2")?];
    let from = d.formula(tool, "angle1")?;
    let turned = d.formula_or(tool, "rotationAngle", 0.0)?;
    if radii.contains(&0.0) {
        return Err(d.impossible(tool, "one of its radii is 0"));
    }
    let to = match tool.kind() {
        "ellipticalArcWithLength" => {
            let length = d.formula(tool, "length")?;
            ellipse_end(centre, radii, from, length)
        }
        "simple" | "" => d.formula(tool, "angle2")?,
        _ => return Err(d.unsupported(tool)),
    };
    let curve = DraftCurve::ellipse(centre, radii, [from, to], turned);
    let angles = Some([from, to].map(|a| a.rem_euclid(360.0)));
    let own = format!("ElArc_{name}_{}", tool.id().unwrap_or(0));
    for (word, value) in [("Radius1", radii[0].abs()), ("Radius2", radii[1].abs()), ("Rotation", turned)] {
        d.values.set(format!("{word}{own}"), value);
    }
    put(
        d,
        tool,
        DrawnCurve { curve, family: CurveFamily::Ellipse, name: String::new(), centre: name, angles },
    );
    Ok(())
}

/// The angle at which an arc of an ellipse is as long as that.
fn ellipse_end(centre: Point, radii: [f64; 2], from: f64, length: f64) -> f64 {
    let backwards = length < 0.0 || radii.iter().any(|r| *r < 0.0);
    let radii = radii.map(|r| if backwards { -r.abs() } else { r });
    let (mut low, mut high) = (0.0, 360.0);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        let turned = if backwards { -middle } else { middle };
        let long = DraftCurve::ellipse(centre, radii, [from, from + turned], 0.0).length();
        if long < length.abs() { low = middle } else { high = middle }
    }
    from + if backwards { -low } else { low }
}

fn put(d: &mut Drafting, tool: &DraftTool<'_, '_>, drawn: DrawnCurve) {
    let Some(id) = tool.id() else { return };
    let more = attribute(tool.node, "duplicate").filter(|n| *n != "0");
    let more = more.map_or_else(String::new, |n| format!("_{n}"));
    if drawn.family == CurveFamily::Path {
        d.name_parts(&drawn, &more);
    }
    d.put_curve(id, drawn, &[tool.name("alias")], &more);
}

pub(super) fn spline(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    if path_points(tool).len() > MOST_POINTS {
        return Err(d.impossible(tool, "its path has more than 200 points"));
    }
    let (curve, family) = match tool.kind() {
        "simple" | "" => (simple(d, tool)?, CurveFamily::Spline),
        "simpleInteractive" => (interactive(d, tool)?, CurveFamily::Spline),
        "cubicBezier" => (bezier(d, tool)?, CurveFamily::Spline),
        "path" => (path(d, tool)?, CurveFamily::Path),
        "pathInteractive" => (interactive_path(d, tool)?, CurveFamily::Path),
        "cubicBezierPath" => (bezier_path(d, tool)?, CurveFamily::Path),
        _ => return Err(d.unsupported(tool)),
    };
    put(d, tool, DrawnCurve { curve, family, name: String::new(), centre: String::new(), angles: None });
    Ok(())
}

/// The length of a control line of an older curve: that by which two of them, each at half a right
/// angle to the line between the ends, make nearly a quarter of a circle.
fn control_length(a: Point, b: Point, curved: f64) -> f64 {
    let radius = (b - a).hypot() / std::f64::consts::SQRT_2;
    curved * radius * 4.0 / 3.0 * (std::f64::consts::PI / 8.0).tan()
}

/// Ends and control lines, each an angle and a length.
fn handled(a: Point, b: Point, one: (f64, f64), other: (f64, f64)) -> DraftStroke {
    DraftStroke::Cubic(CubicBez::new(a, a + direction(one.0) * one.1, b + direction(other.0) * other.1, b))
}

fn simple(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let ((from, a), (to, b)) = (d.named_point(tool, "point1")?, d.named_point(tool, "point4")?);
    let length = control_length(a, b, d.figure(tool, "kCurve", 1.0)?);
    let one = (d.formula(tool, "angle1")?, length * d.figure(tool, "kAsm1", 1.0)?);
    let other = (d.formula(tool, "angle2")?, length * d.figure(tool, "kAsm2", 1.0)?);
    Ok(DraftCurve::single(handled(a, b, one, other), &from, &to))
}

fn interactive(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let ((from, a), (to, b)) = (d.named_point(tool, "point1")?, d.named_point(tool, "point4")?);
    let one = (d.formula(tool, "angle1")?, d.formula(tool, "length1")?);
    let other = (d.formula(tool, "angle2")?, d.formula(tool, "length2")?);
    Ok(DraftCurve::single(handled(a, b, one, other), &from, &to))
}

fn bezier(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let ((from, a), (to, b)) = (d.named_point(tool, "point1")?, d.named_point(tool, "point4")?);
    let (c, e) = (d.point(tool, "point2")?, d.point(tool, "point3")?);
    Ok(DraftCurve::single(DraftStroke::Cubic(CubicBez::new(a, c, e, b)), &from, &to))
}

/// A point of a path with the control lines before and behind it.
struct PathPoint {
    name: String,
    at: Point,
    before: (f64, f64),
    behind: (f64, f64),
}

fn chain(d: &mut Drafting, tool: &DraftTool<'_, '_>, points: &[PathPoint]) -> Result<DraftCurve, Failed> {
    if points.len() < 2 {
        return Err(d.impossible(tool, "its path has less than two points"));
    }
    let strokes = points.windows(2).map(|w| handled(w[0].at, w[1].at, w[0].behind, w[1].before)).collect();
    Ok(DraftCurve::new(strokes, points.iter().map(|p| p.name.clone()).collect()))
}

/// The points of a path as tools, so that their formulas and points are asked for as those of tools
/// are.
fn path_points<'a, 't>(tool: &DraftTool<'a, 't>) -> Vec<DraftTool<'a, 't>> {
    let one = |node| DraftTool { node, place: tool.place.clone() };
    children(tool.node, &["pathPoint"]).map(one).collect()
}

/// An older path: an angle at each point, and factors of the lengths of its control lines.
fn path(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let curved = d.figure(tool, "kCurve", 1.0)?;
    let mut points = Vec::new();
    for p in path_points(tool) {
        let (name, at) = d.named_point(&p, "pSpline")?;
        let angle = d.formula_or(&p, "angle", 0.0)?;
        let (one, other) = (d.figure(&p, "kAsm1", 1.0)?, d.figure(&p, "kAsm2", 1.0)?);
        points.push(PathPoint { name, at, before: (angle + 180.0, one), behind: (angle, other) });
    }
    let ends: Vec<Point> = points.iter().map(|p| p.at).collect();
    for (k, w) in ends.windows(2).enumerate() {
        let length = control_length(w[0], w[1], curved);
        points[k].behind.1 *= length;
        points[k + 1].before.1 *= length;
    }
    chain(d, tool, &points)
}

fn interactive_path(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let mut points = Vec::new();
    for p in path_points(tool) {
        let (name, at) = d.named_point(&p, "pSpline")?;
        let before = (d.formula_or(&p, "angle1", 0.0)?, d.formula_or(&p, "length1", 0.0)?);
        let behind = (d.formula_or(&p, "angle2", 0.0)?, d.formula_or(&p, "length2", 0.0)?);
        points.push(PathPoint { name, at, before, behind });
    }
    chain(d, tool, &points)
}

/// Every third point is on the curve, the two between them are control points.
fn bezier_path(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<DraftCurve, Failed> {
    let mut points = Vec::new();
    for p in path_points(tool) {
        points.push(d.named_point(&p, "pSpline")?);
    }
    if points.len() < 4 || points.len() % 3 != 1 {
        return Err(d.impossible(tool, "its path has no 4, 7, 10, ... points"));
    }
    let cubic = |w: &[(String, Point)]| DraftStroke::Cubic(CubicBez::new(w[0].1, w[1].1, w[2].1, w[3].1));
    let strokes = (0..points.len() - 1).step_by(3).map(|k| cubic(&points[k..k + 4])).collect();
    let labels = points.iter().step_by(3).map(|p| p.0.clone()).collect();
    Ok(DraftCurve::new(strokes, labels))
}

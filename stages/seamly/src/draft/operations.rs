//! Tools that draw points and curves again: turned, mirrored, moved.
//!
//! What an operation draws stands in the file in the order of what it is drawn from.

use super::super::plane::{angle, direction};
use super::super::source::{attribute, children, number};
use super::drafting::{DraftTool, Drafting};
use super::meetings::is_arc;
use super::object::{DraftObject, DrawnCurve};
use super::values::Failed;
use kurbo::{Affine, Point, Rect, Vec2};

pub(super) fn operation(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let sources: Vec<(u32, String)> = children(tool.node, &["source"])
        .flat_map(|n| children(n, &["item"]))
        .filter_map(|n| {
            let name = attribute(n, "name").or_else(|| attribute(n, "alias")).unwrap_or("");
            Some((number(n, "idObject")?, name.to_owned()))
        })
        .collect();
    let by = movement(d, tool, &sources)?;
    let suffix = tool.name("suffix");
    let targets: Vec<u32> = super::destinations(tool.node).collect();
    for ((source, name), target) in sources.into_iter().zip(targets) {
        match d.object_of(&tool.place, "idObject", source) {
            Ok(DraftObject::Point { name: own, at }) => {
                let name = if name.is_empty() { format!("{own}{suffix}") } else { name };
                d.put_point(Some(target), name, by * at);
            }
            Ok(DraftObject::Curve(drawn)) => put_moved(d, target, &drawn, by, &suffix, name),
            // What fails on its own is lost alone.
            Ok(DraftObject::Failed(why)) | Err(why) => {
                d.objects.insert(target, DraftObject::Failed(why));
                d.values.lose(&name, why);
            }
        }
    }
    Ok(())
}

fn put_moved(d: &mut Drafting, target: u32, drawn: &DrawnCurve, by: Affine, suffix: &str, name: String) {
    let curve = drawn.curve.moved(by, suffix);
    let angles = match is_arc(drawn) {
        true => drawn.angles.map(|both| both.map(|a| turned(by, a))),
        false => None,
    };
    // The whole name of a curve that is moved gets the suffix.
    let own = format!("{}{suffix}", drawn.name);
    let moved = DrawnCurve { curve, angles, name: own.clone(), ..drawn.clone() };
    d.put_curve(target, moved, &[name, own], "");
}

/// The angle of a direction that is moved, degrees.
fn turned(by: Affine, degrees: f64) -> f64 {
    let way = by * direction(degrees).to_point() - by * Point::ZERO;
    angle(way)
}

/// How an operation moves what it is applied to.
fn movement(d: &mut Drafting, tool: &DraftTool<'_, '_>, sources: &[(u32, String)]) -> Result<Affine, Failed> {
    match tool.kind() {
        "rotation" => {
            let (centre, by) = (d.point(tool, "center")?, d.formula(tool, "angle")?);
            Ok(turn(by, centre))
        }
        "flippingByLine" => {
            let (a, b) = (d.point(tool, "p1Line")?, d.point(tool, "p2Line")?);
            mirror(d, tool, a, b - a)
        }
        "flippingByAxis" => {
            let centre = d.point(tool, "center")?;
            let axis = if tool.name("axisType") == "2" { Vec2::new(1.0, 0.0) } else { Vec2::new(0.0, 1.0) };
            mirror(d, tool, centre, axis)
        }
        "moving" => {
            let way = direction(d.formula_or(tool, "angle", 0.0)?) * d.formula_or(tool, "length", 0.0)?;
            let turned = d.formula_or(tool, "rotationAngle", 0.0)?;
            let shifted = Affine::translate(way);
            if turned == 0.0 {
                return Ok(shifted);
            }
            let centre = match number(tool.node, "center").filter(|id| *id > 0) {
                Some(_) => d.point(tool, "center")?,
                None => middle(d, sources) + way,
            };
            Ok(turn(turned, centre) * shifted)
        }
        _ => Err(d.unsupported(tool)),
    }
}

/// Turns by an angle, exactly where that is a multiple of a right angle.
fn turn(degrees: f64, centre: Point) -> Affine {
    let way = direction(degrees);
    let about = Affine::new([way.x, way.y, -way.y, way.x, 0.0, 0.0]);
    Affine::translate(centre.to_vec2()) * about * Affine::translate(-centre.to_vec2())
}

fn mirror(d: &mut Drafting, tool: &DraftTool<'_, '_>, at: Point, way: Vec2) -> Result<Affine, Failed> {
    match way.hypot() > 1e-12 {
        true => Ok(Affine::reflect(at, way)),
        false => Err(d.impossible(tool, "its two points lie on each other and give no direction")),
    }
}

/// The middle of the box around what is moved.
fn middle(d: &Drafting, sources: &[(u32, String)]) -> Point {
    let mut all: Vec<Point> = Vec::new();
    for (id, _) in sources {
        match d.objects.get(id) {
            Some(DraftObject::Point { at, .. }) => all.push(*at),
            Some(DraftObject::Curve(drawn)) => {
                let fine =
                    drawn.curve.strokes.iter().flat_map(|s| (0..=32).map(|k| s.at(f64::from(k) / 32.0)));
                all.extend(fine);
            }
            Some(DraftObject::Failed(_)) | None => {}
        }
    }
    let Some(first) = all.first() else { return Point::ZERO };
    all.iter().fold(Rect::from_points(*first, *first), |r, p| r.union_pt(*p)).center()
}

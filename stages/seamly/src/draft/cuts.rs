//! Tools that cut a curve in two at a length.
//!
//! The parts have the two numbers after that of the tool where the file gives them none.

use super::super::source::{attribute, number};
use super::drafting::{DraftTool, Drafting};
use super::object::DrawnCurve;
use super::values::Failed;
use roxmltree::Node;

/// Cut lengths nearer than this share to an end are told.
const AT_END: f64 = 1e-9;

/// Whether a tool cuts a curve into parts that the file may not number.
pub(super) fn has_parts(node: Node<'_, '_>) -> bool {
    matches!(attribute(node, "type"), Some("cutSpline" | "cutSplinePath" | "cutArc" | "curveIntersectAxis"))
        && number(node, "segment1Id").is_none()
}

pub(super) fn cut(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let which = ["spline", "splinePath", "arc", "elArc", "curve"];
    let which = which.into_iter().find(|name| attribute(tool.node, name).is_some()).unwrap_or("curve");
    let drawn = d.curve(tool, which)?;
    let whole = drawn.curve.length();
    d.values.current = Some(whole);
    let length = d.formula(tool, "length");
    d.values.current = None;
    let length = length?;
    // A length below 0 counts from the end.
    let along = if length < 0.0 { whole + length } else { length };
    if along < -AT_END * whole || along > whole * (1.0 + AT_END) {
        d.warnings.push(format!(
            "{}: it cuts at {length:.3}, and the curve is {whole:.3} long: cut at its end",
            tool.place
        ));
    }
    let along = along.clamp(0.0, whole);
    d.put_point(tool.id(), tool.name("name"), drawn.curve.at(along));
    put_parts(d, tool, &drawn, along, 0);
    Ok(())
}

/// Puts the two parts of the first or the second curve of a tool.
pub(super) fn put_parts(
    d: &mut Drafting,
    tool: &DraftTool<'_, '_>,
    drawn: &DrawnCurve,
    along: f64,
    curve: usize,
) {
    let ids = match curve {
        0 => ["segment1Id", "segment2Id"],
        _ => ["segment3Id", "segment4Id"],
    };
    let mut ids = ids.map(|name| number(tool.node, name));
    if has_parts(tool.node) {
        ids = [1, 2].map(|k| tool.id().map(|id| id.saturating_add(k)));
    }
    let given = match (tool.kind(), curve) {
        ("pointOfIntersectionCurves" | "pointOfIntersectionArcs", 0) => ["curve1Name1", "curve1Name2"],
        ("pointOfIntersectionCurves" | "pointOfIntersectionArcs", _) => ["curve2Name1", "curve2Name2"],
        _ => ["name1", "name2"],
    };
    let aliases = if curve == 0 { ["alias1", "alias2"] } else { ["curve2Alias1", "curve2Alias2"] };
    let parts = drawn.curve.cut(along, &tool.name("name"));
    for (k, part) in parts.into_iter().enumerate() {
        let Some(id) = ids[k] else { continue };
        let part = DrawnCurve { curve: part, angles: None, name: String::new(), ..drawn.clone() };
        d.put_curve(id, part, &[tool.name(given[k]), tool.name(aliases[k])], "");
    }
}

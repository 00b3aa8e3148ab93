//! The fields of a GarmentCode file, each of its type and within its bounds; what they mean is not
//! looked at yet.

use super::damage::SpecificationDamage;
use super::json::Json;
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// Panels of one file.
const MOST_PANELS: usize = 500;
/// Edges of all panels, and vertices.
const MOST_EDGES: usize = 5_000;
/// Stitches of one file.
const MOST_STITCHES: usize = 2_000;
/// Coordinates in the file's units.
const FARTHEST: f64 = 1e6;

/// A file in its own units.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawFile {
    /// Units in a metre, where the file says.
    pub units: Option<f64>,
    /// Whether control points are given in the panel's coordinates, not relative to the edge's
    /// chord.
    pub absolute: bool,
    pub panels: Vec<RawPanel>,
    pub stitches: Vec<RawStitch>,
    /// What is wrong, in the order of the file; panels and stitches at fault are not among the
    /// others, nor stitches of such panels.
    pub faults: Vec<SpecificationDamage>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawPanel {
    pub name: String,
    pub translation: Vector3,
    /// Euler angles, degrees.
    pub rotation: Vector3,
    pub vertices: Vec<Point2>,
    pub edges: Vec<RawEdge>,
    pub label: Option<String>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawEdge {
    /// The vertices at its start and end.
    pub ends: [usize; 2],
    pub curve: RawCurve,
    /// What it is called: by its label, or where the format's own label would say something else,
    /// by its name.
    pub label: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RawCurve {
    Line,
    Quadratic([Point2; 1]),
    Cubic([Point2; 2]),
    Circle { radius: f64, large: bool, right: bool },
}

/// An edge of a panel, both by their numbers.
pub(super) type PanelEdge = (usize, usize);

#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawStitch {
    /// Its number in the file.
    pub number: usize,
    pub sides: [PanelEdge; 2],
    /// Whether start meets start.
    pub right_wrong: bool,
}

impl RawFile {
    /// Errors: what leaves nothing to look at.
    pub(super) fn of(json: &Json) -> Result<Self, SpecificationDamage> {
        let pattern = object(json, "pattern", "the file")?;
        let mut faults = Vec::new();
        let properties = json.field("properties").filter(|p| **p != Json::Null);
        let units = properties.and_then(|p| p.field("units_in_meter")).filter(|u| **u != Json::Null);
        let units = units.and_then(|u| kept(number(u, "`units_in_meter`"), &mut faults));
        let sound = |value: &f64| *value > 0.0 && *value <= FARTHEST;
        faults.extend(units.filter(|u| !sound(u)).map(|value| SpecificationDamage::Units { value }));
        let coordinates = match properties.and_then(|p| p.field("curvature_coords")) {
            None | Some(Json::Null) => Ok(false),
            Some(Json::Text(word)) if word == "relative" => Ok(false),
            Some(Json::Text(word)) if word == "absolute" => Ok(true),
            Some(Json::Text(word)) => Err(SpecificationDamage::Coordinates { word: short(word) }),
            Some(other) => Err(wrong("`curvature_coords`", other, "a text")),
        };
        let absolute = kept(coordinates, &mut faults).unwrap_or(false);
        let known = panels(pattern, &mut faults)?;
        order(pattern, &known, &mut faults);
        let stitches = list(pattern, "stitches", "`pattern`").and_then(|found| {
            most("stitches", "the file", found.len(), MOST_STITCHES)?;
            Ok(found)
        });
        let stitches = kept(stitches, &mut faults).unwrap_or_default();
        let stitches = stitches.iter().enumerate().filter_map(|(i, s)| stitch(i, s, &known, &mut faults));
        let stitches: Vec<RawStitch> = stitches.collect();
        Ok(RawFile { units: units.filter(sound), absolute, panels: sound_panels(known), stitches, faults })
    }
}

/// What was read; a fault goes to the others.
fn kept<T>(read: Result<T, SpecificationDamage>, faults: &mut Vec<SpecificationDamage>) -> Option<T> {
    read.map_err(|damage| faults.push(damage)).ok()
}

/// A panel that the file has.
struct KnownPanel {
    name: String,
    /// The panel and its number among those without faults; none where it has a fault.
    sound: Option<(usize, RawPanel)>,
}

fn sound_panels(known: Vec<KnownPanel>) -> Vec<RawPanel> {
    known.into_iter().filter_map(|k| k.sound).map(|(_, panel)| panel).collect()
}

fn panels(
    pattern: &Json,
    faults: &mut Vec<SpecificationDamage>,
) -> Result<Vec<KnownPanel>, SpecificationDamage> {
    let Json::Object(fields) = object(pattern, "panels", "`pattern`")? else {
        return Err(SpecificationDamage::NoPanels);
    };
    if fields.is_empty() {
        return Err(SpecificationDamage::NoPanels);
    }
    most("panels", "the file", fields.len(), MOST_PANELS)?;
    let mut names = BTreeSet::new();
    let (mut out, mut edges, mut vertices, mut count) = (Vec::new(), 0, 0, 0);
    for (name, value) in fields {
        if !names.insert(name) {
            faults.push(SpecificationDamage::Doubled { panel: short(name) });
            continue;
        }
        let sound = panel(name, value, faults).map(|panel| (count, panel));
        if let Some((_, panel)) = &sound {
            count += 1;
            (edges, vertices) = (edges + panel.edges.len(), vertices + panel.vertices.len());
            most("edges", "the file", edges, MOST_EDGES)?;
            most("vertices", "the file", vertices, MOST_EDGES)?;
        }
        out.push(KnownPanel { name: name.clone(), sound });
    }
    Ok(out)
}

/// Every panel that the file's order of panels names is there.
fn order(pattern: &Json, panels: &[KnownPanel], faults: &mut Vec<SpecificationDamage>) {
    let Some(Json::List(order)) = pattern.field("panel_order") else { return };
    let known: BTreeSet<&str> = panels.iter().map(|p| p.name.as_str()).collect();
    let missing = order.iter().filter_map(|n| match n {
        Json::Text(name) if !known.contains(name.as_str()) => Some(name),
        _ => None,
    });
    faults.extend(missing.map(|panel| SpecificationDamage::MissingPanel { panel: short(panel) }));
}

/// The panel, where nothing of it is at fault.
fn panel(name: &str, value: &Json, faults: &mut Vec<SpecificationDamage>) -> Option<RawPanel> {
    let before = faults.len();
    let at = format!("panel \"{}\"", short(name));
    let three = |field: &str| -> Result<Vector3, SpecificationDamage> {
        let [x, y, z] = numbers(part(value, field, &at)?, &format!("`{field}` of {at}"))?;
        Ok(Vector3::new(x, y, z))
    };
    let listed = |field: &'static str| {
        let found = list(value, field, &at)?;
        most(field, &at, found.len(), MOST_EDGES)?;
        Ok(found)
    };
    let vertices = kept(listed("vertices"), faults)?;
    let vertex = |(i, v): (usize, &Json)| point(v, &format!("vertex {i} of {at}"));
    let points = vertices.iter().enumerate().filter_map(|v| kept(vertex(v), faults)).collect();
    let edges = kept(listed("edges"), faults)?;
    if edges.len() < 2 {
        faults.push(SpecificationDamage::FewEdges { panel: short(name), edges: edges.len() });
    }
    let edges = edges.iter().enumerate().filter_map(|(i, e)| kept(edge(i, e, name, vertices.len()), faults));
    let edges = edges.collect();
    let (translation, rotation) = (kept(three("translation"), faults), kept(three("rotation"), faults));
    if faults.len() > before {
        return None;
    }
    Some(RawPanel {
        name: name.to_owned(),
        translation: translation?,
        rotation: rotation?,
        vertices: points,
        edges,
        label: text(value, "label"),
    })
}

fn edge(i: usize, value: &Json, panel: &str, count: usize) -> Result<RawEdge, SpecificationDamage> {
    let at = format!("edge {i} of panel \"{}\"", short(panel));
    let ends: [f64; 2] = numbers(part(value, "endpoints", &at)?, &format!("`endpoints` of {at}"))?;
    let vertex = |n: f64| match n >= 0.0 && n.fract() == 0.0 && n < count as f64 {
        true => Ok(n as usize),
        false => Err(SpecificationDamage::NoVertex { panel: short(panel), edge: i, vertex: n, count }),
    };
    let curve = match value.field("curvature") {
        None | Some(Json::Null) => RawCurve::Line,
        Some(c) => curve(i, c, panel, &at)?,
    };
    Ok(RawEdge {
        ends: [vertex(ends[0])?, vertex(ends[1])?],
        curve,
        label: text(value, "label").or_else(|| text(value, "name")),
    })
}

fn curve(i: usize, value: &Json, panel: &str, at: &str) -> Result<RawCurve, SpecificationDamage> {
    let of = format!("curvature of {at}");
    if let Json::List(_) = value {
        return Ok(RawCurve::Quadratic([point(value, &of)?]));
    }
    let Json::Text(kind) = part(value, "type", &of)? else {
        return Err(wrong(&format!("`type` of the {of}"), value, "a text"));
    };
    let params = list(value, "params", &of)?;
    let flag = |v: &Json| match v {
        Json::Flag(flag) => Ok(*flag),
        other => number(other, &format!("a flag of the {of}")).map(|n| n != 0.0),
    };
    match (kind.as_str(), params) {
        ("quadratic", [a]) => Ok(RawCurve::Quadratic([point(a, &of)?])),
        ("cubic", [a, b]) => Ok(RawCurve::Cubic([point(a, &of)?, point(b, &of)?])),
        ("circle", [radius, large, right]) => Ok(RawCurve::Circle {
            radius: within(number(radius, &format!("radius of {at}"))?, &format!("radius of {at}"))?,
            large: flag(large)?,
            right: flag(right)?,
        }),
        _ => Err(SpecificationDamage::Curvature {
            panel: short(panel),
            edge: i,
            kind: short(kind),
            params: params.len(),
        }),
    }
}

/// The stitch; none where it is at fault, or a panel of it is.
fn stitch(
    i: usize,
    value: &Json,
    panels: &[KnownPanel],
    faults: &mut Vec<SpecificationDamage>,
) -> Option<RawStitch> {
    let (parts, right_wrong) = kept(parts(i, value), faults)?;
    // Both sides are looked at, whatever the first one is.
    let [a, b] = parts.map(|side| kept(self::side(i, side, panels), faults));
    let sides = [a??, b??];
    if sides[0] == sides[1] {
        let (panel, edge) = sides[0];
        let name = panels.iter().find(|p| p.sound.as_ref().is_some_and(|(k, _)| *k == panel));
        let panel = name.map_or_else(String::new, |p| short(&p.name));
        faults.push(SpecificationDamage::Itself { stitch: i, panel, edge });
        return None;
    }
    Some(RawStitch { number: i, sides, right_wrong })
}

/// The two sides of a stitch, and whether its word stands with them.
fn parts(i: usize, value: &Json) -> Result<([&Json; 2], bool), SpecificationDamage> {
    let Json::List(parts) = value else { return Err(wrong(&format!("stitch {i}"), value, "a list")) };
    let sides = parts.iter().filter(|p| !matches!(p, Json::Text(_))).count();
    let [a, b, words @ ..] = parts.as_slice() else {
        return Err(SpecificationDamage::Sides { stitch: i, sides });
    };
    if sides != 2 {
        return Err(SpecificationDamage::Sides { stitch: i, sides });
    }
    let mut right_wrong = false;
    for word in words {
        match word {
            Json::Text(word) if word == "right_wrong" => right_wrong = true,
            Json::Text(word) => return Err(SpecificationDamage::Word { stitch: i, word: short(word) }),
            _ => return Err(SpecificationDamage::Sides { stitch: i, sides: parts.len() }),
        }
    }
    Ok(([a, b], right_wrong))
}

/// The edge of a stitch's side; none where its panel is at fault itself.
fn side(i: usize, value: &Json, panels: &[KnownPanel]) -> Result<Option<PanelEdge>, SpecificationDamage> {
    let at = format!("a side of stitch {i}");
    let Json::Text(name) = part(value, "panel", &at)? else {
        return Err(wrong(&format!("`panel` of {at}"), value.field("panel").unwrap_or(value), "a text"));
    };
    let known = || panels.iter().map(|p| p.name.clone()).collect();
    let panel = panels.iter().find(|p| p.name == *name);
    let panel = panel.ok_or_else(|| SpecificationDamage::NoPanel {
        stitch: i,
        panel: short(name),
        known: known(),
    })?;
    let edge = number(part(value, "edge", &at)?, &format!("`edge` of {at}"))?;
    let Some((k, panel)) = &panel.sound else { return Ok(None) };
    let count = panel.edges.len();
    match edge >= 0.0 && edge.fract() == 0.0 && edge < count as f64 {
        true => Ok(Some((*k, edge as usize))),
        false => Err(SpecificationDamage::NoEdge { stitch: i, panel: short(name), edge, count }),
    }
}

/// A text that is not empty.
fn text(value: &Json, field: &str) -> Option<String> {
    match value.field(field) {
        Some(Json::Text(text)) if !text.is_empty() => Some(text.clone()),
        _ => None,
    }
}

fn part<'a>(value: &'a Json, field: &str, of: &str) -> Result<&'a Json, SpecificationDamage> {
    match value {
        Json::Object(_) => value
            .field(field)
            .ok_or_else(|| SpecificationDamage::Missing { field: field.into(), of: of.into() }),
        other => Err(wrong(of, other, "an object")),
    }
}

fn object<'a>(value: &'a Json, field: &str, of: &str) -> Result<&'a Json, SpecificationDamage> {
    match part(value, field, of)? {
        found @ Json::Object(_) => Ok(found),
        other => Err(wrong(&format!("`{field}` of {of}"), other, "an object")),
    }
}

fn list<'a>(value: &'a Json, field: &str, of: &str) -> Result<&'a [Json], SpecificationDamage> {
    match part(value, field, of)? {
        Json::List(found) => Ok(found),
        other => Err(wrong(&format!("`{field}` of {of}"), other, "a list")),
    }
}

fn number(value: &Json, at: &str) -> Result<f64, SpecificationDamage> {
    match value {
        Json::Number(n) => Ok(*n),
        other => Err(wrong(at, other, "a number")),
    }
}

/// A list of so many numbers, none of them beyond what a garment reaches.
fn numbers<const N: usize>(value: &Json, at: &str) -> Result<[f64; N], SpecificationDamage> {
    let Json::List(found) = value else { return Err(wrong(at, value, "a list")) };
    if found.len() != N {
        let count = format!("{at} has {} numbers, {N} are wanted", found.len());
        return Err(SpecificationDamage::Unsewable {
            what: count,
            remedy: "points in the plane have 2 numbers, in space 3",
        });
    }
    let mut out = [0.0; N];
    for (to, v) in out.iter_mut().zip(found) {
        *to = within(number(v, at)?, at)?;
    }
    Ok(out)
}

fn within(value: f64, at: &str) -> Result<f64, SpecificationDamage> {
    match value.abs() <= FARTHEST {
        true => Ok(value),
        false => Err(SpecificationDamage::Far { at: at.to_owned(), value }),
    }
}

fn point(value: &Json, at: &str) -> Result<Point2, SpecificationDamage> {
    numbers::<2>(value, at).map(|[x, y]| Point2::new(x, y))
}

fn most(what: &'static str, of: &str, count: usize, most: usize) -> Result<(), SpecificationDamage> {
    match count <= most {
        true => Ok(()),
        false => Err(SpecificationDamage::Many { what, of: of.to_owned(), count, most }),
    }
}

fn wrong(at: &str, found: &Json, wanted: &'static str) -> SpecificationDamage {
    SpecificationDamage::Type { at: at.to_owned(), found: found.words(), wanted }
}

/// A name as it stands in a message.
fn short(name: &str) -> String {
    name.chars().take(60).collect()
}

//! The fields of the file, in the order in which GarmentCode writes them.

use super::curve::FileCurve;
use serde::{Serialize, Serializer};
use toile_core::artifact::{EdgeCurve, Point2, Vector2};

/// Units in a metre: centimetres.
pub(super) const UNITS: f64 = 100.0;
/// Neighbouring numbers that are tried for a radius, on either side.
const TRIED: i64 = 16;

/// An object with its fields in the order of the list.
pub(super) struct InOrder<'a, T>(pub Vec<(&'a str, T)>);

impl<T: Serialize> Serialize for InOrder<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(k, v)| (k, v)))
    }
}

/// A whole file. GarmentCode reads none without `parameters` and their order, of which a pattern
/// that is drawn has none.
#[derive(Serialize)]
pub(super) struct File<'a> {
    pattern: JsonPattern<'a>,
    parameters: InOrder<'a, ()>,
    parameter_order: [&'a str; 0],
    properties: Properties,
}

#[derive(Serialize)]
struct JsonPattern<'a> {
    panels: InOrder<'a, JsonPanel<'a>>,
    stitches: Vec<Sewn<'a>>,
    panel_order: Vec<&'a str>,
}

#[derive(Serialize)]
struct Properties {
    curvature_coords: &'static str,
    normalize_panel_translation: bool,
    normalized_edge_loops: bool,
    units_in_meter: f64,
}

/// A piece.
#[derive(Serialize)]
pub(super) struct JsonPanel<'a> {
    pub translation: [f64; 3],
    /// Euler angles, degrees.
    pub rotation: [f64; 3],
    pub vertices: Vec<[f64; 2]>,
    pub edges: Vec<JsonEdge>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub label: Option<&'a str>,
}

/// An edge of a panel.
#[derive(Serialize)]
pub(super) struct JsonEdge {
    endpoints: [usize; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    curvature: Option<Curvature>,
    /// GarmentCode wants both edges of a stitch to have the same one, or one of them none.
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<String>,
    /// What it is called where it may have no label; GarmentCode does not look at it.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
}

#[derive(Serialize)]
struct Curvature {
    #[serde(rename = "type")]
    kind: &'static str,
    params: CurvatureParams,
}

#[derive(Serialize)]
#[serde(untagged)]
enum CurvatureParams {
    Points(Vec<[f64; 2]>),
    Circle(f64, u8, u8),
}

/// A side of a stitch.
#[derive(Serialize)]
pub(super) struct StitchSide<'a> {
    pub panel: &'a str,
    pub edge: usize,
}

/// A stitch, with the word that says that start meets start.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Sewn<'a> {
    Plain([StitchSide<'a>; 2]),
    RightWrong(StitchSide<'a>, StitchSide<'a>, &'static str),
}

impl<'a> Sewn<'a> {
    pub(super) fn new([a, b]: [StitchSide<'a>; 2], right_wrong: bool) -> Self {
        if right_wrong { Sewn::RightWrong(a, b, "right_wrong") } else { Sewn::Plain([a, b]) }
    }
}

impl<'a> File<'a> {
    pub(super) fn new(
        panels: InOrder<'a, JsonPanel<'a>>,
        stitches: Vec<Sewn<'a>>,
        panel_order: Vec<&'a str>,
    ) -> Self {
        let properties = Properties {
            curvature_coords: "relative",
            normalize_panel_translation: false,
            normalized_edge_loops: true,
            units_in_meter: UNITS,
        };
        let (parameters, parameter_order) = (InOrder(Vec::new()), []);
        File {
            pattern: JsonPattern { panels, stitches, panel_order },
            parameters,
            parameter_order,
            properties,
        }
    }

    pub(super) fn text(&self) -> String {
        // Nothing of it can fail: keys are texts and numbers finite.
        serde_json::to_string_pretty(self).map_or_else(|_| String::new(), |text| text + "\n")
    }
}

impl JsonEdge {
    pub(super) fn new(endpoints: [usize; 2], curve: &FileCurve, label: Option<String>) -> Self {
        JsonEdge { endpoints, curvature: curvature(curve), label, name: None }
    }

    /// What it is called.
    pub(super) fn called(&self) -> Option<&str> {
        self.label.as_deref()
    }

    /// Its label becomes a name.
    pub(super) fn unlabelled(&mut self) {
        self.name = self.label.take();
    }
}

fn curvature(curve: &FileCurve) -> Option<Curvature> {
    let points = |kind, controls: &[Point2]| {
        let params = CurvatureParams::Points(controls.iter().map(|c| relative(curve, *c)).collect());
        Some(Curvature { kind, params })
    };
    match &curve.shape {
        EdgeCurve::Line | EdgeCurve::Polyline { .. } => None,
        EdgeCurve::Quadratic { control } => points("quadratic", &[*control]),
        EdgeCurve::Cubic { controls } => points("cubic", controls),
        EdgeCurve::Arc { bulge } => {
            let params = CurvatureParams::Circle(
                radius(curve, *bulge),
                u8::from(bulge.abs() > 1.0),
                u8::from(*bulge > 0.0),
            );
            Some(Curvature { kind: "circle", params })
        }
    }
}

/// A control point along the chord and to its left, both as shares of the chord.
fn relative(curve: &FileCurve, c: Point2) -> [f64; 2] {
    let chord = curve.end - curve.start;
    let (to, square) = (c - curve.start, chord.norm_squared());
    [to.dot(&chord) / square, chord.perp(&to) / square]
}

/// The radius of an arc in the file's units. Near a half circle the last bits of it decide: of its
/// neighbours the number is taken from which a reader finds the bulge again.
fn radius(curve: &FileCurve, bulge: f64) -> f64 {
    let at = |p: Point2| p * UNITS;
    let chord: Vector2 = at(curve.end) - at(curve.start);
    let chord = chord.norm();
    let exact = chord * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    let unit = 1.0 / UNITS;
    let off = |radius: &f64| {
        let found = EdgeCurve::bulge(chord * unit, radius * unit, bulge.abs() > 1.0, bulge > 0.0);
        (found - bulge).abs()
    };
    let beside = |k: i64| f64::from_bits(exact.to_bits().saturating_add_signed(k));
    let tried = std::iter::once(0).chain((1..=TRIED).flat_map(|k| [k, -k])).map(beside);
    tried.fold(exact, |best, one| if off(&one) < off(&best) { one } else { best })
}

//! A garment with something of everything, and readers of the formats that know no more than their
//! descriptions.

use serde_json::Value;
use std::collections::BTreeMap;
use toile_core::artifact::*;

pub(crate) fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

pub(crate) fn edge(name: &str, curve: EdgeCurve) -> PieceEdge {
    PieceEdge { name: name.into(), curve }
}

pub(crate) fn side(uses: &[(&str, &str, bool)]) -> Vec<EdgeUse> {
    let one = |(panel, edge, reversed): &(&str, &str, bool)| EdgeUse {
        edge: EdgeRef { panel: (*panel).into(), edge: (*edge).into() },
        reversed: *reversed,
    };
    uses.iter().map(one).collect()
}

pub(crate) fn seam(name: &str, kind: SeamKind, sides: &[&[(&str, &str, bool)]]) -> PatternSeam {
    PatternSeam { name: name.into(), kind, sides: sides.iter().map(|s| side(s)).collect() }
}

pub(crate) fn rectangle(name: &str, width: f64, height: f64) -> Piece {
    Piece {
        name: name.into(),
        outer: PatternLoop {
            corners: vec![p(0.0, 0.0), p(width, 0.0), p(width, height), p(0.0, height)],
            edges: ["hem", "right", "top", "left"].map(|n| edge(n, EdgeCurve::Line)).into(),
        },
        ..Piece::default()
    }
}

/// A front with a dart, curves of every kind, and marks; a back, a band of one edge for two, a
/// pocket.
pub(crate) fn blouse() -> Pattern {
    let mut front = rectangle("front", 0.5, 0.6);
    front.outer.corners.splice(1..1, [p(0.2, 0.0), p(0.215, 0.14), p(0.23, 0.0)]);
    front
        .outer
        .edges
        .splice(0..1, ["hem_left", "dart_left", "dart_right", "hem_right"].map(|n| edge(n, EdgeCurve::Line)));
    front.outer.edges[3].curve = EdgeCurve::Quadratic { control: p(0.36, -0.015) };
    front.outer.edges[4].curve = EdgeCurve::Cubic { controls: [p(0.53, 0.2), p(0.46, 0.4)] };
    front.outer.edges[5].curve = EdgeCurve::Arc { bulge: -0.35 };
    front.outer.edges[6].curve = EdgeCurve::Polyline { points: vec![p(0.01, 0.4), p(-0.02, 0.2)] };
    front.holes = vec![PatternLoop {
        corners: vec![p(0.3, 0.3), p(0.3, 0.35), p(0.35, 0.35)],
        edges: ["hole_a", "hole_b", "hole_c"].map(|n| edge(n, EdgeCurve::Line)).into(),
    }];
    let line = |name: &str, purpose, points: &[Point2]| PieceLine {
        name: name.into(),
        purpose,
        points: points.to_vec(),
    };
    front.lines = vec![
        line("crease", LinePurpose::Fold, &[p(0.4, 0.05), p(0.4, 0.2)]),
        line("pocket", LinePurpose::Placement, &[p(0.05, 0.25), p(0.15, 0.25)]),
    ];
    front.notches = vec![Notch { edge: "right".into(), along: 0.2, depth: 0.004 }];
    front.drill_holes = vec![p(0.215, 0.13)];
    front.body_part = Some(BodyPart::Body);
    let turn = nalgebra::Rotation3::from_euler_angles(0.1, 1.2, -0.3);
    front.pose = Some(Pose {
        origin: Point3::new(0.01, 1.02, 0.2),
        across: turn * Vector3::x(),
        along: turn * Vector3::y(),
    });
    let mut back = rectangle("back", 0.5, 0.6);
    back.outer.edges[3].curve = EdgeCurve::Cubic { controls: [p(-0.03, 0.4), p(0.04, 0.2)] };
    let matched = SeamKind::Matched;
    Pattern {
        name: "blouse".into(),
        pieces: vec![front, back, rectangle("band", 0.97, 0.05), rectangle("pocket", 0.1, 0.12)],
        seams: vec![
            seam("side", matched, &[&[("front", "right", false)], &[("back", "left", true)]]),
            seam(
                "dart",
                SeamKind::Dart,
                &[&[("front", "dart_left", false)], &[("front", "dart_right", true)]],
            ),
            seam(
                "waist",
                SeamKind::Gathered,
                &[
                    &[("band", "top", false)],
                    &[("back", "hem", true), ("front", "hem_right", true), ("front", "hem_left", true)],
                ],
            ),
            seam("pocket", SeamKind::Patch, &[&[("pocket", "hem", false)], &[("front", "pocket", false)]]),
            seam("alike", matched, &[&[("band", "left", false)], &[("pocket", "left", false)]]),
        ],
    }
}

/// Pieces by their names, each with its edges by theirs, in the order of the file; metres, y up.
pub(crate) type Drawn = Vec<(String, Vec<(String, Vec<Point2>)>)>;

/// The outline of a drawn piece, closed.
pub(crate) fn outline(edges: &[(String, Vec<Point2>)]) -> Vec<Point2> {
    edges.iter().flat_map(|(_, points)| points[..points.len() - 1].to_vec()).collect()
}

/// How far the outlines of a piece and of a drawn one are apart, their lower left corners laid on
/// each other, metres.
pub(crate) fn apart(piece: &Piece, drawn: &[(String, Vec<Point2>)]) -> f64 {
    polygons_apart(&at_origin(&piece.outer.points().0), &at_origin(&outline(drawn)))
}

/// Points with the lower left corner of their box at the origin.
pub(crate) fn at_origin(points: &[Point2]) -> Vec<Point2> {
    let lo = points.iter().fold(points[0], |a, b| a.inf(b));
    points.iter().map(|q| q - lo.coords).collect()
}

/// How far two closed lines are apart.
pub(crate) fn polygons_apart(a: &[Point2], b: &[Point2]) -> f64 {
    let far = |from: &[Point2], to: &[Point2]| {
        let n = to.len();
        let chord = |q: Point2, k: usize| {
            let (a, d) = (to[k], to[(k + 1) % n] - to[k]);
            let t = ((q - a).dot(&d) / d.norm_squared().max(1e-300)).clamp(0.0, 1.0);
            (q - (a + d * t)).norm()
        };
        let nearest = |q: &Point2| (0..n).map(|k| chord(*q, k)).fold(f64::INFINITY, f64::min);
        from.iter().map(nearest).fold(0.0, f64::max)
    };
    far(a, b).max(far(b, a))
}

/// The two sides of a stitch, each a panel and the number of its edge, and whether start meets
/// start.
pub(crate) type Stitch = ([(String, usize); 2], bool);

/// The pieces of a GarmentCode file with their curves, places and parts of the body; its stitches.
pub(crate) fn read_json(bytes: &[u8]) -> (Vec<Piece>, Vec<Stitch>) {
    let file: Value = serde_json::from_slice(bytes).unwrap();
    let unit = 1.0 / file["properties"]["units_in_meter"].as_f64().unwrap();
    let numbers = |v: &Value| v.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect::<Vec<_>>();
    let order = file["pattern"]["panel_order"].as_array().cloned();
    let order = order.unwrap_or_else(|| {
        file["pattern"]["panels"].as_object().unwrap().keys().map(|k| Value::String(k.clone())).collect()
    });
    let piece = |name: &Value| {
        let panel = &file["pattern"]["panels"][name.as_str().unwrap()];
        let vertex = |k: &Value| {
            let v = numbers(&panel["vertices"][k.as_u64().unwrap() as usize]);
            p(v[0], v[1])
        };
        let mut outer = PatternLoop::default();
        for (i, e) in panel["edges"].as_array().unwrap().iter().enumerate() {
            let (start, end) = (vertex(&e["endpoints"][0]), vertex(&e["endpoints"][1]));
            let d = end - start;
            let control = |v: &Value| {
                let c = numbers(v);
                (start + d * c[0] + Vector2::new(-d.y, d.x) * c[1]) * unit
            };
            let curve = match (&e["curvature"], e["curvature"]["type"].as_str()) {
                (Value::Array(_), _) => EdgeCurve::Quadratic { control: control(&e["curvature"]) },
                (c, Some("quadratic")) => EdgeCurve::Quadratic { control: control(&c["params"][0]) },
                (c, Some("cubic")) => {
                    EdgeCurve::Cubic { controls: [control(&c["params"][0]), control(&c["params"][1])] }
                }
                (c, Some("circle")) => {
                    let n = numbers(&c["params"]);
                    let bulge = EdgeCurve::bulge(d.norm() * unit, n[0] * unit, n[1] != 0.0, n[2] != 0.0);
                    EdgeCurve::Arc { bulge }
                }
                _ => EdgeCurve::Line,
            };
            let name = e["label"].as_str().or(e["name"].as_str());
            let label = name.map_or_else(|| format!("edge_{i}"), str::to_owned);
            outer.corners.push(start * unit);
            outer.edges.push(edge(&label, curve));
        }
        let [x, y, z] = [0, 1, 2].map(|k| panel["rotation"][k].as_f64().unwrap().to_radians());
        let turn = nalgebra::Rotation3::from_euler_angles(x, y, z);
        let at = numbers(&panel["translation"]);
        let label = panel["label"].as_str();
        Piece {
            name: name.as_str().unwrap().to_owned(),
            outer,
            body_part: label.and_then(|l| BodyPart::WORDS.iter().find(|(w, _)| *w == l)).map(|(_, b)| *b),
            pose: Some(Pose {
                origin: Point3::new(at[0], at[1], at[2]) * unit,
                across: turn * Vector3::x(),
                along: turn * Vector3::y(),
            }),
            ..Piece::default()
        }
    };
    let stitch = |s: &Value| {
        let one =
            |k: usize| (s[k]["panel"].as_str().unwrap().to_owned(), s[k]["edge"].as_u64().unwrap() as usize);
        ([one(0), one(1)], s[2].as_str() == Some("right_wrong"))
    };
    let stitches = file["pattern"]["stitches"].as_array().unwrap().iter().map(stitch).collect();
    (order.iter().map(piece).collect(), stitches)
}

/// The pieces of a drawing: groups with a label, whose paths of the class `seam` are edges.
pub(crate) fn read_svg(bytes: &[u8]) -> Drawn {
    let text = std::str::from_utf8(bytes).unwrap();
    let tree = roxmltree::Document::parse(text).unwrap();
    let root = tree.root_element();
    let view: Vec<f64> = root.attribute("viewBox").unwrap().split(' ').map(|n| n.parse().unwrap()).collect();
    assert_eq!(root.attribute("width").unwrap(), format!("{}mm", view[2]), "a unit is a millimetre");
    let label = |n: roxmltree::Node<'_, '_>| {
        n.attribute(("http://www.inkscape.org/namespaces/inkscape", "label")).unwrap().to_owned()
    };
    let line = |n: roxmltree::Node<'_, '_>| {
        let path = kurbo::BezPath::from_svg(n.attribute("d").unwrap()).unwrap();
        let mut points = Vec::new();
        kurbo::flatten(path, 1e-3, |el| {
            if let kurbo::PathEl::MoveTo(q) | kurbo::PathEl::LineTo(q) = el {
                points.push(p(q.x * 1e-3, -q.y * 1e-3));
            }
        });
        (label(n), points)
    };
    let group = |g: roxmltree::Node<'_, '_>| {
        (label(g), g.children().filter(|n| n.attribute("class") == Some("seam")).map(line).collect())
    };
    root.children().filter(|n| n.has_tag_name("g") || n.tag_name().name() == "g").map(group).collect()
}

/// Pairs of code and value of a DXF.
pub(crate) fn tags(bytes: &[u8]) -> Vec<(i32, String)> {
    let text: String = bytes.iter().map(|b| char::from(*b)).collect();
    let lines: Vec<&str> = text.split_terminator("\r\n").collect();
    assert_eq!(lines.len() % 2, 0);
    lines.chunks(2).map(|pair| (pair[0].trim().parse().unwrap(), pair[1].to_owned())).collect()
}

/// The pieces of a DXF: blocks, whose lines on layer 14, else on layer 1, are edges.
pub(crate) fn read_dxf(bytes: &[u8]) -> Drawn {
    let mut out = Drawn::new();
    let mut layers: BTreeMap<String, Vec<Vec<Point2>>> = BTreeMap::new();
    let (mut kind, mut layer, mut name, mut x) = (String::new(), String::new(), String::new(), 0.0);
    for (code, value) in tags(bytes) {
        match (code, kind.as_str()) {
            (0, _) => {
                if value == "ENDBLK" {
                    let edges = layers.remove("14").or_else(|| layers.remove("1")).unwrap();
                    let named = edges.into_iter().enumerate().map(|(k, e)| (format!("edge_{k}"), e));
                    out.push((std::mem::take(&mut name), named.collect()));
                    layers.clear();
                }
                kind = value;
            }
            (8, "POLYLINE") => {
                layers.entry(value.clone()).or_default().push(Vec::new());
                layer = value;
            }
            (1, "TEXT") if value.starts_with("Piece Name: ") => {
                name = value["Piece Name: ".len()..].to_owned()
            }
            (10, "VERTEX") => x = value.parse::<f64>().unwrap() * 1e-3,
            (20, "VERTEX") => {
                let y = value.parse::<f64>().unwrap() * 1e-3;
                layers.get_mut(&layer).unwrap().last_mut().unwrap().push(p(x, y));
            }
            _ => {}
        }
    }
    out
}

//! Patterns in GarmentCode's form: a shirt, trousers, a dress, and a child's one-piece.
//!
//! They are drafted for mannequins whose measures stand in their files, and stand around them as
//! GarmentCode's panels do: centimetres, y up, panels before and behind the body, sleeves along the
//! arms. Panels behind the body run clockwise, as GarmentCode writes them.

mod dress;
mod onepiece;
mod shirt;
mod sleeve;
mod trousers;

use crate::garment::PlanePoint;
use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;

/// An edge to the next corner: straight without controls, a quadratic curve with one, a cubic curve
/// with two. Controls are relative to the chord: along it, and across it to the left.
#[derive(Clone)]
struct DraftEdge {
    name: &'static str,
    controls: Vec<PlanePoint>,
}

/// A panel with its place.
struct DraftPanel {
    name: String,
    label: &'static str,
    corners: Vec<PlanePoint>,
    edges: Vec<DraftEdge>,
    at: [f64; 3],
    /// Degrees about z.
    turn: f64,
}

fn line(name: &'static str) -> DraftEdge {
    DraftEdge { name, controls: Vec::new() }
}

fn bent(name: &'static str, along: f64, across: f64) -> DraftEdge {
    DraftEdge { name, controls: vec![[along, across]] }
}

/// A curve whose controls are points of the panel.
fn curve(name: &'static str, from: PlanePoint, to: PlanePoint, controls: &[PlanePoint]) -> DraftEdge {
    let d = [to[0] - from[0], to[1] - from[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let relative = |c: &PlanePoint| {
        let r = [c[0] - from[0], c[1] - from[1]];
        [(r[0] * d[0] + r[1] * d[1]) / square, (r[1] * d[0] - r[0] * d[1]) / square]
    };
    DraftEdge { name, controls: controls.iter().map(relative).collect() }
}

/// The corners of a dart in a straight edge: one end of its mouth, its tip to the left of the edge,
/// the other end.
fn dart(from: PlanePoint, to: PlanePoint, distance: f64, width: f64, depth: f64) -> [PlanePoint; 3] {
    let d = [to[0] - from[0], to[1] - from[1]];
    let long = d[0].hypot(d[1]);
    let u = [d[0] / long, d[1] / long];
    let at = |along: f64, across: f64| {
        [from[0] + along * u[0] - across * u[1], from[1] + along * u[1] + across * u[0]]
    };
    [at(distance - width / 2.0, 0.0), at(distance, depth), at(distance + width / 2.0, 0.0)]
}

fn distance(a: PlanePoint, b: PlanePoint) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

impl DraftEdge {
    /// The edge run through backwards; `side` is -1 where what was to its left then lies to its
    /// right.
    fn reversed(&self, side: f64) -> Self {
        let controls = self.controls.iter().rev().map(|[along, across]| [1.0 - along, side * across]);
        DraftEdge { controls: controls.collect(), ..*self }
    }

    /// Its length between two corners, from many chords: what is matched by it is matched to a
    /// hundredth of a millimetre.
    fn length(&self, from: PlanePoint, to: PlanePoint) -> f64 {
        let d = [to[0] - from[0], to[1] - from[1]];
        let point = |[along, across]: PlanePoint| {
            [from[0] + along * d[0] - across * d[1], from[1] + along * d[1] + across * d[0]]
        };
        let hull: Vec<PlanePoint> = self.controls.iter().copied().map(point).collect();
        let at = |t: f64| {
            let u = 1.0 - t;
            [0, 1].map(|k| match hull[..] {
                [] => u * from[k] + t * to[k],
                [c] => u * u * from[k] + 2.0 * t * u * c[k] + t * t * to[k],
                [c, e, ..] => u * u * u * from[k] + 3.0 * t * u * (u * c[k] + t * e[k]) + t * t * t * to[k],
            })
        };
        let chord = |k: u32| distance(at(f64::from(k) / 2000.0), at(f64::from(k + 1) / 2000.0));
        (0..2000).map(chord).sum()
    }
}

impl DraftPanel {
    fn new(
        name: &str,
        label: &'static str,
        corners: &[PlanePoint],
        edges: &[DraftEdge],
        at: [f64; 3],
    ) -> Self {
        DraftPanel {
            name: name.to_owned(),
            label,
            corners: corners.to_vec(),
            edges: edges.to_vec(),
            at,
            turn: 0.0,
        }
    }

    /// The same panel for the other side of the body: mirrored about x = 0, still
    /// counter-clockwise.
    fn mirrored(&self, name: &str) -> Self {
        let n = self.corners.len();
        let corners = (0..n).map(|k| self.corners[(n - k) % n]).map(|[x, y]| [-x, y]).collect();
        // Run through backwards in a mirror, a curve bends to the same side.
        let turned = |e: &DraftEdge| e.reversed(1.0);
        let edges = self.edges.iter().rev().map(turned).collect();
        let [x, y, z] = self.at;
        DraftPanel {
            name: name.to_owned(),
            corners,
            edges,
            at: [-x, y, z],
            turn: -self.turn,
            label: self.label,
        }
    }

    /// The same outline behind the body: it runs clockwise as seen from its own back.
    fn behind(&self, name: &str) -> Self {
        let n = self.corners.len();
        let corners = (0..n).map(|k| self.corners[(n - k) % n]).collect();
        let turned = |e: &DraftEdge| e.reversed(-1.0);
        let edges = self.edges.iter().rev().map(turned).collect();
        let [x, y, z] = self.at;
        DraftPanel {
            name: name.to_owned(),
            corners,
            edges,
            at: [x, y, -z],
            turn: self.turn,
            label: self.label,
        }
    }

    fn number(&self, edge: &str) -> Result<usize, String> {
        let found = self.edges.iter().position(|e| e.name == edge);
        found.ok_or_else(|| format!("the panel {} has no edge {edge}", self.name))
    }

    fn json(&self) -> Value {
        let n = self.corners.len();
        let edge = |(k, e): (usize, &DraftEdge)| {
            let mut out = json!({ "endpoints": [k, (k + 1) % n], "label": e.name });
            if !e.controls.is_empty() {
                let kind = if e.controls.len() == 1 { "quadratic" } else { "cubic" };
                out["curvature"] = json!({ "type": kind, "params": e.controls });
            }
            out
        };
        json!({
            "translation": self.at,
            "rotation": [0.0, 0.0, self.turn],
            "vertices": self.corners,
            "edges": self.edges.iter().enumerate().map(edge).collect::<Vec<_>>(),
            "label": self.label,
        })
    }
}

/// A garment: its panels, and which edges are stitched to which.
struct DraftGarment {
    panels: Vec<DraftPanel>,
    stitches: Vec<[(String, &'static str); 2]>,
}

impl DraftGarment {
    fn stitch(&mut self, a: &str, edge: &'static str, b: &str, other: &'static str) {
        self.stitches.push([(a.to_owned(), edge), (b.to_owned(), other)]);
    }

    fn json(&self) -> Result<Value, Box<dyn Error>> {
        let side = |(panel, edge): &(String, &'static str)| -> Result<Value, String> {
            let found = self.panels.iter().find(|p| p.name == *panel);
            let number = found.ok_or_else(|| format!("there is no panel {panel}"))?.number(edge)?;
            Ok(json!({ "panel": panel, "edge": number }))
        };
        let stitches = self.stitches.iter().map(|[a, b]| Ok::<_, String>(json!([side(a)?, side(b)?])));
        let stitches = stitches.collect::<Result<Vec<_>, _>>()?;
        let panels: serde_json::Map<String, Value> =
            self.panels.iter().map(|p| (p.name.clone(), p.json())).collect();
        let order: Vec<&str> = self.panels.iter().map(|p| p.name.as_str()).collect();
        Ok(json!({
            "pattern": { "panels": panels, "stitches": stitches, "panel_order": order },
            "parameters": {},
            "parameter_order": [],
            "properties": {
                "curvature_coords": "relative",
                "normalize_panel_translation": false,
                "normalized_edge_loops": true,
                "units_in_meter": 100,
            },
        }))
    }
}

/// The files: names and contents.
pub(crate) fn files() -> Result<[(&'static str, String); 4], Box<dyn Error>> {
    let text = |g: &DraftGarment| -> Result<String, Box<dyn Error>> {
        Ok(serde_json::to_string_pretty(&g.json()?)? + "\n")
    };
    Ok([
        ("shirt_specification.json", text(&shirt::shirt())?),
        ("trousers_specification.json", text(&trousers::trousers())?),
        ("dress_specification.json", text(&dress::dress())?),
        ("onepiece_specification.json", text(&onepiece::onepiece())?),
    ])
}

/// Writes them.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    for (name, text) in files()? {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}

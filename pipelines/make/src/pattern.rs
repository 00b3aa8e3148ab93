//! Patterns in GarmentCode's form: a shirt with set-in sleeves, collar and cuffs, and trousers with darts and a waistband.
//!
//! Both are drafted for the mannequin of 172 cm, bust 88, waist 70 and hip 96 cm, and stand around it as GarmentCode's panels
//! do: centimetres, y up, panels before and behind the body, sleeves along the arms. Panels behind the body run clockwise, as
//! GarmentCode writes them.

use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;

type P = [f64; 2];

/// An edge to the next corner: straight, or a quadratic curve with its control relative to the chord.
#[derive(Clone, Copy)]
struct Edge {
    name: &'static str,
    bend: Option<P>,
}

/// A panel with its place.
struct Panel {
    name: String,
    label: &'static str,
    corners: Vec<P>,
    edges: Vec<Edge>,
    at: [f64; 3],
    /// Degrees about z.
    turn: f64,
}

fn line(name: &'static str) -> Edge {
    Edge { name, bend: None }
}

fn bent(name: &'static str, along: f64, across: f64) -> Edge {
    Edge { name, bend: Some([along, across]) }
}

impl Panel {
    fn new(name: &str, label: &'static str, corners: &[P], edges: &[Edge], at: [f64; 3]) -> Self {
        Panel {
            name: name.to_owned(),
            label,
            corners: corners.to_vec(),
            edges: edges.to_vec(),
            at,
            turn: 0.0,
        }
    }

    /// The same panel for the other side of the body: mirrored about x = 0, still counter-clockwise.
    fn mirrored(&self, name: &str) -> Self {
        let n = self.corners.len();
        let corners = (0..n).map(|k| self.corners[(n - k) % n]).map(|[x, y]| [-x, y]).collect();
        // Run through backwards in a mirror, a curve bends to the same side.
        let turned = |e: &Edge| Edge { bend: e.bend.map(|[along, across]| [1.0 - along, across]), ..*e };
        let edges = self.edges.iter().rev().map(turned).collect();
        let [x, y, z] = self.at;
        Panel { name: name.to_owned(), corners, edges, at: [-x, y, z], turn: -self.turn, label: self.label }
    }

    /// The same outline behind the body: it runs clockwise as seen from its own back.
    fn behind(&self, name: &str) -> Self {
        let n = self.corners.len();
        let corners = (0..n).map(|k| self.corners[(n - k) % n]).collect();
        let turned = |e: &Edge| Edge { bend: e.bend.map(|[along, across]| [1.0 - along, -across]), ..*e };
        let edges = self.edges.iter().rev().map(turned).collect();
        let [x, y, z] = self.at;
        Panel { name: name.to_owned(), corners, edges, at: [x, y, -z], turn: self.turn, label: self.label }
    }

    fn number(&self, edge: &str) -> Result<usize, String> {
        let found = self.edges.iter().position(|e| e.name == edge);
        found.ok_or_else(|| format!("the panel {} has no edge {edge}", self.name))
    }

    fn json(&self) -> Value {
        let n = self.corners.len();
        let edge = |(k, e): (usize, &Edge)| {
            let mut out = json!({ "endpoints": [k, (k + 1) % n], "label": e.name });
            if let Some(bend) = e.bend {
                out["curvature"] = json!({ "type": "quadratic", "params": [bend] });
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

/// The length of a quadratic curve, from many chords: what is matched by it is matched to a hundredth of a millimetre.
fn length(from: P, to: P, [along, across]: P) -> f64 {
    let d = [to[0] - from[0], to[1] - from[1]];
    let control = [from[0] + along * d[0] - across * d[1], from[1] + along * d[1] + across * d[0]];
    let at = |t: f64| {
        let of =
            |k: usize| (1.0 - t) * (1.0 - t) * from[k] + 2.0 * t * (1.0 - t) * control[k] + t * t * to[k];
        [of(0), of(1)]
    };
    let chord = |k: u32| {
        let (a, b) = (at(f64::from(k) / 2000.0), at(f64::from(k + 1) / 2000.0));
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    (0..2000).map(chord).sum()
}

/// How far a curve over that chord must bend to have that length; 0 where the chord is longer.
fn bend_for(wanted: f64, from: P, to: P, along: f64) -> f64 {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if length(from, to, [along, middle]) < wanted { low = middle } else { high = middle }
    }
    low
}

/// A garment: its panels, and which edges are stitched to which.
struct Garment {
    panels: Vec<Panel>,
    stitches: Vec<[(String, &'static str); 2]>,
}

impl Garment {
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

/// Degrees between the mannequin's arms and the vertical.
const ARM: f64 = 60.0;
/// The end of the sleeve on the arm's axis: x and y.
const CUFF_END: P = [56.0, 112.0];

/// A shirt: front, back, sleeves in two halves each, a stand collar in two halves, cuffs in two halves each.
fn shirt() -> Garment {
    let (hem, armpit, shoulder, neck) = ([26.0, 0.0], [26.0, 36.0], [19.5, 57.4], [7.0, 62.0]);
    let torso = |name: &str, depth: f64, scoop: f64, z: f64| {
        let corners = [
            [-hem[0], 0.0],
            hem,
            armpit,
            shoulder,
            neck,
            [-neck[0], neck[1]],
            [-shoulder[0], shoulder[1]],
            [-armpit[0], armpit[1]],
        ];
        let edges = [
            line("hem"),
            line("side_left"),
            bent("armhole_left", 0.3, scoop),
            line("shoulder_left"),
            // The lowest point of a parabola lies at half the height of its control.
            bent("neck", 0.5, 2.0 * depth / (2.0 * neck[0])),
            line("shoulder_right"),
            bent("armhole_right", 0.7, scoop),
            line("side_right"),
        ];
        Panel::new(name, "body", &corners, &edges, [0.0, 85.0, z])
    };
    let (front_scoop, back_scoop) = (0.16, 0.10);
    let front = torso("front", 7.5, front_scoop, 22.0);
    let back = torso("back", 2.0, back_scoop, 22.0).behind("back");
    let (low, high) = ([-10.0, 35.0], [10.0, 42.0]);
    let sleeve = |name: &str, scoop: f64, z: f64| {
        // The cap is eased into the armhole by a hundredth.
        let armhole = length(armpit, shoulder, [0.3, scoop]) * 1.01;
        let cap = bend_for(armhole, high, low, 0.5);
        let corners = [[-7.0, 0.0], [7.0, 0.0], high, low];
        let edges = [line("wrist"), line("over_arm"), bent("cap", 0.5, -cap), line("under_arm")];
        Panel { turn: ARM, ..Panel::new(name, "arm", &corners, &edges, [CUFF_END[0], CUFF_END[1], z]) }
    };
    let cuff = |name: &str, z: f64| {
        let corners = [[-5.5, -6.0], [5.5, -6.0], [5.5, -1.0], [-5.5, -1.0]];
        let edges = [line("hem"), line("over_arm"), line("wrist"), line("under_arm")];
        Panel { turn: ARM, ..Panel::new(name, "arm", &corners, &edges, [CUFF_END[0], CUFF_END[1], z]) }
    };
    let collar = |name: &str, depth: f64, z: f64| {
        let half = length(neck, [-neck[0], neck[1]], [0.5, 2.0 * depth / (2.0 * neck[0])]) / 2.0;
        let corners = [[-half, 0.0], [half, 0.0], [half, 4.0], [-half, 4.0]];
        let edges = [line("neck"), line("end_left"), line("edge"), line("end_right")];
        Panel::new(name, "body", &corners, &edges, [0.0, 148.0, z])
    };
    let mut panels = vec![
        front,
        back,
        collar("collar_front", 7.5, 16.0),
        collar("collar_back", 2.0, 16.0).behind("collar_back"),
    ];
    for (part, of) in [("sleeve", true), ("cuff", false)] {
        let made = |name: &str, scoop: f64| if of { sleeve(name, scoop, 10.0) } else { cuff(name, 9.0) };
        let front = made(&format!("left_{part}_front"), front_scoop);
        let back = made("", back_scoop).behind(&format!("left_{part}_back"));
        let others =
            [front.mirrored(&format!("right_{part}_front")), back.mirrored(&format!("right_{part}_back"))];
        panels.extend([front, back]);
        panels.extend(others);
    }
    let mut g = Garment { panels, stitches: Vec::new() };
    for edge in ["shoulder_left", "shoulder_right", "side_left", "side_right"] {
        g.stitch("front", edge, "back", edge);
    }
    for (side, armhole) in [("left", "armhole_left"), ("right", "armhole_right")] {
        let of = |part: &str| format!("{side}_{part}");
        for half in ["front", "back"] {
            g.stitch(half, armhole, &of(&format!("sleeve_{half}")), "cap");
            g.stitch(&of(&format!("sleeve_{half}")), "wrist", &of(&format!("cuff_{half}")), "wrist");
        }
        for part in ["sleeve", "cuff"] {
            for edge in ["over_arm", "under_arm"] {
                g.stitch(&of(&format!("{part}_front")), edge, &of(&format!("{part}_back")), edge);
            }
        }
    }
    g.stitch("front", "neck", "collar_front", "neck");
    g.stitch("back", "neck", "collar_back", "neck");
    g.stitch("collar_front", "end_left", "collar_back", "end_left");
    g.stitch("collar_front", "end_right", "collar_back", "end_right");
    g
}

/// Trousers: two fronts and two backs with a dart each, and a waistband in two halves.
fn trousers() -> Garment {
    // Of the left leg, x from the middle of the body: fork, and middle of the waist.
    let leg = |name: &str, fork: f64, middle: f64, dart: f64, deep: f64, z: f64| {
        let (outer, high, hips) = ([21.0, 96.4], 96.4, [25.5, 77.4]);
        // The dart takes in what the waist is too wide.
        let at = (middle + outer[0]) / 2.0;
        let corners = [
            [fork + 8.0, 0.0],
            [23.0, 0.0],
            hips,
            outer,
            [at + dart / 2.0, high],
            [at, high - deep],
            [at - dart / 2.0, high],
            [middle, high],
            [0.0, 78.0],
            [fork, 66.0],
        ];
        let edges = [
            line("hem"),
            line("side_leg"),
            bent("side_hip", 0.5, -0.03),
            line("waist_outer"),
            line("dart_outer"),
            line("dart_inner"),
            line("waist_inner"),
            line("centre"),
            bent("fork", 0.3, 0.3),
            line("inseam"),
        ];
        Panel::new(name, "leg", &corners, &edges, [6.0, 12.0, z])
    };
    let front = leg("left_front", -5.0, 0.5, 2.5, 8.0, 20.0);
    let back = leg("", -9.0, 0.0, 3.0, 11.0, 20.0).behind("left_back");
    let band = |name: &str, middle: f64, dart: f64| {
        let half = (21.0 - middle - dart) / 2.0;
        let corners = [
            [-2.0 * half, 0.0],
            [-half, 0.0],
            [0.0, 0.0],
            [half, 0.0],
            [2.0 * half, 0.0],
            [2.0 * half, 4.0],
            [-2.0 * half, 4.0],
        ];
        let edges = [
            line("right_outer"),
            line("right_inner"),
            line("left_inner"),
            line("left_outer"),
            line("end_left"),
            line("top"),
            line("end_right"),
        ];
        Panel::new(name, "body", &corners, &edges, [0.0, 110.0, 18.0])
    };
    let panels = vec![
        front.mirrored("right_front"),
        back.mirrored("right_back"),
        front,
        back,
        band("band_front", 0.5, 2.5),
        band("", 0.0, 3.0).behind("band_back"),
    ];
    let mut g = Garment { panels, stitches: Vec::new() };
    for side in ["left", "right"] {
        let [front, back] = ["front", "back"].map(|half| format!("{side}_{half}"));
        for edge in ["side_leg", "side_hip", "inseam"] {
            g.stitch(&front, edge, &back, edge);
        }
        let names: [&'static str; 2] =
            if side == "left" { ["left_outer", "left_inner"] } else { ["right_outer", "right_inner"] };
        for (leg, band) in [(&front, "band_front"), (&back, "band_back")] {
            g.stitch(leg, "dart_outer", leg, "dart_inner");
            g.stitch(leg, "waist_outer", band, names[0]);
            g.stitch(leg, "waist_inner", band, names[1]);
        }
    }
    for half in ["front", "back"] {
        for edge in ["centre", "fork"] {
            g.stitch(&format!("left_{half}"), edge, &format!("right_{half}"), edge);
        }
    }
    g.stitch("band_front", "end_left", "band_back", "end_left");
    g.stitch("band_front", "end_right", "band_back", "end_right");
    g
}

/// The files: names and contents.
pub(crate) fn files() -> Result<[(&'static str, String); 2], Box<dyn Error>> {
    let text = |g: &Garment| -> Result<String, Box<dyn Error>> {
        Ok(serde_json::to_string_pretty(&g.json()?)? + "\n")
    };
    Ok([("shirt_specification.json", text(&shirt())?), ("trousers_specification.json", text(&trousers())?)])
}

/// Writes them.
pub(crate) fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    for (name, text) in files()? {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}

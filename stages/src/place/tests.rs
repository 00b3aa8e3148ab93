//! Placement of the shipped vest and tee, cut from their true outlines, on the default mannequin.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::body::tests::mannequin;
use crate::mesh::DelaunayMesher;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// What a placement reads.
pub(crate) struct Scene {
    panels: Set<Panel>,
    plan: SewingPlan,
    body: Body,
    fabric: Fabric,
}

impl Scene {
    fn place(&self, place: &Place) -> Result<Garment, StageError> {
        place.run(self.panels.clone(), &self.plan, &self.body, &self.fabric, &Context::quiet())
    }
}

/// A sample's true outline, with the seams of its style.
fn outline(garment: &str, side: &str) -> Outline {
    let path = format!("{}/../pipelines/samples/{garment}/{side}.outline.json", env!("CARGO_MANIFEST_DIR"));
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let metre = |v: &serde_json::Value| v.as_f64().unwrap() / 1e3;
    let points = json["outline"].as_array().unwrap();
    let points: Vec<Point2> = points.iter().map(|p| Point2::new(metre(&p[0]), metre(&p[1]))).collect();
    let index = |v: &serde_json::Value| v.as_u64().unwrap() as usize;
    let edge = |e: &serde_json::Value| Edge {
        name: e["name"].as_str().unwrap().to_owned(),
        start: index(&e["start"]),
        end: index(&e["end"]),
        gauge: Gauge { length: metre(&e["length_mm"]), min_radius: 0.2 },
    };
    let edges: Vec<Edge> = json["edges"].as_array().unwrap().iter().map(edge).collect();
    let corners = edges.iter().map(|e| e.start).collect();
    Outline { outer: Loop { points, corners }, holes: vec![], edges, inner: vec![], frame: None }
}

/// A style's anchor: between the two ends of the neck.
fn placement(outline: &Outline, behind: bool) -> PanelPlacement {
    let neck = outline.edges.iter().find(|e| e.name == "neck").unwrap();
    let [a, b] = [neck.start, neck.end].map(|i| outline.outer.points[i]);
    PanelPlacement { limb: Limb::Torso, behind, anchor: nalgebra::center(&a, &b), landmark: "neck_base" }
}

fn scene(garment: &str, sewn: &[&str], body: &str) -> Scene {
    let sides = ["front", "back"].map(|s| (s, outline(garment, s)));
    let mesher: DelaunayMesher = toile_core::param::ron_options().from_str("(edge: \"12 mm\")").unwrap();
    let panel = |o: &Outline| mesher.run(o, &Context::quiet()).unwrap();
    let seam = |edge: &&str| Seam {
        a: EdgeRef { panel: "front".into(), edge: (*edge).into() },
        b: EdgeRef { panel: "back".into(), edge: (*edge).into() },
        kind: SeamKind::Matched,
        reversed: false,
    };
    Scene {
        plan: SewingPlan {
            seams: sewn.iter().map(seam).collect(),
            placements: sides.iter().map(|(s, o)| ((*s).into(), placement(o, *s == "back"))).collect(),
        },
        panels: sides.iter().map(|(s, o)| ((*s).to_owned(), panel(o))).collect(),
        body: mannequin(body).unwrap(),
        fabric: poplin(),
    }
}

fn vest() -> Scene {
    scene("vest", &["shoulder_left", "shoulder_right", "side_left", "side_right"], "()")
}

fn tee() -> Scene {
    let sewn =
        ["shoulder_left", "shoulder_right", "underarm_left", "underarm_right", "side_left", "side_right"];
    scene("tshirt", &sewn, "()")
}

/// A woven cotton.
fn poplin() -> Fabric {
    Fabric {
        name: "test poplin".into(),
        area_density: 0.12,
        warp: Curve::linear(5000.0),
        weft: Curve::linear(5000.0),
        shear: Curve::linear(200.0),
        bending_warp: 5e-6,
        bending_weft: 5e-6,
        thickness: 3e-4,
        friction: 0.3,
        damping: 1.0,
        source: "test".into(),
    }
}

fn place(ron: &str) -> Place {
    toile_core::param::ron_options().from_str(ron).unwrap()
}

#[test]
fn dump() {
    let Ok(path) = std::env::var("TOILE_DUMP") else { return };
    for (name, scene) in [("vest", vest()), ("tee", tee())] {
        for lift in ["Flat", "Wrap"] {
            let t = std::time::Instant::now();
            let g = scene.place(&place(&format!("(lift: {lift})"))).unwrap();
            let n: Vec<f64> = g
                .seams
                .iter()
                .map(|s| {
                    s.pairs
                        .iter()
                        .map(|p| (g.positions[p[0] as usize] - g.positions[p[1] as usize]).norm())
                        .fold(0.0, f64::max)
                })
                .collect();
            eprintln!("{name} {lift} {:?} {:?}", t.elapsed(), n);
            for p in &g.panels {
                let mut o = String::new();
                for q in &g.positions[p.vertices.clone()] {
                    o += &format!("v {} {} {}\n", q.x, q.y, q.z);
                }
                for t in &g.triangles[p.triangles.clone()] {
                    let t = t.map(|v| v as usize - p.vertices.start + 1);
                    o += &format!("f {} {} {}\n", t[0], t[1], t[2]);
                }
                std::fs::write(format!("{path}/{name}_{lift}_{}.obj", p.name), o).unwrap();
            }
        }
    }
    std::fs::write(format!("{path}/m.obj"), &vest().body.export()[0].1).unwrap();
}

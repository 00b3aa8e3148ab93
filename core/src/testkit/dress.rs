//! A small body, garment and everything around them.

use super::shapes;
use crate::artifact::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Rings of the body: height, half width, half depth; metres.
const RINGS: [[f64; 3]; 13] = [
    [0.0, 0.12, 0.10],
    [0.3, 0.14, 0.10],
    [0.6, 0.16, 0.11],
    [0.85, 0.17, 0.115],
    [1.05, 0.135, 0.095],
    [1.25, 0.15, 0.115],
    [1.34, 0.16, 0.10],
    [1.39, 0.15, 0.075],
    [1.43, 0.08, 0.065],
    [1.47, 0.055, 0.055],
    [1.54, 0.055, 0.06],
    [1.60, 0.075, 0.09],
    [1.68, 0.06, 0.07],
];
/// Vertices a ring.
const AROUND: usize = 28;

/// A closed figure without arms, 1.7 m tall, with the landmarks that placement relies on.
pub fn body() -> Body {
    let ring = |[y, rx, rz]: [f64; 3]| {
        (0..AROUND).map(move |k| {
            let a = TAU * k as f64 / AROUND as f64;
            Point3::new(rx * a.sin(), y, rz * a.cos())
        })
    };
    let mut positions: Vec<Point3> = RINGS.into_iter().flat_map(ring).collect();
    let (bottom, top) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([Point3::new(0.0, 0.0, 0.0), Point3::new(0.0, 1.7, 0.0)]);
    let at = |r: usize, k: usize| (r * AROUND + k % AROUND) as u32;
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.push([bottom, at(0, k + 1), at(0, k)]);
        triangles.push([top, at(RINGS.len() - 1, k), at(RINGS.len() - 1, k + 1)]);
        for r in 0..RINGS.len() - 1 {
            triangles.push([at(r, k), at(r, k + 1), at(r + 1, k + 1)]);
            triangles.push([at(r, k), at(r + 1, k + 1), at(r + 1, k)]);
        }
    }
    let girth = |[_, rx, rz]: [f64; 3]| TAU * ((rx * rx + rz * rz) / 2.0).sqrt();
    let named =
        [("height", 1.7), ("bust", girth(RINGS[5])), ("waist", girth(RINGS[4])), ("hip", girth(RINGS[3]))];
    let measurements = named.map(|(name, length)| (name.to_owned(), length)).into();
    Body { positions, triangles, landmarks: landmarks(), measurements }
}

fn landmarks() -> BTreeMap<String, Landmark> {
    let middle =
        [("neck_base", 1.47, 0.055), ("bust", 1.25, 0.115), ("waist", 1.05, 0.095), ("hip", 0.85, 0.115)];
    let sides = [
        ("neck", 0.06, 1.45),
        ("shoulder", 0.16, 1.36),
        ("armpit", 0.155, 1.27),
        ("elbow", 0.16, 1.1),
        ("wrist", 0.17, 0.9),
    ];
    let mut all: BTreeMap<String, Landmark> = BTreeMap::new();
    for (name, y, z) in middle {
        all.insert(format!("{name}_front"), Point3::new(0.0, y, z));
        all.insert(format!("{name}_back"), Point3::new(0.0, y, -z));
    }
    for (name, x, y) in sides {
        for hand in Hand::BOTH {
            all.insert(hand.name(name), Point3::new(hand.sign() * x, y, 0.0));
        }
    }
    all.insert("crotch".into(), Point3::new(0.0, 0.78, 0.0));
    all
}

/// A woven cotton.
pub fn fabric() -> Fabric {
    Fabric {
        name: "suite cotton".into(),
        area_density: 0.12,
        warp: Curve(vec![(0.01, 60.0), (0.03, 400.0)]),
        weft: Curve(vec![(0.02, 60.0), (0.06, 400.0)]),
        shear: Curve::linear(40.0),
        bending_warp: 1e-5,
        bending_weft: 7e-6,
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 3e-4,
        friction: 0.3,
        damping: 0.5,
        source: "made up for tests".into(),
    }
}

/// Size of a garment's panels: metres.
const PANEL: [f64; 2] = [0.54, 0.5];

/// A panel of the suite's garment.
pub fn garment_panel() -> Panel {
    shapes::panel(9, 8, PANEL[0], PANEL[1])
}

/// The pattern of the suite's garment: a front and a back, sewn at shoulders and sides, standing
/// before and behind the body.
pub fn pattern() -> Pattern {
    let [w, h] = PANEL;
    let third = w / 6.0;
    let corners = [[-w / 2.0, 0.0], [w / 2.0, 0.0], [w / 2.0, h], [third, h], [-third, h], [-w / 2.0, h]];
    let names = ["hem", "side_left", "shoulder_left", "neck", "shoulder_right", "side_right"];
    let piece = |name: &str, side: f64| Piece {
        name: name.into(),
        outer: PatternLoop {
            corners: corners.map(|[x, y]| Point2::new(x, y)).into(),
            edges: names.map(|n| PieceEdge { name: n.into(), curve: EdgeCurve::Line }).into(),
        },
        body_part: Some(BodyPart::Body),
        pose: Some(Pose {
            origin: Point3::new(0.0, 0.98, side * 0.15),
            across: Vector3::new(side, 0.0, 0.0),
            along: Vector3::y(),
        }),
        ..Piece::default()
    };
    let side = |s: &EdgeRef, reversed| vec![EdgeUse { edge: s.clone(), reversed }];
    let seam = |s: &Seam| PatternSeam {
        name: s.name(),
        kind: s.kind,
        sides: vec![side(&s.a, false), side(&s.b, !s.reversed)],
    };
    Pattern {
        name: "suite".into(),
        pieces: vec![piece("front", 1.0), piece("back", -1.0)],
        seams: plan().seams.iter().map(seam).collect(),
    }
}

/// Seams at shoulders and sides.
pub fn plan() -> SewingPlan {
    let seam = |edge: &str| Seam {
        a: EdgeRef { panel: "front".into(), edge: edge.into() },
        b: EdgeRef { panel: "back".into(), edge: edge.into() },
        kind: SeamKind::Matched,
        reversed: false,
    };
    SewingPlan { seams: ["shoulder_left", "shoulder_right", "side_left", "side_right"].map(seam).into() }
}

/// Two panels before and behind the body, their seams open.
pub fn garment() -> Garment {
    let panel = garment_panel();
    let (n, t) = (panel.positions.len(), panel.triangles.len());
    let fabric = Arc::new(fabric());
    let lift = |q: &Point2, side: f64| Point3::new(side * q.x, 0.98 + q.y, side * 0.15);
    let shifted = |v: &u32| v + n as u32;
    let part = |name: &str, k: usize| GarmentPanel {
        name: name.into(),
        vertices: k * n..(k + 1) * n,
        triangles: k * t..(k + 1) * t,
        boundary: panel.boundary.iter().map(|v| v + (k * n) as u32).collect(),
        photo_px: panel.photo_px.clone(),
        fabric: fabric.clone(),
        layer: 0,
    };
    let other = |name: &str| match name {
        "side_left" => "side_right",
        "side_right" => "side_left",
        "shoulder_left" => "shoulder_right",
        _ => "shoulder_left",
    };
    // The back panel is seen from behind, so the wearer's left is its right.
    let seam = |name: &str| {
        let a = panel.edge(name).map_or(&[][..], |e| &e.vertices);
        let b = panel.edge(other(name)).map_or(&[][..], |e| &e.vertices);
        let pairs = a.iter().zip(b.iter().rev()).map(|(a, b)| [*a, shifted(b)]).collect();
        GarmentSeam { name: format!("front.{name}"), kind: SeamKind::Matched, pairs, state: SeamState::Open }
    };
    let front = panel.positions.iter().map(|q| lift(q, 1.0));
    let positions: Vec<Point3> = front.chain(panel.positions.iter().map(|q| lift(q, -1.0))).collect();
    let back = panel.triangles.iter().map(|tri| tri.map(|v| shifted(&v)));
    Garment {
        velocities: vec![Vector3::zeros(); 2 * n],
        rest: [panel.positions.clone(), panel.positions.clone()].concat(),
        triangles: panel.triangles.iter().copied().chain(back).collect(),
        panels: vec![part("front", 0), part("back", 1)],
        seams: ["shoulder_left", "shoulder_right", "side_left", "side_right"].map(seam).into(),
        weld: (0..2 * n as u32).collect(),
        pinned: Vec::new(),
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
        positions,
    }
}

/// The same after it has moved, in three frames: it came down by a centimetre each.
pub fn moved_garment() -> Garment {
    let garment = garment();
    let at = |k: usize| {
        garment.positions.iter().map(move |p| [p.x as f32, (p.y + 0.01 * (2 - k) as f64) as f32, p.z as f32])
    };
    let motion = RecordedMotion {
        every: 0.04,
        end: 0.1,
        triangles: garment.triangles.clone(),
        vertices: garment.positions.len(),
        positions: (0..3).flat_map(at).collect(),
    };
    Garment { motion: Some(Arc::new(motion)), ..garment }
}

/// The garment round the body like a tube, its sides sewn, its upper rim held.
pub fn sewn_garment() -> Garment {
    let mut garment = garment();
    let half = garment.positions.len() / 2;
    let radius = PANEL[0] / std::f64::consts::PI;
    for (i, (at, rest)) in garment.positions.iter_mut().zip(&garment.rest).enumerate() {
        let angle = rest.x / radius + if i < half { 0.0 } else { std::f64::consts::PI };
        *at = Point3::new(radius * angle.sin(), 0.98 + rest.y, radius * angle.cos());
    }
    garment.seams.retain(|s| s.name.contains("side"));
    for [a, b] in garment.seams.iter().flat_map(|s| s.pairs.clone()) {
        let least = a.min(b);
        (garment.weld[a as usize], garment.weld[b as usize]) = (least, least);
        garment.positions[a.max(b) as usize] = garment.positions[least as usize];
    }
    garment.seams.iter_mut().for_each(|s| s.state = SeamState::Closed);
    let top = garment.rest.iter().enumerate().filter(|(_, q)| q.y > PANEL[1] - 1e-9);
    garment.pinned = top.map(|(i, _)| i as u32).collect();
    garment
}

/// A garment without anything.
pub fn no_garment() -> Garment {
    Garment {
        positions: vec![],
        velocities: vec![],
        rest: vec![],
        triangles: vec![],
        panels: vec![],
        seams: vec![],
        weld: vec![],
        pinned: vec![],
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
    }
}

/// What acts in a prepared scene.
pub fn phases() -> Phases {
    let phase = |name: &str, g: f64| Phase {
        name: name.into(),
        seconds: 0.02,
        gravity: Vector3::new(0.0, -g, 0.0),
        air: None,
    };
    Phases(vec![phase("sew", 0.0), phase("drape", 9.81)])
}

/// A finished model: one textured triangle pair, and the body.
pub fn model() -> Model {
    let garment = garment();
    let normals = garment.vertex_normals();
    let material = |name: &str, texture| Material {
        name: name.into(),
        colour: [0.6, 0.6, 0.5],
        texture,
        normal_texture: None,
        unlit: false,
        roughness: 0.9,
        sheen: None,
        double_sided: true,
        wrong_side: None,
        fabric: String::new(),
    };
    let front = &garment.panels[0];
    let uv = |q: &Point2| [(q.x / 120.0) as f32, (q.y / 120.0) as f32];
    let cloth = Mesh {
        name: "front".into(),
        positions: garment.positions[front.vertices.clone()].to_vec(),
        normals: normals[front.vertices.clone()].to_vec(),
        uv: front.photo_px.iter().map(uv).collect(),
        triangles: garment.triangles[front.triangles.clone()].to_vec(),
        material: 0,
    };
    let body = body();
    let skin = Mesh {
        name: "body".into(),
        normals: body.vertex_normals(),
        positions: body.positions,
        uv: vec![],
        triangles: body.triangles,
        material: 1,
    };
    Model {
        meshes: vec![cloth, skin],
        materials: vec![material("front", Some(0)), material("body", None)],
        textures: vec![Texture { name: "front".into(), pixels: shapes::photo().pixels, repeats: false }],
        variants: vec![],
    }
}

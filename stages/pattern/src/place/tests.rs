//! Placement of the shipped vest and tee, cut along their true outlines, on the default mannequin.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;
use crate::mesh::DelaunayMesher;
use toile_core::prelude::*;
use toile_fixtures::mannequin;

/// What a placement reads.
struct Scene {
    pattern: Pattern,
    panels: Set<Panel>,
    plan: SewingPlan,
    body: Body,
    fabric: Fabric,
}

impl Scene {
    fn place(&self) -> Result<Garment, StageError> {
        self.told().0
    }

    /// The garment, and what was said of it.
    fn told(&self) -> (Result<Garment, StageError>, toile_core::Remarks) {
        let cx = Context::quiet();
        let placed = Arrange::default().run(
            &self.pattern,
            self.panels.clone(),
            &self.plan,
            &self.body,
            &self.fabric,
            &cx,
        );
        (placed, cx.take_remarks())
    }
}

/// A sample's true outline.
fn outline(garment: &str, side: &str) -> Outline {
    let path =
        format!("{}/../../pipelines/samples/{garment}/{side}.outline.json", env!("CARGO_MANIFEST_DIR"));
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let metre = |v: &serde_json::Value| v.as_f64().unwrap() / 1e3;
    let points = json["outline"].as_array().unwrap();
    let points = points.iter().map(|p| Point2::new(metre(&p[0]), metre(&p[1]))).collect();
    Outline {
        outer: Loop { points, corners: vec![] },
        holes: vec![],
        edges: vec![],
        inner: vec![],
        frame: None,
        lies: vec![],
    }
}

fn scene(garment: &str, body: &str) -> Scene {
    let body = mannequin(body).unwrap();
    let outlines = ["front", "back"].map(|s| (s.to_owned(), outline(garment, s))).into_iter().collect();
    let style = crate::style::Outline::default();
    let (pattern, outlines, plan) = style.run(outlines, &body, None, &Context::quiet()).unwrap();
    let mesher: DelaunayMesher = toile_core::param::ron_options().from_str("(edge: \"12 mm\")").unwrap();
    let panel = |(name, o): (&str, &Outline)| (name.to_owned(), mesher.run(o, &Context::quiet()).unwrap());
    Scene { panels: outlines.iter().map(panel).collect(), pattern, plan, body, fabric: poplin() }
}

fn vest() -> Scene {
    scene("vest", "()")
}

fn tee() -> Scene {
    scene("tshirt", "()")
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
        bending_friction_warp: 0.0,
        bending_friction_weft: 0.0,
        thickness: 3e-4,
        friction: 0.3,
        damping: 1.0,
        source: "test".into(),
    }
}

/// The position of a panel's vertices and their pattern points.
fn of_panel<'a>(g: &'a Garment, name: &str) -> impl Iterator<Item = (&'a Point3, &'a Point2)> {
    let range = g.panels.iter().find(|p| p.name == name).unwrap().vertices.clone();
    g.positions[range.clone()].iter().zip(&g.rest[range])
}

#[test]
fn panels_stand_clear_of_the_trunk() {
    for scene in [vest(), tee()] {
        let g = scene.place().unwrap();
        let shoulder = scene.body.landmarks["shoulder_left"];
        let trunk = scene.body.positions.iter().filter(|p| p.x.abs() < shoulder.x && p.y > 0.6 && p.y < 1.3);
        let (lo, hi) = trunk.fold((0.0f64, 0.0f64), |(lo, hi), p| (lo.min(p.z), hi.max(p.z)));
        assert!(of_panel(&g, "front").all(|(p, _)| p.z > hi + 0.03));
        assert!(of_panel(&g, "back").all(|(p, _)| p.z < lo - 0.03));
    }
}

#[test]
fn the_back_is_seen_from_behind() {
    let g = vest().place().unwrap();
    assert!(of_panel(&g, "front").all(|(p, r)| p.x * r.x >= -1e-12 && p.z > 0.0));
    assert!(of_panel(&g, "back").all(|(p, r)| p.x * r.x <= 1e-12 && p.z < 0.0));
    for (name, sign) in [("front", 1.0), ("back", -1.0)] {
        let panel = g.panels.iter().find(|p| p.name == name).unwrap();
        for t in &g.triangles[panel.triangles.clone()] {
            let [a, b, c] = t.map(|i| g.positions[i as usize]);
            assert!((b - a).cross(&(c - a)).z * sign > 0.0);
        }
    }
}

#[test]
fn seams_pair_points_that_face_each_other() {
    let scene = vest();
    let g = scene.place().unwrap();
    let names: Vec<&str> = g.seams.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names[2], "front.side_left + back.side_left");
    let (front, back) = (scene.panels.get("front").unwrap(), scene.panels.get("back").unwrap());
    let offset = g.panels.iter().find(|p| p.name == "front").unwrap().vertices.start as u32;
    let a = &front.edge("side_left").unwrap().vertices;
    let b = &back.edge("side_left").unwrap().vertices;
    let expected: Vec<[u32; 2]> = a.iter().zip(b.iter().rev()).map(|(a, b)| [a + offset, *b]).collect();
    assert_eq!(g.seams[2].pairs, expected);
    for pair in g.seams.iter().flat_map(|s| &s.pairs) {
        let [p, q] = pair.map(|v| g.positions[v as usize]);
        assert!((p.x - q.x).hypot(p.y - q.y) < 1e-3, "{p} {q}");
    }
}

#[test]
fn a_garment_starts_open_flat_and_at_rest() {
    let g = vest().place().unwrap();
    assert!(g.edge_strains().iter().all(|s| *s < 1e-9));
    assert!(g.velocities.iter().all(|v| v.norm() == 0.0));
    assert!(g.weld.iter().enumerate().all(|(i, w)| i as u32 == *w));
    assert!(g.seams.iter().all(|s| s.state == SeamState::Open));
}

#[test]
fn shoulder_seams_start_just_above_the_shoulders() {
    for scene in [vest(), tee()] {
        let g = scene.place().unwrap();
        let neck = scene.body.landmarks["neck_left"];
        let first = g.seams[0].pairs.iter().flatten().map(|v| g.positions[*v as usize].y).fold(0.0, f64::max);
        assert!(first > neck.y - 0.03 && first < neck.y + 0.06, "{first} at a neck of {}", neck.y);
    }
}

#[test]
fn shoulder_seams_that_start_in_the_shoulders_are_raised() {
    let stands = vest().place().unwrap();
    assert_eq!(stands.starts, []);
    let mut scene = vest();
    let low = |p: &mut Piece| p.pose.as_mut().unwrap().origin.y -= 0.06;
    scene.pattern.pieces.iter_mut().for_each(low);
    let (placed, told) = scene.told();
    let placed = placed.unwrap();
    let by = placed.positions[0].y - (stands.positions[0].y - 0.06);
    assert!(by > 0.02 && by < 0.07, "{by}");
    let note = format!("raised by {:.0} mm, so that its shoulder seams clear the shoulders", by * 1e3);
    assert_eq!((told.notes, told.warnings), (vec![note], vec![]));
    // The draper may take the places of the pattern instead.
    assert_eq!(placed.starts.len(), 1);
    assert_eq!(placed.starts[0].told, "as high as the pattern puts it");
    assert!((placed.positions[0].y - placed.starts[0].positions[0].y - by).abs() < 1e-12);
}

/// The message of a placement that is refused.
fn refused(scene: &Scene) -> String {
    let e = scene.place().expect_err("refused");
    assert!(e.hint.is_some(), "{e}");
    e.message
}

#[test]
fn plans_that_do_not_fit_the_panels_are_named() {
    let good = vest();
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = Scene {
            pattern: good.pattern.clone(),
            panels: good.panels.clone(),
            plan: good.plan.clone(),
            body: good.body.clone(),
            fabric: poplin(),
        };
        change(&mut scene);
        refused(&scene)
    };
    assert_eq!(with(&|s| s.plan.seams[0].a.panel = "hood".into()), "there is no panel \"hood\"");
    assert_eq!(with(&|s| s.plan.seams[0].a.edge = "hm".into()), "the panel \"front\" has no edge \"hm\"");
    assert_eq!(with(&|s| s.pattern.pieces.retain(|p| p.name != "back")), "the pattern has no piece \"back\"");
    let (side, shoulder) = (good.panels.get("front").unwrap(), good.panels.get("back").unwrap());
    let count = |p: &Panel, e: &str| p.edge(e).unwrap().vertices.len();
    assert_eq!(
        with(&|s| s.plan.seams[0].a.edge = "side_left".into()),
        format!(
            "`front.side_left` has {} vertices and `back.shoulder_left` has {}, so they cannot be sewn point by point",
            count(side, "side_left"),
            count(shoulder, "shoulder_left")
        )
    );
}

/// The vest's panels, placed, then sheared and lifted as a drape might be.
fn draped(scene: &Scene) -> Garment {
    let mut g = scene.place().unwrap();
    let flat = g.rest.clone();
    for panel in g.panels.clone() {
        let lift = if panel.name == "front" { 0.3 } else { -0.3 };
        for v in panel.vertices {
            g.positions[v] =
                Point3::new(1.1 * flat[v].x, 0.9 * flat[v].y + 0.2 * flat[v].x, lift + flat[v].y);
        }
    }
    g
}

fn carry(panels: &Set<Panel>, scene: &Scene, drape: &Garment) -> Result<Garment, StageError> {
    Transfer::default().run(panels.clone(), &scene.plan, &scene.fabric, drape, &Context::quiet())
}

#[test]
fn a_drape_carried_onto_its_own_mesh_is_itself() {
    let scene = vest();
    let drape = draped(&scene);
    let carried = carry(&scene.panels, &scene, &drape).unwrap();
    assert_eq!(carried.triangles, drape.triangles);
    assert_eq!(carried.seams.len(), 4);
    assert!(carried.seams.iter().all(|s| s.state == SeamState::Open));
    let apart = carried.positions.iter().zip(&drape.positions).map(|(a, b)| (a - b).norm());
    assert!(apart.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn another_mesh_of_the_same_panel_lies_where_its_flat_points_lay() {
    let scene = vest();
    let drape = draped(&scene);
    // Every vertex a little aside, and the border a millimetre out: beyond the old mesh.
    let moved = |panel: &Panel| {
        let mut panel = panel.clone();
        let shift = |p: &Point2| p + Vector2::new(1e-3 * (40.0 * p.y).sin(), 1e-3 * (50.0 * p.x).cos());
        panel.positions = panel.positions.iter().map(shift).collect();
        panel
    };
    let panels: Set<Panel> = scene.panels.iter().map(|(name, p)| (name.to_owned(), moved(p))).collect();
    let carried = carry(&panels, &scene, &drape).unwrap();
    for (v, (p, at)) in carried.rest.iter().zip(&carried.positions).enumerate() {
        // The drape is linear in the flat point, so its pieces carry it exactly, beyond the border
        // as well.
        let (x, y) = (1.1 * p.x, 0.9 * p.y + 0.2 * p.x);
        assert!((at.x - x).abs() < 1e-9 && (at.y - y).abs() < 1e-9, "vertex {v}: {at}");
    }
}

#[test]
fn what_cannot_be_carried_is_refused_in_words() {
    let scene = vest();
    let mut drape = draped(&scene);
    let wide = |p: &Panel| {
        let mut panel = p.clone();
        panel.positions.iter_mut().for_each(|q| q.x *= 1.5);
        panel
    };
    let panels: Set<Panel> = scene.panels.iter().map(|(name, p)| (name.to_owned(), wide(p))).collect();
    let error = carry(&panels, &scene, &drape).unwrap_err();
    assert!(
        error
            .message
            .starts_with("panel \"back\" reaches more than 20 mm beyond the earlier garment's near ("),
        "{}",
        error.message
    );
    assert_eq!(error.hint.unwrap(), "both must be meshes of the same outlines");
    drape.panels[0].name = "rear".into();
    let error = carry(&scene.panels, &scene, &drape).unwrap_err();
    assert_eq!(error.message, "the earlier garment has no panel \"back\"");
    assert_eq!(error.hint.unwrap(), "its panels are \"rear\", \"front\"");
    drape.panels[0].name = "back".into();
    drape.positions.iter_mut().for_each(|p| p.y = 1e8);
    let error = carry(&scene.panels, &scene, &drape).unwrap_err();
    assert!(
        error.message.contains("of the earlier garment lies farther away than 1000 km near ("),
        "{error}"
    );
    drape.rest.iter_mut().for_each(|p| p.y = 0.0);
    let error = carry(&scene.panels, &scene, &drape).unwrap_err();
    assert_eq!(error.message, "panel \"back\" of the earlier garment has no area");
}

//! Scenes from files, and through the solvers.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::Scene;
use crate::collide::body_crossings;
use crate::drape::{
    CentralDifferences, ImplicitEuler, InTime, Projective, SpringDraper, StaticEquilibrium, Xpbd,
};
use std::path::Path;
use std::sync::Arc;
use toile_cloth::energy::Air;
use toile_cloth::scene::{body_to_obj, generate, to_json};
use toile_core::Cancel;
use toile_core::prelude::*;

type Made = (Garment, Body, Collider, Phases);

/// Writes a scene into a folder and reads it as a pipeline there would.
fn through_files(scene: &toile_cloth::scene::Scene) -> Result<Made, StageError> {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("scene.json"), to_json(scene, "body.obj")).unwrap();
    std::fs::write(dir.path().join("body.obj"), body_to_obj(scene)).unwrap();
    read(dir.path(), "scene.json")
}

fn read(folder: &Path, file: &str) -> Result<Made, StageError> {
    let cx = Context::new("Scene", folder, Cancel::new(), Arc::new(()));
    Scene { file: file.into(), ..Scene::default() }.run(&cx)
}

/// A motion that nothing slows but the air.
fn falling() -> InTime {
    InTime { drag: 0.0, ..InTime::default() }
}

#[test]
fn a_scene_becomes_a_placed_garment_its_body_and_its_phases() {
    let scene = generate::tube(4, 5);
    let (garment, body, collider, phases) = through_files(&scene).unwrap();
    assert_eq!(garment.positions.len(), scene.positions.len());
    assert_eq!(garment.triangles, scene.triangles);
    assert_eq!(garment.seams.len(), scene.seams.len());
    assert!(garment.check().is_ok() && phases.check().is_ok());
    assert_eq!(garment.panels[0].boundary.len(), 2 * (4 + 5));
    assert_eq!(body.triangles.len(), scene.body.as_ref().unwrap().triangles.len());
    assert_eq!(collider.scheme.card().thickness, scene.material.thickness);
    assert_eq!(phases.last_gravity().unwrap().y, -9.81);
    let far = garment.positions.iter().zip(&scene.positions).map(|(a, b)| (a.coords - b).norm());
    assert!(far.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn a_scene_without_a_body_has_an_empty_one_and_keeps_its_pins() {
    let scene = generate::hang(4);
    let (garment, body, _, _) = through_files(&scene).unwrap();
    assert!(body.triangles.is_empty());
    assert_eq!(garment.pinned, scene.pinned);
}

#[test]
fn rest_brings_the_skirt_to_rest_in_the_order_of_the_file() {
    let scene = generate::tube(6, 8);
    let (garment, _, collider, phases) = through_files(&scene).unwrap();
    let cx = Context::quiet();
    // On edges of 13 cm a graded skirt slides lower, where it is strained by 7 %.
    let rest = StaticEquilibrium {
        bending_continuation: false,
        speed: 1e-3,
        non_static: 0.0,
        ..StaticEquilibrium::default()
    };
    let draped = rest.run(&garment, Some(&collider), Some(&phases), &cx).unwrap();
    assert!(draped.status.converged && draped.status.max_speed < 1e-3, "{:?}", draped.status);
    assert_eq!(draped.seam_gap_max(), 0.0);
    assert!(draped.seams.iter().all(|s| s.state == SeamState::Closed) && draped.check().is_ok());
    let mut inside = Vec::new();
    collider.scheme.body_contacts(&draped.positions, 0.0, &mut inside);
    assert!(inside.is_empty(), "{inside:?}");
    assert!(draped.edge_strains().last().unwrap() < &0.05);
}

#[test]
fn rest_keeps_cloth_off_the_sharp_edges_of_a_pipelines_body() {
    let bodies = [
        generate::block([-0.3, -0.5, -0.3], [0.3, 0.0, 0.3]),
        generate::block([-0.25, -0.002, -0.4], [0.25, 0.0, 0.4]),
        generate::block([-0.001, -0.3, -0.6], [0.001, 0.0, 0.6]),
    ];
    for (k, body) in bodies.into_iter().enumerate() {
        let (garment, body, collider, phases) = through_files(&generate::cover(body, 12, 0.3)).unwrap();
        let rest = StaticEquilibrium { bending_continuation: false, ..StaticEquilibrium::default() };
        let draped = rest.run(&garment, Some(&collider), Some(&phases), &Context::quiet()).unwrap();
        // On the plate it is reported as not at rest.
        assert!(draped.status.converged || k == 1, "{k}");
        let pairs = body_crossings(&draped.positions, &draped.triangles, &body);
        assert_eq!(pairs, 0, "{k}");
    }
}

#[test]
fn rest_holds_what_is_pinned() {
    let (garment, _, collider, phases) = through_files(&generate::hang(6)).unwrap();
    let cx = Context::quiet();
    let draped = StaticEquilibrium::default().run(&garment, Some(&collider), Some(&phases), &cx).unwrap();
    for &p in &garment.pinned {
        assert_eq!(draped.positions[p as usize], garment.positions[p as usize]);
    }
    assert!(draped.status.converged);
}

#[test]
fn springs_hold_what_is_pinned() {
    let (garment, _, collider, _) = through_files(&generate::hang(6)).unwrap();
    let draper = SpringDraper { time_limit: 0.2, ..SpringDraper::default() };
    let hung = draper.run(&garment, Some(&collider), &Context::quiet()).unwrap();
    for &p in &garment.pinned {
        assert_eq!(hung.positions[p as usize], garment.positions[p as usize]);
    }
    let lowest = |g: &Garment| g.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    assert!(lowest(&hung) < lowest(&garment) - 0.05, "what is not pinned falls");
}

#[test]
fn a_pin_on_a_seam_stays_where_it_is_and_the_other_side_comes_to_it() {
    let mut scene = generate::tube(6, 8);
    let [a, b] = scene.seams[0].pairs[0];
    scene.pinned = vec![a];
    let (garment, _, collider, phases) = through_files(&scene).unwrap();
    let rest = StaticEquilibrium {
        join_gap: Length::mm(20.0),
        bending_continuation: false,
        ..StaticEquilibrium::default()
    };
    let draped = rest.run(&garment, Some(&collider), Some(&phases), &Context::quiet()).unwrap();
    assert_eq!(draped.positions[a as usize], garment.positions[a as usize]);
    assert_eq!(draped.positions[b as usize], garment.positions[a as usize]);
}

#[test]
fn what_nothing_holds_falls_as_galileo_says_in_every_solver_and_rest_says_why() {
    let mut scene = generate::hang(3);
    scene.pinned.clear();
    scene.phases.iter_mut().for_each(|p| p.seconds = 0.4);
    let (g, _, c, p) = through_files(&scene).unwrap();
    let (cx, c, p) = (Context::quiet(), Some(&c), Some(&p));
    let seconds: f64 = scene.phases.iter().map(|p| p.seconds).sum();
    let way = 0.5 * 9.81 * seconds * seconds;
    let fallen = [
        StaticEquilibrium::default().run(&g, c, p, &cx).unwrap(),
        ImplicitEuler { motion: falling(), ..ImplicitEuler::default() }.run(&g, c, p, &cx).unwrap(),
        Xpbd { motion: falling(), ..Xpbd::default() }.run(&g, c, p, &cx).unwrap(),
        Projective { motion: falling(), ..Projective::default() }.run(&g, c, p, &cx).unwrap(),
        CentralDifferences { motion: falling(), ..Default::default() }.run(&g, c, p, &cx).unwrap(),
    ];
    for (k, f) in fallen.iter().enumerate() {
        let fell = g.positions[5].y - f.positions[5].y;
        assert!((fell - way).abs() < 1e-4, "{k}: {fell} m, not {way} m");
    }
    let warnings = cx.take_remarks().warnings;
    assert_eq!(
        warnings,
        ["nothing holds the cloth, so it has no state of rest: its fall is followed for the scene's phases"]
    );
}

/// A free, level sheet for 0.2 s without weight, in this air.
fn in_air(air: Option<Air>) -> toile_cloth::scene::Scene {
    let mut scene = generate::hang(3);
    (scene.pinned, scene.self_collision) = (vec![], false);
    scene.phases.truncate(1);
    scene.phases[0].seconds = 0.2;
    scene.phases[0].gravity = nalgebra::Vector3::zeros();
    scene.phases[0].air = air;
    scene
}

#[test]
fn the_wind_of_a_scene_and_that_of_a_stage_blow_alike_and_the_scenes_comes_first() {
    let wind = (0.0, 6.0, 0.0);
    let stage = ImplicitEuler { motion: InTime { air: 1.2, wind, ..falling() }, ..ImplicitEuler::default() };
    let run = |stage: &ImplicitEuler, scene: &toile_cloth::scene::Scene| {
        let (g, _, c, p) = through_files(scene).unwrap();
        stage.run(&g, Some(&c), Some(&p), &Context::quiet()).unwrap().velocities
    };
    let blown = Air { wind: nalgebra::Vector3::new(0.0, 6.0, 0.0), ..Air::still(1.2) };
    let by_stage = run(&stage, &in_air(None));
    assert_eq!(
        run(&ImplicitEuler { motion: falling(), ..ImplicitEuler::default() }, &in_air(Some(blown))),
        by_stage
    );
    let k = 0.5 * 1.2 * 1.17 / in_air(None).material.density;
    let exact = 6.0 - 6.0 / (1.0 + k * 6.0 * 0.2);
    assert!(by_stage.iter().all(|v| (v.y - exact).abs() < 1e-5), "{} against {exact}", by_stage[0].y);
    assert!(run(&stage, &in_air(Some(blown.calmed()))).iter().all(|v| v.y.abs() < 1e-12));
}

#[test]
fn rest_names_the_stages_that_rest_in_wind_and_wind_needs_air() {
    let cx = Context::quiet();
    let mut scene = in_air(Some(Air { wind: nalgebra::Vector3::new(3.0, 0.0, 4.0), ..Air::still(1.2) }));
    scene.pinned = vec![0, 1];
    let (g, _, c, p) = through_files(&scene).unwrap();
    let e = StaticEquilibrium::default().run(&g, Some(&c), Some(&p), &cx).unwrap_err();
    assert_eq!(e.code, ErrorCode::InvalidInput);
    assert_eq!(e.message, "`test` finds no rest in a wind of 5 m/s");
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "take ImplicitEuler, CentralDifferences, Xpbd or Projective in its place: they move the cloth until it rests"
        )
    );
    let windy = InTime { wind: (1.0, 0.0, 0.0), ..InTime::default() };
    let e = Xpbd { motion: windy, ..Xpbd::default() }.run(&g, Some(&c), Some(&p), &cx).unwrap_err();
    assert_eq!(
        (e.code, &*e.message),
        (ErrorCode::InvalidParameter, "there is wind, but no air that could blow")
    );
    assert_eq!(e.hint.as_deref(), Some("write `air: 1.2`"));
    let gale = Projective {
        motion: InTime { air: 1.2, wind: (0.0, 2000.0, 0.0), ..InTime::default() },
        ..Projective::default()
    };
    let (g, _, c, p) = through_files(&in_air(None)).unwrap();
    let e = gale.run(&g, Some(&c), Some(&p), &cx).unwrap_err();
    assert_eq!(e.message, "wind speed = 2000 is out of range: at most 1000 m/s");
}

#[test]
fn what_a_garment_cannot_hold_is_named() {
    let warnings = |scene: &toile_cloth::scene::Scene| {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("scene.json"), to_json(scene, "body.obj")).unwrap();
        std::fs::write(dir.path().join("body.obj"), body_to_obj(scene)).unwrap();
        let cx = Context::new("Scene", dir.path(), Cancel::new(), Arc::new(()));
        Scene { file: "scene.json".into(), ..Scene::default() }.run(&cx).unwrap();
        cx.take_remarks().warnings
    };
    assert_eq!(warnings(&generate::tube(4, 5)), Vec::<String>::new());
    assert_eq!(warnings(&generate::banded(4, 4, 0.7)), Vec::<String>::new());
    let mut scene = generate::tube(4, 5);
    scene.strain_limit = Some(toile_cloth::scene::StrainLimit { warp: 0.05, weft: 0.05 });
    scene.seams[0].joined = false;
    scene.seams[1].gather = Some(1.0);
    scene.panels[0].layer = 1;
    scene.panels[1].body_friction = Some(0.1);
    scene.material.poisson = 0.2;
    scene.panels[1].material =
        Some(toile_cloth::fabric::Fabric { thickness: 2e-3, ..scene.material.clone() });
    let a = scene.seams[0].name.clone();
    let (p, q) = (scene.panels[0].name.clone(), scene.panels[1].name.clone());
    let whole = "the scene is not held whole:";
    assert_eq!(
        warnings(&scene),
        [
            format!("{whole} its strain limit is left out: a garment's fabric has curves instead"),
            format!("{whole} its seams \"{a}\" are joined: a garment has no threads"),
            format!("{whole} the layers of its panels \"{p}\" are left out"),
            format!(
                "{whole} its panels \"{q}\" slide on the body as all others do: a garment's collider has one friction"
            ),
            format!(
                "{whole} the thickness of its panels \"{q}\" is that of the scene: a garment's collider has one"
            ),
            format!("{whole} the Poisson's ratio of its fabric is left out"),
        ]
    );
}

#[test]
fn a_stopped_rest_stops() {
    let (garment, _, collider, phases) = through_files(&generate::tube(6, 8)).unwrap();
    let cancel = Cancel::new();
    cancel.cancel();
    let cx = Context::new("StaticEquilibrium", Path::new("."), cancel, Arc::new(()));
    let error = StaticEquilibrium::default().run(&garment, Some(&collider), Some(&phases), &cx).unwrap_err();
    assert_eq!(error.code, ErrorCode::Cancelled);
}

#[test]
fn files_that_are_no_scenes_are_refused_with_their_fault() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |name: &str, text: &str| {
        std::fs::write(dir.path().join(name), text).unwrap();
        let e = read(dir.path(), name).unwrap_err();
        (e.code, e.message)
    };
    let (code, message) = refused("a.json", "{");
    assert_eq!(code, ErrorCode::PatternLoading);
    assert!(message.starts_with("not a garment-scene-1: EOF while parsing an object"), "{message}");
    assert_eq!(refused("b.json", "{\"format\": \"x\"}").1, "the format is 'x', not 'garment-scene-1'");
    let e = read(dir.path(), "nowhere.json").unwrap_err();
    assert_eq!(e.message, "cannot read \"nowhere.json\": no such file");
    let e = read(dir.path(), "").unwrap_err();
    assert_eq!(e.message, "no file is named to read the scene from");
    let mut scene = generate::hang(2);
    scene.triangles[0] = [0, 1, 99];
    std::fs::write(dir.path().join("c.json"), to_json(&scene, "")).unwrap();
    let e = read(dir.path(), "c.json").unwrap_err();
    assert_eq!(e.message, "triangle 0 refers to vertex 99, but there are 9");
    let refused = |scene: &toile_cloth::scene::Scene| {
        let e = through_files(scene).unwrap_err();
        (e.code, e.message, e.hint)
    };
    let mut scene = generate::tube(4, 5);
    scene.body.as_mut().unwrap().triangles.clear();
    let hint =
        "it must be a Wavefront OBJ with `v` and `f` lines; write it again from the program that made it";
    let words = "the OBJ holds no faces".to_owned();
    assert_eq!(refused(&scene), (ErrorCode::PatternLoading, words, Some(hint.to_owned())));
    // The reader takes each number; no garment can have them all.
    let mut scene = generate::hang(2);
    scene.panels.clear();
    let (code, message, hint) = refused(&scene);
    assert!(message.starts_with("the garment of \"scene.json\" cannot be used: "), "{message}");
    assert_eq!(
        (code, hint.as_deref()),
        (ErrorCode::InvalidInput, Some("docs/reference/scene.md describes the format"))
    );
}

#[test]
fn names_that_were_meant_are_said() {
    let dir = tempfile::tempdir().unwrap();
    let text = to_json(&generate::hang(2), "");
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        std::fs::write(dir.path().join("scene.json"), text.replacen(from, to, 1)).unwrap();
        let e = read(dir.path(), "scene.json").unwrap_err();
        assert_eq!((e.code, e.param), (ErrorCode::PatternLoading, Some("file")));
        (e.message, e.hint.unwrap())
    };
    let (message, hint) = refused("\"seams\"", "\"seam\"");
    assert!(
        message.starts_with("not a garment-scene-1: unknown field `seam` of the scene at line 1 column "),
        "{message}"
    );
    assert_eq!(hint, "did you mean `seams`?");
    assert_eq!(refused("\"self_collision\"", "\"self_colision\"").1, "did you mean `self_collision`?");
    assert_eq!(
        refused("\"layer\"", "\"layr\"").1,
        "did you mean `layer`? a panel has `name`, `vertices`, `triangles`, `material`, `body_friction`, `layer`"
    );
    assert_eq!(refused("\"pinned\"", "\"seams\": [], \"pinned\"").1, "keep one `seams`");
}

#[test]
fn what_was_mended_of_a_scene_is_told_and_faces_by_themselves_are_refused_or_welded() {
    let clean = generate::drape(4);
    let corners: Vec<usize> = clean.triangles.iter().flatten().map(|&v| v as usize).collect();
    let mut scene = clean.clone();
    scene.rest = corners.iter().map(|&v| clean.rest[v]).collect();
    scene.positions = corners.iter().map(|&v| clean.positions[v]).collect();
    scene.triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    scene.panels[0].vertices = 0..corners.len();
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("scene.json"), to_json(&scene, "body.obj")).unwrap();
    let body = scene.body.as_ref().unwrap();
    let centimetres: String = body_to_obj(&scene)
        .lines()
        .map(|l| match l.strip_prefix("v ") {
            Some(p) => {
                let p: Vec<f64> = p.split(' ').map(|x| x.parse::<f64>().unwrap() * 100.0).collect();
                format!("v {} {} {}\n", p[0], p[1], p[2])
            }
            None => format!("{l}\n{l}\n"),
        })
        .collect();
    std::fs::write(dir.path().join("body.obj"), centimetres).unwrap();
    let cx = Context::new("Scene", dir.path(), Cancel::new(), Arc::new(()));
    let e = Scene { file: "scene.json".into(), ..Scene::default() }.run(&cx).unwrap_err();
    assert_eq!((e.code, e.param), (ErrorCode::InvalidInput, Some("weld")));
    assert_eq!(
        e.message,
        "panel 'square' is 32 faces that hang together nowhere: of its 96 vertices 71 lie on others that they are not joined to"
    );
    assert_eq!(
        e.hint.unwrap(),
        "merge them in the program that wrote the mesh, or let `weld: true` join them"
    );
    let (garment, read, ..) =
        Scene { file: "scene.json".into(), weld: true, ..Scene::default() }.run(&cx).unwrap();
    assert_eq!((garment.positions.len(), garment.seams[0].pairs.len()), (96, 71));
    assert_eq!(read.triangles.len(), body.triangles.len());
    let warnings = cx.take_remarks().warnings;
    assert_eq!(
        warnings,
        [
            format!(
                "the body's OBJ was repaired: {} triangles that are listed twice are removed",
                body.triangles.len()
            ),
            "the body's OBJ is read in centimetres, as it would be 60.0 m long in metres: it is 0.600 m long"
                .into(),
            "71 vertices are joined to others that they lie on".into(),
        ]
    );
}

#[test]
fn a_welded_mesh_drapes_as_one() {
    let clean = generate::hang(4);
    let corners: Vec<usize> = clean.triangles.iter().flatten().map(|&v| v as usize).collect();
    let mut scene = clean.clone();
    scene.rest = corners.iter().map(|&v| clean.rest[v]).collect();
    scene.positions = corners.iter().map(|&v| clean.positions[v]).collect();
    scene.triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    scene.panels[0].vertices = 0..corners.len();
    scene.pinned =
        (0..corners.len() as u32).filter(|&v| clean.pinned.contains(&(corners[v as usize] as u32))).collect();
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("scene.json"), to_json(&scene, "")).unwrap();
    let cx = Context::new("Scene", dir.path(), Cancel::new(), Arc::new(()));
    let read = |weld: bool, scene: &toile_cloth::scene::Scene| {
        std::fs::write(dir.path().join("scene.json"), to_json(scene, "")).unwrap();
        let (g, _, c, p) = Scene { file: "scene.json".into(), weld, ..Scene::default() }.run(&cx).unwrap();
        StaticEquilibrium { bending_continuation: false, ..StaticEquilibrium::default() }
            .run(&g, Some(&c), Some(&p), &cx)
            .unwrap()
    };
    let (welded, whole) = (read(true, &scene), read(false, &clean));
    for (p, &v) in welded.positions.iter().zip(&corners) {
        assert!((p - whole.positions[v]).norm() < 0.01, "{p} for {}", whole.positions[v]);
    }
}

#[test]
fn a_curtain_sewn_to_pins_of_no_triangle_hangs_there_in_every_solver() {
    let scene = generate::curtain(4);
    let (g, _, c, p) = through_files(&scene).unwrap();
    let (cx, c, p) = (Context::quiet(), Some(&c), Some(&p));
    let hung = [
        StaticEquilibrium::default().run(&g, c, p, &cx).unwrap(),
        ImplicitEuler::default().run(&g, c, p, &cx).unwrap(),
    ];
    for h in hung {
        for &[corner, pin] in &scene.seams[0].pairs {
            assert_eq!(h.positions[corner as usize], h.positions[pin as usize]);
            assert_eq!(h.positions[pin as usize].coords, scene.positions[pin as usize]);
        }
    }
}

/// What `StaticEquilibrium` says of a scene that it cannot bring to rest.
fn refused(scene: &toile_cloth::scene::Scene) -> StageError {
    let (garment, _, collider, phases) = through_files(scene).unwrap();
    let rest = StaticEquilibrium { bending_continuation: false, ..StaticEquilibrium::default() };
    rest.run(&garment, Some(&collider), Some(&phases), &Context::quiet()).unwrap_err()
}

#[test]
fn what_is_wrong_with_the_start_is_invalid_input() {
    let mut sunk = generate::tube(8, 9);
    sunk.positions.iter_mut().for_each(|p| p.z *= 0.2);
    let mut reversed = generate::tube(8, 9);
    let mut second: Vec<u32> = reversed.seams[0].pairs.iter().map(|p| p[1]).collect();
    second.reverse();
    reversed.seams[0].pairs.iter_mut().zip(second).for_each(|(p, v)| p[1] = v);
    let mut crossing = generate::tube(8, 9);
    let back = crossing.panels[1].vertices.clone();
    crossing.positions[back]
        .iter_mut()
        .for_each(|p| *p = nalgebra::Vector3::new(p.x, p.y + 0.007, 0.2 + 0.3 * p.x));
    for (scene, words, hint) in [
        (sunk, " starts inside the body, by ", "place it outside the body"),
        (
            reversed,
            "runs the wrong way: its sides start ",
            "turn one of its sides round: in a file of seams ",
        ),
        (
            crossing,
            "'front' and 'back' pass through each other where they start, ",
            "place them so that none does, or let the solver move it apart: `--set ",
        ),
    ] {
        let e = refused(&scene);
        assert_eq!((e.code, e.code.exit_code()), (ErrorCode::InvalidInput, 3), "{}", e.message);
        assert!(e.message.contains(words), "{}", e.message);
        assert!(e.hint.as_ref().is_some_and(|h| h.starts_with(hint)), "{:?}", e.hint);
    }
}

#[test]
fn a_seam_that_solving_does_not_close_is_a_result() {
    let mut narrow = generate::tube(8, 9);
    narrow.rest.iter_mut().for_each(|p| p.x *= 0.3);
    narrow.positions.iter_mut().for_each(|p| p.x *= 0.3);
    let e = refused(&narrow);
    assert_eq!((e.code, e.code.exit_code()), (ErrorCode::StitchingError, 4), "{}", e.message);
    assert!(
        e.message.starts_with("the seam 'side_") && e.message.contains(" stays open by "),
        "{}",
        e.message
    );
    assert!(e.detail.as_ref().is_some_and(|d| d.contains(" mm at ") && d.ends_with(" N a metre")), "{e:?}");
    assert_eq!(
        e.hint.as_deref(),
        Some(
            "let cloth pass through what lies in its way while it is sewn: `--set 'stages.test.sew_through=true'`; where the body is \
             in the way, cut the pieces wider or take a smaller body"
        )
    );
}

//! Sewing beside plain seams: gathers, darts, pleats, bands and folds.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::tests::*;
use super::*;
use crate::error::ClothError;
use crate::scene::{SceneError, Seam, StrainLimit, generate};
use crate::statics::levels::assemble::cloths;
use crate::statics::levels::pieces::Pieces;
use std::ops::ControlFlow;
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::ClothTree;

fn gap(scene: &Scene, x: &[Vec3]) -> f64 {
    let pairs = scene.seams.iter().flat_map(|s| &s.pairs);
    pairs.map(|p| (x[p[0] as usize] - x[p[1] as usize]).norm()).fold(0.0, f64::max)
}

fn length(x: &[Vec3], path: &[u32]) -> f64 {
    path.windows(2).map(|w| (x[w[1] as usize] - x[w[0] as usize]).norm()).sum()
}

/// A strip twice as long as the row of pins that it is sewn to, flat at the start: its slack folds.
#[test]
fn a_curtain_gathered_to_pins_folds() {
    for (cells, step) in [(20, 2), (20, 4)] {
        let mut scene = generate::hang(cells);
        scene.self_collision = true;
        scene.pinned.clear();
        scene.positions = scene.rest.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
        let top: Vec<u32> = (0..=cells).step_by(step).map(|i| cells * (cells + 1) + i).collect();
        let mut pairs = Vec::new();
        for &v in &top {
            let (rest, at) = (scene.rest[v as usize], scene.positions[v as usize]);
            let pin = scene.rest.len() as u32;
            scene.rest.push(rest);
            scene.positions.push(Vec3::new(0.5 * at.x, at.y + 0.05, 0.0));
            scene.pinned.push(pin);
            pairs.push([v, pin]);
        }
        scene.seams.push(Seam::new("rail", pairs.clone()));
        scene.panels[0].vertices.end = scene.rest.len();
        let state =
            StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(())).unwrap();
        for [a, b] in pairs {
            assert_eq!(state.positions[a as usize], state.positions[b as usize]);
        }
        let out = state.positions.iter().map(|p| p.z.abs()).fold(0.0, f64::max);
        assert!(out > 0.01, "it hangs in folds: {out}");
    }
}

#[test]
fn a_curtain_hangs_from_pins_that_belong_to_no_triangle() {
    // 24 cells go through several levels, 4 through one.
    for cells in [4, 24] {
        let scene = generate::curtain(cells);
        let [left, right] = scene.seams[0].pairs[..] else { panic!() };
        for graded in [false, true] {
            let state = StaticEquilibrium { bending_continuation: graded, ..StaticEquilibrium::default() }
                .solve(&scene, &mut |_, _| ControlFlow::Continue(()))
                .unwrap();
            let x = &state.positions;
            for [corner, pin] in [left, right] {
                assert_eq!(x[pin as usize], scene.positions[pin as usize]);
                assert_eq!(x[corner as usize], scene.positions[pin as usize]);
            }
            let lowest = x.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
            assert!(lowest < 1.05 - 0.95 && x.iter().all(|p| p.y < 1.05 + 1e-6), "{cells}: {lowest}");
        }
    }
}

#[test]
fn gathers_take_up_a_longer_edge_and_leave_the_shorter_one_alone() {
    let scene = generate::gathered(24, 12, 1.6);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    picture(&scene, x, "gathered");
    assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
    let seam: Vec<u32> = scene.seams[0].pairs.iter().map(|p| p[0]).collect();
    let long = length(x, &seam);
    assert!((long - 0.3).abs() < 0.01, "{long}");
    // Evenly: every cell of the frill is drawn together as much as the others.
    let cells: Vec<f64> = seam.windows(2).map(|w| length(x, w) / 0.0125).collect();
    assert!(cells.iter().all(|c| (c - 1.0).abs() < 0.05), "{cells:?}");
    // Below, the frill has its own width: it waves.
    let hem: Vec<u32> = (125..150).collect();
    let width = (x[149] - x[125]).norm();
    assert!((length(x, &hem) - 0.48).abs() < 0.005 && width < 0.42, "{} {width}", length(x, &hem));
    assert!(strains(&scene, x)[strains(&scene, x).len() * 9 / 10] < 0.02);
}

#[test]
fn a_dart_closes_and_its_panel_bulges() {
    let scene = generate::dart(10, 20);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    picture(&scene, x, "dart");
    assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
    let all = strains(&scene, x);
    assert!(all[all.len() * 98 / 100] < 0.02, "{}", all[all.len() * 98 / 100]);
    // The lower edge was 0.46 m wide and has lost the dart's 0.06.
    let ends = (x[0] - x[20]).norm();
    assert!(ends < 0.405, "{ends}");
    let deep = x.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max)
        - x.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    assert!(deep > 0.005, "{deep}");
}

#[test]
fn a_pleat_stays_folded_where_it_is_sewn() {
    let scene = generate::pleat(20, 15, 3);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    picture(&scene, x, "pleat");
    assert!(gap(&scene, x) < 5e-4, "{}", gap(&scene, x));
    assert_eq!(crossings_of_two_rows(&scene, x), 0);
    assert!(strains(&scene, x)[strains(&scene, x).len() * 98 / 100] < 0.02);
}

/// Crossings where the seam's two rows count as one.
fn crossings_of_two_rows(scene: &Scene, x: &[Vec3]) -> usize {
    let pieces = Pieces::new(scene);
    let sheet = pieces.open_sheet(&cloths(scene)).unwrap();
    ClothTree::new(sheet.triangles(), x).sewing(pieces.point.clone()).crossings(x).len()
}

#[test]
fn an_elastic_band_draws_its_edge_together() {
    let at = |ratio: f64| {
        let scene = generate::banded(20, 15, ratio);
        let state = settle(&scene).unwrap();
        picture(&scene, &state.positions, &format!("banded_{ratio}"));
        assert_eq!(crossings(&scene, &state.positions), 0);
        (
            length(&state.positions, &scene.bands[0].vertices),
            (state.positions[20] - state.positions[0]).norm(),
        )
    };
    // A band as long as the cloth does nothing.
    let (loose, _) = at(1.0);
    assert!((loose - 0.4).abs() < 1e-3, "{loose}");
    let (drawn, ends) = at(0.7);
    assert!(drawn < 0.39 && ends < 0.36, "{drawn} {ends}");
}

/// The angle between the outsides of the two sheets at the seam, degrees, from the rows beside it.
fn angle_at_seam(scene: &Scene, x: &[Vec3], n: usize) -> f64 {
    let at = |v: u32| x[v as usize];
    let middle = scene.seams[0].pairs[n / 2];
    let row = n as u32 + 1;
    let (up, down) = (at(middle[0] + row) - at(middle[0]), at(middle[1] - row) - at(middle[1]));
    // Both outsides look forward, to +z, where it lies flat.
    let fold = up.angle(&down).to_degrees();
    if down.z > 0.0 { fold } else { 360.0 - fold }
}

#[test]
fn a_seam_that_is_pressed_stays_folded() {
    for wanted in [90.0_f64, 270.0] {
        let scene = generate::folded(10, wanted.to_radians());
        let state = settle(&scene).unwrap();
        let x = &state.positions;
        picture(&scene, x, &format!("folded_{wanted}"));
        assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
        let found = angle_at_seam(&scene, x, 10);
        // Its weight opens it a little.
        assert!((found - wanted).abs() < 20.0, "{found} of {wanted}");
    }
    let flat = settle(&generate::folded(10, std::f64::consts::PI)).unwrap();
    assert!(flat.positions.iter().all(|p| p.z.abs() < 1e-6));
}

#[test]
fn three_sheets_meet_at_one_seam() {
    let scene = generate::three_sheets(24, 16);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    picture(&scene, x, "three_sheets");
    assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
    let all = strains(&scene, x);
    assert!(all[all.len() * 98 / 100] < 0.02, "{}", all[all.len() * 98 / 100]);
    // The outer panel hangs before the inner one.
    let (outer, inner) = (&scene.panels[1].vertices, &scene.panels[2].vertices);
    let low = |panel: &std::ops::Range<usize>| x[panel.start + 12].z;
    assert!(low(outer) > low(inner) + 1e-3, "{} {}", low(outer), low(inner));
}

#[test]
fn a_pocket_is_sewn_onto_a_panel() {
    let scene = generate::pocket(24);
    let state = settle(&scene).unwrap();
    let x = &state.positions;
    picture(&scene, x, "pocket");
    assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
    let all = strains(&scene, x);
    assert!(all[all.len() * 98 / 100] < 0.02, "{}", all[all.len() * 98 / 100]);
}

#[test]
fn a_fold_is_refused_where_it_cannot_be() {
    let mut scene = generate::folded(4, 2.5 * std::f64::consts::PI);
    let text = "fold = 450 is out of range: from 0 to 360 degrees";
    assert_eq!(scene.check().unwrap_err().to_string(), text);
    scene.seams[0].fold = Some(1.0);
    scene.seams[0].joined = false;
    let text =
        "seam 'fold' is to stay folded, but it is held by threads; leave out `joined: false` or `fold`";
    assert_eq!(scene.check().unwrap_err().to_string(), text);
}

#[test]
fn what_is_wrong_with_gathers_and_bands_is_named() {
    let mut scene = generate::gathered(8, 4, 1.5);
    scene.seams[0].gather = Some(2.0);
    let text = "seam 'gathers' is to gather 2 to 1, but its sides are 1.500 to 1";
    assert_eq!(scene.check().unwrap_err().to_string(), text);
    let mut scene = generate::gathered(8, 4, 1.5);
    let band =
        |vertices: Vec<u32>| crate::scene::Band { name: "b".into(), vertices, ratio: 0.9, stiffness: 1.0 };
    scene.bands = vec![band(vec![0, 60])];
    let text = "band 'b': vertices 0 and 60 lie on two panels and are not sewn together";
    assert_eq!(scene.check().unwrap_err().to_string(), text);
    scene.bands = vec![band(vec![0])];
    assert_eq!(scene.check().unwrap_err().to_string(), "band 'b': its path needs two vertices");
    scene.bands = vec![band(vec![0, 600])];
    assert_eq!(
        scene.check().unwrap_err().to_string(),
        "band vertex 1 refers to vertex 600, but there are 90"
    );
    scene.bands = vec![];
    scene.strain_limit = Some(StrainLimit { warp: 0.0, weft: 0.1 });
    assert!(matches!(scene.check(), Err(SceneError::Cloth(_))));
    assert_eq!(scene.check().unwrap_err().to_string(), "strain_limit.warp = 0 is out of range: above 0");
}

#[test]
fn a_strain_limit_holds_or_is_named() {
    // A sheet held at two corners strains by more than 2 % there.
    let mut scene = generate::hang(12);
    let greatest = |x: &[Vec3]| {
        let sheet = Pieces::new(&scene).sewn_sheet(&cloths(&scene)).unwrap();
        let yarn =
            |t: usize| sheet.deformation(t, x).column_iter().map(|c| c.norm() - 1.0).fold(0.0, f64::max);
        (0..scene.triangles.len()).map(yarn).fold(0.0, f64::max)
    };
    let free = greatest(&settle(&scene).unwrap().positions);
    assert!(free > 0.02, "{free}");
    let mut limited = scene.clone();
    limited.strain_limit = Some(StrainLimit { warp: 0.01, weft: 0.01 });
    let held = greatest(&settle(&limited).unwrap().positions);
    assert!(held <= 0.01, "{held}");
    // A weight of tons is more than any fabric holds.
    scene.material.density = 300.0;
    scene.strain_limit = Some(StrainLimit { warp: 0.01, weft: 0.01 });
    match settle(&scene).unwrap_err() {
        StaticsError::Cloth(ClothError::StrainLimitExceeded { strain, limit, .. }) => {
            assert!(strain > 0.01 && limit == 0.01);
        }
        error => panic!("{error}"),
    }
}

/// A skirt whose front panel starts through its back panel: beside the body a strip of it stands
/// behind that.
fn crossed() -> Scene {
    let mut scene = generate::tube(12, 16);
    let widest = scene.positions.iter().map(|p| p.x).fold(0.0, f64::max);
    let front = scene.panels[0].vertices.clone();
    scene.positions[front].iter_mut().filter(|p| p.x > 0.7 * widest).for_each(|p| p.z *= -1.4);
    scene
}

#[test]
fn a_skirt_whose_panels_start_behind_each_other_is_sewn_through_and_ends_as_ever() {
    let scene = crossed();
    let plain = StaticEquilibrium { bending_continuation: true, ..StaticEquilibrium::default() };
    let refused = plain.solve(&scene, &mut |_, _| ControlFlow::Continue(())).err();
    assert!(matches!(refused, Some(StaticsError::Start(StartError::Crossing { .. }))));
    let through = StaticEquilibrium { sew_through: true, ..plain };
    let state =
        through.solve(&scene, &mut |_, _| ControlFlow::Continue(())).map_err(|e| e.to_string()).unwrap();
    let x = &state.positions;
    picture(&scene, x, "sewn_through");
    assert_eq!((gap(&scene, x), crossings(&scene, x)), (0.0, 0));
    let middle = x.iter().map(|p| p.y).sum::<f64>() / x.len() as f64;
    let as_ever =
        plain.solve(&generate::tube(12, 16), &mut |_, _| ControlFlow::Continue(())).unwrap().positions;
    let wanted = as_ever.iter().map(|p| p.y).sum::<f64>() / x.len() as f64;
    assert!((middle - wanted).abs() < 0.05, "{middle} {wanted}");
}

#[test]
fn a_skirt_is_sewn_on_a_lowered_body_and_lifted_by_it() {
    let scene = crossed();
    let solid = |lower: f64| {
        let body = scene.body.as_ref().unwrap();
        let down = |p: &Vec3| p - Vec3::y() * lower;
        Body::new(body.vertices.iter().map(down).collect(), &body.triangles)
    };
    let (low, middle, body) = (solid(0.06), solid(0.03), solid(0.0));
    let collider = Collider { surface: &body, friction: scene.body.as_ref().unwrap().friction };
    let through =
        StaticEquilibrium { bending_continuation: true, sew_through: true, ..StaticEquilibrium::default() };
    let solve = |around: &[&dyn CollisionSurface]| {
        through
            .solve_around(&scene, Some(collider), around, &Stopper::default(), &mut |_, _| {
                ControlFlow::Continue(())
            })
            .unwrap()
            .positions
    };
    let (lifted, direct) = (solve(&[&low, &middle]), solve(&[]));
    assert_ne!(lifted, direct, "what it is sewn on has its share");
    assert_eq!((gap(&scene, &lifted), crossings(&scene, &lifted)), (0.0, 0));
    let inside = CollisionSurface::nearest(&body, &lifted, &vec![1.0; lifted.len()]);
    let inside = inside.iter().flatten().any(|n| n.distance < 0.0);
    assert!(!inside);
    let height = |x: &[Vec3]| x.iter().map(|p| p.y).sum::<f64>() / x.len() as f64;
    assert!((height(&lifted) - height(&direct)).abs() < 0.05, "{} {}", height(&lifted), height(&direct));
}

#[test]
fn a_share_of_the_vertices_may_still_move() {
    // A small mesh: on large ones both runs go other ways from the coarser levels on.
    let scene = generate::drape(10);
    let steps = |settings: StaticEquilibrium| {
        let state =
            settings.solve(&scene, &mut |_, _| ControlFlow::Continue(())).map_err(|e| e.to_string()).unwrap();
        assert!(state.outcome.non_static <= settings.non_static && state.outcome.speed < settings.speed);
        if settings.non_static == 0.0 {
            assert_eq!(state.outcome.speed, state.outcome.fastest);
        }
        state.levels.iter().map(|l| l.outcome.steps).sum::<usize>()
    };
    let (all, most) = (
        steps(StaticEquilibrium::default()),
        steps(StaticEquilibrium { non_static: 0.2, ..StaticEquilibrium::default() }),
    );
    assert!(most < all, "{most} {all}");
}

#[test]
fn a_seam_may_sew_a_right_side_to_a_wrong_side() {
    // The dart's panel with one half mirrored: its triangles run the other way round where the two
    // halves meet.
    let mut scene = generate::gathered(8, 4, 1.0 + 1e-9);
    scene.seams.iter_mut().for_each(|s| s.gather = None);
    let frill = scene.panels[0].clone();
    scene.rest[frill.vertices.clone()].iter_mut().for_each(|p| p.x = -p.x);
    scene.triangles[frill.triangles].iter_mut().for_each(|t| t.swap(1, 2));
    let state = settle(&scene).unwrap();
    assert_eq!((gap(&scene, &state.positions), crossings(&scene, &state.positions)), (0.0, 0));
}

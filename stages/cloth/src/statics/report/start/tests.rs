#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;
use crate::scene::{Seam, generate};
use crate::statics::report::error::StaticsError;
use nalgebra::Vector2;

/// All that is said of a scene's start, with a body that is the scene's own.
fn told(scene: &Scene) -> Result<(), String> {
    let body = scene.body.as_ref().map(|b| crate::contact::body::Body::new(b.vertices.clone(), &b.triangles));
    let surface = body.as_ref().map(|b| b as &dyn CollisionSurface);
    let pieces = Pieces::new(scene);
    let start = check::<StaticsError>(scene, surface, 5e-4).map_err(|e| e.to_string())?;
    let crossings = crossings_at_start(scene, &pieces, &start).unwrap();
    if let Some(error) = crossing(scene, &pieces.panel, &start, &crossings) {
        return Err(error.to_string());
    }
    check_lying::<StaticsError>(scene, &pieces, &start).map_err(|e| e.to_string())
}

/// So many squares of half a metre that stand parallel, this far apart.
fn sheets(count: usize, apart: f64) -> Scene {
    let one = generate::hang(6);
    let mut scene = Scene { panels: vec![], ..Scene::new("sheets", generate::cloth()) };
    for k in 0..count {
        let at: Vec<Vec3> =
            one.rest.iter().map(|p| Vec3::new(0.5 * p.x, 0.5 * p.y + 1.0, k as f64 * apart)).collect();
        let rest: Vec<Vector2<f64>> = one.rest.iter().map(|p| 0.5 * p).collect();
        scene.add_panel(["one", "two", "three"][k], &rest, &at, &one.triangles);
    }
    scene
}

/// A panel of `nx` by 2 cells whose points are placed by a function of how far along and across
/// they are, 0 to 1, sewn end to end with a twist.
fn twisted_band(place: impl Fn(f64, f64) -> Vec3) -> Scene {
    let (nx, width, length) = (20u32, 0.1, 1.0);
    let mut scene = Scene::new("band", generate::cloth());
    let at = |i: u32, j: u32| (f64::from(i) / f64::from(nx), f64::from(j) / 2.0);
    let points: Vec<(f64, f64)> = (0..3).flat_map(|j| (0..=nx).map(move |i| at(i, j))).collect();
    let rest: Vec<Vector2<f64>> = points.iter().map(|(s, t)| Vector2::new(length * s, width * t)).collect();
    let positions: Vec<Vec3> = points.iter().map(|(s, t)| place(*s, *t)).collect();
    let vertex = |i: u32, j: u32| j * (nx + 1) + i;
    let triangles: Vec<[u32; 3]> = (0..2)
        .flat_map(|j| (0..nx).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    scene.add_panel("band", &rest, &positions, &triangles);
    scene.seams = vec![Seam::new("twist", (0..3).map(|j| [vertex(0, j), vertex(nx, 2 - j)]).collect())];
    scene
}

fn turn_round(seam: &mut Seam) {
    let mut second: Vec<u32> = seam.pairs.iter().map(|p| p[1]).collect();
    second.reverse();
    seam.pairs.iter_mut().zip(second).for_each(|(p, v)| p[1] = v);
}

#[test]
fn a_good_start_is_left_alone() {
    for scene in [generate::tube(8, 9), generate::layered(8, 9), generate::sleeve(8, 9), sheets(3, 1e-3)] {
        assert_eq!(told(&scene), Ok(()), "{}", scene.name);
    }
}

#[test]
fn panels_at_one_place_are_named() {
    let error = told(&sheets(2, 0.0)).unwrap_err();
    assert_eq!(
        error,
        "panels 'one' and 'two' lie in each other at the start: 100 % of panel 'one' is nearer than 0.020 mm, one place is (-0.194, \
         0.778, 0.000) m; lay them 1.0 mm apart, which is the thickness of the cloth"
    );
    let error = told(&sheets(3, 1e-6)).unwrap_err();
    assert!(error.starts_with("panels 'one' and 'two' lie in each other at the start"), "{error}");
    assert!(error.contains(", and so do 2 other pairs of panels; "), "{error}");
    assert_eq!(told(&sheets(2, 3e-5)), Ok(()), "contact pushes these apart");
}

#[test]
fn panels_that_lap_a_little_come_apart() {
    let lapped = |share: f64| {
        let mut scene = sheets(2, 0.0);
        let second = scene.panels[1].vertices.clone();
        scene.positions[second].iter_mut().for_each(|p| p.x += 0.5 * (1.0 - share));
        told(&scene)
    };
    assert_eq!(lapped(0.02), Ok(()));
    assert!(lapped(0.5).unwrap_err().contains("lie in each other"));
}

#[test]
fn a_panel_that_pierces_another_is_named_with_the_place() {
    let mut scene = sheets(3, 0.2);
    // The second stands across the first.
    let second = scene.panels[1].vertices.clone();
    scene.positions[second].iter_mut().for_each(|p| *p = Vec3::new(0.013, p.y + 0.011, 0.3 * p.x));
    let error = told(&scene).unwrap_err();
    assert!(error.starts_with("panels 'one' and 'two' pass through each other at the start: "), "{error}");
    assert!(error.contains(" pairs of an edge and a triangle cross, one at ("), "{error}");
    assert!(error.ends_with(" m; lay them out so that none do"), "{error}");
}

#[test]
fn panels_that_touch_at_their_borders_do_not_cross() {
    // A floor and a wall that stands on its edge, and a wall that stands on its middle.
    for (at, crosses) in [(0.25, false), (0.0, false)] {
        let mut scene = sheets(2, 0.0);
        let second = scene.panels[1].vertices.clone();
        scene.positions[second].iter_mut().for_each(|p| *p = Vec3::new(at, p.y, p.x + 0.25));
        assert_eq!(told(&scene).is_err(), crosses, "{at} {:?}", told(&scene));
    }
}

#[test]
fn seams_whose_pairs_run_against_each_other_are_named() {
    let mut scene = generate::tube(8, 9);
    turn_round(&mut scene.seams[0]);
    let one = told(&scene).unwrap_err();
    assert_eq!(
        one,
        "the pairs of seam 'side_left' run against each other: the two sides start 481 mm apart in the mean, and 340 mm if the order \
         of one is turned round; list the second vertices of the pairs in reverse order"
    );
    turn_round(&mut scene.seams[1]);
    let both = told(&scene).unwrap_err();
    assert!(
        both.starts_with("the pairs of seams 'side_left' and 'side_right' run against each other: "),
        "{both}"
    );
    // In whatever order its pairs are listed.
    scene.seams[0].pairs.sort_by_key(|p| (p[0] * 7919) % 101);
    assert_eq!(told(&scene).unwrap_err(), both);
}

#[test]
fn a_seam_all_round_is_told_by_its_direction_and_not_by_where_it_is_listed_from() {
    let mut scene = sheets(2, 0.05);
    let n = scene.panels[0].vertices.len() as u32;
    let side = 7;
    let mut border: Vec<u32> = (0..side).collect();
    border.extend((1..side).map(|j| j * side + side - 1));
    border.extend((0..side - 1).rev().map(|i| (side - 1) * side + i));
    border.extend((1..side - 1).rev().map(|j| j * side));
    let whole = Seam::new("neck", border.iter().map(|&v| [v, v + n]).collect());
    let listed = |seam: &Seam| {
        let one = Scene { seams: vec![seam.clone()], ..scene.clone() };
        seams::check_order(&one, &one.positions)
    };
    assert_eq!(listed(&whole), Ok(()));
    let mut reversed = whole.clone();
    turn_round(&mut reversed);
    assert!(matches!(listed(&reversed), Err(StartError::Reversed { seams, .. }) if seams == ["neck"]));
    // Half a turn on, the sides run the same way.
    let shifted = (0..border.len()).map(|i| [border[i], border[(i + 12) % border.len()] + n]).collect();
    assert_eq!(listed(&Seam::new("neck", shifted)), Ok(()));
    scene.seams = vec![whole];
}

#[test]
fn a_band_that_is_twisted_on_purpose_is_no_fault() {
    let flat = twisted_band(|s, t| Vec3::new(s, 0.1 * t, 0.0));
    assert_eq!(seams::check_order(&flat, &flat.positions), Ok(()));
    let ring = twisted_band(|s, t| {
        let angle = 6.0 * s;
        Vec3::new(0.16 * angle.cos(), 0.1 * t, 0.16 * angle.sin())
    });
    assert_eq!(told(&ring), Ok(()), "without a body it may turn over");
    assert_eq!(probably_reversed(&ring, &ring.positions), ["twist"], "but it is named if it does not close");
    let good = generate::tube(8, 9);
    assert_eq!(probably_reversed(&good, &good.positions), [""; 0]);
}

#[test]
fn a_seam_between_pins_is_refused() {
    let mut scene = sheets(2, 0.05);
    scene.seams = vec![Seam::new("rail", vec![[0, 49], [1, 50]])];
    scene.pinned = vec![1, 50];
    assert_eq!(
        told(&scene).unwrap_err(),
        "seam 'rail' sews together vertices that are pinned 50.0 mm apart; pin them at one place, or unpin one of them"
    );
    scene.pinned = vec![1, 49];
    assert_eq!(told(&scene), Ok(()));
}

#[test]
fn vertices_deep_in_the_body_are_told_with_their_panel() {
    let mut scene = generate::tube(8, 9);
    scene.positions.iter_mut().for_each(|p| p.z *= 0.2);
    let error = told(&scene).unwrap_err();
    assert!(error.contains(" vertices start inside the body, the deepest by "), "{error}");
    assert!(error.contains(" mm: of panel 'back' at ("), "{error}");
    assert!(
        error
            .ends_with(" m; place the panels outside it, for only what is less than 50 mm deep is moved out"),
        "{error}"
    );
}

#[test]
fn a_panel_that_starts_squeezed_is_told_from_one_that_is_narrow() {
    let strip = |width: f64, start: f64| {
        let mut scene = Scene::new("strip", generate::cloth());
        let (rest, at): (Vec<Vector2<f64>>, Vec<Vec3>) = (0..202)
            .map(|k| (f64::from(k % 101) * 0.005, f64::from(k / 101)))
            .map(|(x, t)| (Vector2::new(x, width * t), Vec3::new(x, 1.0, start * t)))
            .unzip();
        let triangles: Vec<[u32; 3]> =
            (0..100).flat_map(|i| [[i, i + 1, i + 102], [i, i + 102, i + 101]]).collect();
        scene.add_panel("strip", &rest, &at, &triangles);
        told(&scene)
    };
    assert_eq!(strip(2e-3, 2e-3), Ok(()));
    assert_eq!(strip(5e-5, 5e-5), Ok(()));
    assert_eq!(
        strip(2e-3, 2e-6).unwrap_err(),
        "panel 'strip' starts squeezed together: 100 % of it is so narrow that it lies in itself, at (0.003, 1.000, 0.000) m a triangle \
         that is cut 1.857 mm high starts with 0.002 mm; lay it out as large as it is cut"
    );
    assert!(strip(2e-3, 0.0).unwrap_err().contains("starts with 0.000 mm"));
}

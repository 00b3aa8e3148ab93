use super::*;
use crate::distortion::distortion;
use crate::flatteners::{Flattening, Placement, Tension};
use crate::islands::{SurfacePieces, islands_by_group, split_components};
use crate::newton::StoppingLimits;
use crate::shapes::{bump, cone, grid, surface};
use nalgebra::Point3;

/// A tube about y with a bulge that is off its axis, of two halves, front and back.
fn bulged_tube(lean: f64) -> SurfacePieces {
    let (places, triangles) = grid(24, 12, |u, v| {
        let a = std::f64::consts::TAU * u;
        let r = 1.0 + 0.3 * (-8.0 * (v - 0.5).powi(2)).exp() * (1.2 + a.cos() + lean * a.sin());
        [-r * a.sin(), 3.0 * v, r * a.cos()]
    });
    let weld = |v: u32| v / 25 * 25 + v % 25 % 24;
    let triangles: Vec<_> = triangles.iter().map(|t| t.map(weld)).collect();
    // Fronts: the quarters around u = 0 and u = 1.
    let groups: Vec<u32> = (0..triangles.len()).map(|t| u32::from((6..18).contains(&(t / 2 % 24)))).collect();
    islands_by_group(&places, &triangles, &groups).unwrap_or_else(|e| unreachable!("{e}"))
}

fn defaults(garment: &SurfacePieces) -> Vec<Placement> {
    vec![Placement::default(); garment.pieces.len()]
}

fn flats(garment: &SurfacePieces, objective: Objective, placement: &Placement) -> Vec<Flattening> {
    let flatten = |s| objective.flatten(s, StoppingLimits::default(), placement);
    garment.pieces.iter().map(|p| flatten(&p.surface).unwrap_or_else(|e| unreachable!("{e}"))).collect()
}

#[test]
fn seams_come_out_equal_and_areas_stay() {
    let woven = Objective::Woven(crate::energy::WovenStiffness::COTTON);
    let stretched = Placement { tension: Tension { warp: 0.0, weft: 0.2 }, ..Placement::default() };
    for (objective, placement) in [
        (Objective::Arap, Placement::default()),
        (Objective::SymmetricDirichlet, stretched),
        (woven, Placement::default()),
    ] {
        let garment = bulged_tube(0.5);
        let mut flat = flats(&garment, objective, &placement);
        let before: Vec<f64> = areas(&garment, &flat);
        let report =
            refine(&garment, &mut flat, &objective, &[placement.clone(), placement], CareOptions::default());
        let Ok(report) = report else { unreachable!("{report:?}") };
        assert_eq!(report.seams.len(), 2);
        for s in &report.seams {
            assert!(SeamLengths::mismatch(s.before) > 1e-3, "{s:?}");
            assert!(SeamLengths::mismatch(s.after) < 1e-4, "{s:?} {:?} {:?}", flat[0].report, flat[1].report);
        }
        for (a, b) in before.iter().zip(areas(&garment, &flat)) {
            assert!((a / b - 1.0).abs() < 0.02);
        }
    }
}

fn areas(garment: &SurfacePieces, flat: &[Flattening]) -> Vec<f64> {
    let area = |(p, f): (&crate::islands::SurfacePiece, &Flattening)| {
        distortion(&p.surface, &f.points).map_or(0.0, |d| d.area_2d)
    };
    garment.pieces.iter().zip(flat).map(area).collect()
}

#[test]
fn nearly_straight_edges_become_straight() {
    let (places, triangles) = grid(20, 20, |u, v| [u, v + 0.002 * (9.0 * u).sin(), 0.05 * (u * v)]);
    let Ok(garment) = split_components(&places, &triangles) else { unreachable!() };
    let mut flat = flats(&garment, Objective::Arap, &Placement::default());
    let report = refine(&garment, &mut flat, &Objective::Arap, &defaults(&garment), CareOptions::default());
    assert_eq!(report.map(|r| r.straight), Ok(vec![4]));
    let chains = boundary_chains(&garment.pieces[0].surface, &flat[0].points, &[], 0.5);
    assert_eq!(chains.len(), 4);
    assert!(chains.iter().all(|c| is_straight(c, &flat[0].points, 1e-9)));
    assert!(flat[0].flipped(&garment.pieces[0].surface).is_empty());
}

#[test]
fn left_and_right_become_mirror_images() {
    let garment = bulged_tube(0.0);
    // Each half is symmetric in itself; so are two sleeves, left and right.
    let sleeve = |side: f64| {
        grid(9, 9, move |u, v| {
            let bulge = (-(u - 0.3).powi(2) - (v - 0.6).powi(2)).exp();
            [side * (3.0 + u), v, bulge]
        })
    };
    let (mut places, mut triangles) = sleeve(1.0);
    let (right, turned) = sleeve(-1.0);
    triangles.extend(turned.iter().map(|&[a, b, c]| [a + 100, c + 100, b + 100]));
    places.extend(right);
    let Ok(sleeves) = split_components(&places, &triangles) else { unreachable!() };
    for (garment, expected) in [(garment, [[0, 0], [1, 1]].to_vec()), (sleeves, [[0, 1]].to_vec())] {
        let mut flat = flats(&garment, Objective::Arap, &Placement::default());
        // As a solver that stops early leaves them.
        flat[0].points[5].x += 1e-3;
        let report =
            refine(&garment, &mut flat, &Objective::Arap, &defaults(&garment), CareOptions::default());
        let Ok(report) = report else { unreachable!("{report:?}") };
        assert_eq!(report.mirrors.iter().map(|(p, _)| [p.a, p.b]).collect::<Vec<_>>(), expected);
        for (pair, before) in &report.mirrors {
            let after = mirror_distance(pair, &flat[pair.a].points, &flat[pair.b].points);
            assert!(after < 1e-9 && after <= *before, "{before} {after}");
        }
    }
}

#[test]
fn left_and_right_of_different_meshes_get_mirrored_outlines() {
    let sleeve = |side: f64, m: usize, n: usize| {
        grid(m, n, move |u, v| {
            [side * (3.0 + u + 0.3 * v), v + 0.1 * u * u, 0.3 * (3.0 * (u - 0.4)).cos() * (2.0 * v).cos()]
        })
    };
    let (mut places, mut triangles) = sleeve(1.0, 18, 18);
    let first = places.len() as u32;
    let (right, turned) = sleeve(-1.0, 23, 16);
    triangles.extend(turned.iter().map(|&[a, b, c]| [a + first, c + first, b + first]));
    places.extend(right);
    let Ok(sleeves) = split_components(&places, &triangles) else { unreachable!() };
    let mut flat = flats(&sleeves, Objective::Arap, &Placement::default());
    // As a drape that differs from left to right leaves them.
    flat[0].points.iter_mut().for_each(|p| p.x *= 1.01);
    let options = CareOptions { straight: 0.0, ..CareOptions::default() };
    let report = refine(&sleeves, &mut flat, &Objective::Arap, &defaults(&sleeves), options);
    let Ok(report) = report else { unreachable!("{report:?}") };
    assert_eq!(report.mirrors.len(), 0);
    let pairs: Vec<_> = report.outlines.iter().map(|p| [p.a, p.b]).collect();
    assert_eq!(pairs, [[0, 1]]);
    let pair = report.outlines[0];
    assert!(pair.after < 0.2 * pair.before && pair.after < 5e-4, "{pair:?}");
    // They stand like mirror images: the lower left corner of the one is the lower right of the
    // other.
    let place = |i: usize, v: u32| {
        let k = sleeves.pieces[i].vertices.iter().position(|&u| u == v);
        k.map(|k| flat[i].points[k]).unwrap_or_default()
    };
    let across = |i: usize, from: u32, to: u32| place(i, to) - place(i, from);
    let (first, second) = (across(0, 0, 18), across(1, first, first + 23));
    assert!((first.x + second.x).abs() < 1e-3 && (first.y - second.y).abs() < 1e-3, "{first} {second}");
    assert!(flat.iter().zip(&sleeves.pieces).all(|(f, p)| f.flipped(&p.surface).is_empty()));
}

#[test]
fn a_dart_that_was_sewn_shut_is_found_again() {
    // A cone with 30 degrees missing: its tip is vertex 0.
    let s = surface(cone(12, 36, 30f64.to_radians()));
    let darts = propose_darts(&s, &Objective::Arap, &Placement::default(), DartOptions::default());
    let Ok(darts) = darts else { unreachable!("{darts:?}") };
    assert_eq!(darts.len(), 1);
    assert_eq!(darts[0].path.last(), Some(&0));
    assert!(darts[0].saves > 0.999 && darts[0].strain[0] > 0.015 && darts[0].strain[1] < 1e-3);
    let Ok(cut) = cut_darts(&s, &darts) else { unreachable!() };
    assert_eq!((cut.pieces.len(), cut.seams.len()), (1, 1));
    let flat =
        Objective::Arap.flatten(&cut.pieces[0].surface, StoppingLimits::default(), &Placement::default());
    let error = flat.map(|f| distortion(&cut.pieces[0].surface, &f.points).map(|d| d.local_area_error));
    assert!(error.is_ok_and(|e| e.is_ok_and(|e| e < 1e-4)));
}

#[test]
fn darts_follow_a_grain_that_is_an_edge() {
    // The same cone, its grain from the tip to the rim at the right: there it is cut.
    let (s, rim) = (surface(cone(12, 36, 30f64.to_radians())), 1 + 11 * 36 + 9);
    let placement = Placement { grain: crate::grain::Grain::Edge([0, rim]), ..Placement::default() };
    let darts = propose_darts(&s, &Objective::Arap, &placement, DartOptions::default());
    let Ok(darts) = darts else { unreachable!("{darts:?}") };
    let end = s.positions()[darts[0].path[0] as usize];
    assert!(end.y.abs() < 0.3 * end.x.abs(), "{end}");
}

#[test]
fn a_dart_between_the_vertices_is_found_within_a_cell() {
    // A cone on a panel 40 x 50 cm, cells of 1 cm, its tip between vertices; 25 degrees are missing
    // around it.
    let slope = ((1.0f64 / (1.0 - 25.0 / 360.0)).powi(2) - 1.0).sqrt();
    let bodice = surface(grid(40, 50, |u, v| {
        let (x, y) = (40.0 * u - 20.0, 50.0 * v);
        [x, y, -slope * (x - 4.7).hypot(y - 30.4)]
    }));
    let darts = propose_darts(&bodice, &Objective::Arap, &Placement::default(), DartOptions::default());
    let Ok(darts) = darts else { unreachable!("{darts:?}") };
    assert_eq!(darts.iter().map(|d| d.mirror).collect::<Vec<_>>(), [None]);
    let tip = darts[0].path.last().map_or(Point3::origin(), |&v| bodice.positions()[v as usize]);
    assert!((tip.x - 4.7).hypot(tip.y - 30.4) < 1.5, "{tip}");
    // Along the grain: from below or above, not from the side.
    let start = bodice.positions()[darts[0].path[0] as usize];
    assert!((start.x - tip.x).abs() < 3.0, "{start} {tip}");
}

#[test]
fn a_dart_does_not_run_on_through_the_tip_of_another() {
    // Two cones side by side, unlike enough not to be mirror images: one cut through both tips
    // would save the most.
    let hill = |x: f64, y: f64, at: f64, high: f64| (high - 0.6 * (x - at).hypot(y)).max(0.0);
    let bodice = surface(grid(30, 24, |u, v| {
        let (x, y) = (2.5 * u - 1.25, 2.0 * v - 1.0);
        [x, y, hill(x, y, -0.7, 0.24) + hill(x, y, 0.7, 0.22)]
    }));
    let darts = propose_darts(
        &bodice,
        &Objective::Arap,
        &Placement::default(),
        DartOptions { most: 4, ..Default::default() },
    );
    let Ok(darts) = darts else { unreachable!("{darts:?}") };
    assert!(darts.len() >= 2, "{}", darts.len());
    for dart in &darts {
        let place = |v: &u32| bodice.positions()[*v as usize];
        let ends = [dart.path.first(), dart.path.last()].map(|v| v.map_or(Point3::origin(), place));
        // From the one cone's side of the piece, not across the middle.
        assert!(ends[0].x * ends[1].x > 0.0, "{} {}", ends[0], ends[1]);
    }
}

#[test]
fn a_symmetric_piece_gets_mirrored_darts_and_a_flat_one_none() {
    let twin = |x: f64, y: f64| 0.35 * (-12.0 * ((x - 0.5).powi(2) + y * y)).exp();
    let bodice = surface(grid(24, 24, |u, v| {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        [x, y, twin(x, y) + twin(-x, y)]
    }));
    let options = DartOptions { most: 2, ..DartOptions::default() };
    let darts = propose_darts(&bodice, &Objective::SymmetricDirichlet, &Placement::default(), options);
    let Ok(darts) = darts else { unreachable!("{darts:?}") };
    assert_eq!(darts.iter().map(|d| d.mirror).collect::<Vec<_>>(), [Some(1), Some(0)]);
    let tip = |d: &Dart| d.path.last().map_or(Point3::origin(), |&v| bodice.positions()[v as usize]);
    assert!((tip(&darts[0]).x + tip(&darts[1]).x).abs() < 1e-9);

    let gentle = surface(bump(16, 16, 0.05));
    let none = propose_darts(&gentle, &Objective::Arap, &Placement::default(), DartOptions::default());
    assert_eq!(none, Ok(Vec::new()));
}

#[test]
fn what_is_out_of_range_is_refused() {
    let garment = bulged_tube(0.0);
    let mut flat = flats(&garment, Objective::Arap, &Placement::default());
    let mut refused = |options| {
        let report = refine(&garment, &mut flat, &Objective::Arap, &defaults(&garment), options);
        report.map_or_else(|e| e.to_string(), |_| String::new())
    };
    let straight = CareOptions { straight: 0.5, ..CareOptions::default() };
    assert_eq!(refused(straight), "straight = 0.5 is out of range: a share from 0 to below 0.2");
    let corner = CareOptions { corner: 0.0, ..CareOptions::default() };
    assert_eq!(refused(corner), "corner = 0 is out of range: an angle above 0 and below 180 degrees");
    let mirror = CareOptions { mirror: -1.0, ..CareOptions::default() };
    assert_eq!(refused(mirror), "mirror = -1 is out of range: a share from 0 to below 0.1");
    let report =
        refine(&garment, &mut flat[..1], &Objective::Arap, &defaults(&garment), CareOptions::default());
    let text = report.map_or_else(|e| e.to_string(), |_| String::new());
    assert_eq!(text, "flat pieces has 1 entries, but 2 are wanted");
    let report = refine(&garment, &mut flat, &Objective::Arap, &[], CareOptions::default());
    let text = report.map_or_else(|e| e.to_string(), |_| String::new());
    assert_eq!(text, "placements has 0 entries, but 2 are wanted");
    let s = &garment.pieces[0].surface;
    let darts = |options| {
        let darts = propose_darts(s, &Objective::Arap, &Placement::default(), options);
        darts.map_or_else(|e| e.to_string(), |_| String::new())
    };
    let strain = DartOptions { max_strain: 0.0, ..DartOptions::default() };
    assert_eq!(darts(strain), "max_strain = 0 is out of range: a finite strain above 0");
    let saving = DartOptions { least_saving: 1.0, ..DartOptions::default() };
    assert_eq!(darts(saving), "least_saving = 1 is out of range: a share above 0 and below 1");
    let most = DartOptions { most: 0, ..DartOptions::default() };
    assert_eq!(darts(most), "most = 0 is out of range: 1 or more");
}

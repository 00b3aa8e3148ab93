//! What the smoothers promise.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::{Laplacian, PlaneSmoother, PlaneSmoothing, Taubin, smooth_to_planes};
use crate::mesh::fixtures::{annulus, darted, disc, vest};
use crate::mesh::{DelaunayMesher, GridMesher};
use proptest::prelude::*;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

type Smoother = fn(&Panel) -> Result<Panel, StageError>;

fn plane(panel: &Panel) -> Result<Panel, StageError> {
    PlaneSmoother { lambda: 0.5, iterations: 20 }.run(panel, &Context::quiet())
}

fn laplacian(panel: &Panel) -> Result<Panel, StageError> {
    Laplacian { lambda: 0.5, iterations: 20 }.run(panel, &Context::quiet())
}

fn taubin(panel: &Panel) -> Result<Panel, StageError> {
    Taubin { lambda: 0.5, mu: -0.53, iterations: 20 }.run(panel, &Context::quiet())
}

const SMOOTHERS: [(&str, Smoother); 3] = [("plane", plane), ("laplacian", laplacian), ("taubin", taubin)];

fn gridded(outline: &Outline) -> Panel {
    GridMesher { edge: Length::mm(12.0) }.run(outline, &Context::quiet()).unwrap()
}

fn chain_length(panel: &Panel, chain: &[u32]) -> f64 {
    polyline_length(&chain.iter().map(|&v| panel.positions[v as usize]).collect::<Vec<_>>())
}

/// What no smoother may break.
fn check_kept(before: &Panel, after: &Panel) {
    assert_eq!(before.triangles, after.triangles);
    assert!(after.triangles.iter().all(|t| after.triangle_area(*t) > 0.0), "a triangle turned over");
    assert!(after.least_angle() >= before.least_angle().min(19.99));
    for (b, a) in before.edges.iter().zip(&after.edges) {
        let ratio = chain_length(after, &a.vertices) / chain_length(before, &b.vertices);
        assert!((ratio - 1.0).abs() < 1e-3, "{}: {ratio}", a.name);
        for v in [b.vertices[0], *b.vertices.last().unwrap()] {
            assert_eq!(before.positions[v as usize], after.positions[v as usize], "a corner moved");
        }
    }
    for &v in before.inner.iter().flat_map(|c| &c.vertices) {
        assert_eq!(before.positions[v as usize], after.positions[v as usize], "an inner line moved");
    }
    for (k, &v) in before.boundary.iter().enumerate() {
        let next = before.boundary[(k + 1) % before.boundary.len()] as usize;
        let side = (before.positions[next] - before.positions[v as usize]).norm();
        let moved = (after.positions[v as usize] - before.positions[v as usize]).norm();
        assert!(moved <= 0.01 * side, "the outline moved by {} of its sides", moved / side);
    }
}

#[test]
fn panels_keep_their_outline_corners_lengths_and_triangles() {
    for outline in [vest(), darted(), annulus(), disc()] {
        for panel in [gridded(&outline), DelaunayMesher::default().run(&outline, &Context::quiet()).unwrap()]
        {
            for (name, smoother) in SMOOTHERS {
                let smoothed = smoother(&panel).expect(name);
                check_kept(&panel, &smoothed);
            }
        }
    }
}

/// The vest's mesh with every second vertex of its hem lifted by 60 micrometres.
fn burred() -> (Panel, f64) {
    let mut panel = gridded(&vest());
    let burr = 60e-6;
    let hem = panel.edge("hem").unwrap().vertices.clone();
    hem[1..hem.len() - 1].iter().step_by(2).for_each(|&v| panel.positions[v as usize].y += burr);
    (panel, burr)
}

#[test]
fn burrs_of_the_outline_are_evened_out() {
    for (name, smoother) in [SMOOTHERS[0], SMOOTHERS[2]] {
        let (panel, burr) = burred();
        let smoothed = smoother(&panel).unwrap();
        let hem = &panel.edge("hem").unwrap().vertices;
        let height = |k: usize| smoothed.positions[hem[k] as usize].y;
        // Away from the pinned ends neighbours are level again.
        let worst = (3..hem.len() - 4).map(|k| (height(k + 1) - height(k)).abs()).fold(0.0, f64::max);
        assert!(worst < burr / 4.0, "{name} leaves {worst} m of {burr} m");
    }
}

#[test]
fn a_round_outline_does_not_shrink_under_plane_distances() {
    let panel = gridded(&disc());
    let smoothed = plane(&panel).unwrap();
    assert!((smoothed.area() / panel.area() - 1.0).abs() < 1e-9);
}

#[test]
fn inner_vertices_of_a_flat_panel_lie_in_their_mean_planes_already() {
    let panel = gridded(&vest());
    let smoothed = plane(&panel).unwrap();
    let inner = (0..panel.positions.len()).filter(|v| !panel.boundary.contains(&(*v as u32)));
    assert!(inner.into_iter().all(|v| smoothed.positions[v] == panel.positions[v]));
}

#[test]
fn laplacian_leaves_the_outline_and_betters_a_shaken_inside() {
    let good = gridded(&vest());
    let mut shaken = good.clone();
    let first_inner = good.boundary.len();
    for (k, p) in shaken.positions.iter_mut().enumerate().skip(first_inner) {
        let angle = k as f64 * 2.4;
        *p += Vector2::new(angle.cos(), angle.sin()) * 0.002;
    }
    let smoothed = laplacian(&shaken).unwrap();
    assert!(good.boundary.iter().all(|&v| smoothed.positions[v as usize] == good.positions[v as usize]));
    let mean = |p: &Panel| {
        p.triangles.iter().map(|t| p.triangle_least_angle(*t)).sum::<f64>() / p.triangles.len() as f64
    };
    assert!(mean(&smoothed) > mean(&shaken) + 2.0, "{} to {}", mean(&shaken), mean(&smoothed));
}

#[test]
fn photo_coordinates_move_with_their_vertices() {
    let frame =
        PhotoFrame { origin_px: Point2::new(800.0, 1500.0), px_per_metre: 2000.0, mirrored: true, turn: 0.0 };
    let panel = gridded(&Outline { frame: Some(frame), ..vest() });
    let smoothed = laplacian(&panel).unwrap();
    assert_ne!(panel.positions, smoothed.positions);
    for (p, px) in smoothed.positions.iter().zip(&smoothed.photo_px) {
        assert!((frame.to_px(*p) - px).norm() < 1e-6);
    }
}

#[test]
fn bad_input_is_refused_in_words() {
    let panel = gridded(&vest());
    let said = |panel: &Panel| plane(panel).expect_err("refused").message;
    let mut broken = panel.clone();
    broken.positions[7].x = f64::NAN;
    assert_eq!(said(&broken), "the panel has a vertex that is not a finite number");
    let beyond = Panel { boundary: vec![99_999], ..panel.clone() };
    let n = panel.positions.len();
    assert_eq!(said(&beyond), format!("the panel names a vertex beyond its {n}"));
    assert_eq!(said(&Panel { triangles: vec![], ..panel.clone() }), "the panel has no triangles");
    let error =
        Taubin { lambda: 0.5, mu: -0.4, iterations: 1 }.run(&panel, &Context::quiet()).expect_err("refused");
    assert_eq!(error.message, "mu is -0.4, but must be below -lambda = -0.5");
    assert_eq!(error.param, Some("mu"));
}

/// A sphere of unit radius from a subdivided octahedron, its vertices moved in and out by `noise`.
fn sphere(noise: f64) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let n = 24;
    let ring = |j: usize| std::f64::consts::PI * j as f64 / n as f64;
    let mut points = vec![Point3::new(0.0, 0.0, 1.0)];
    for j in 1..n {
        for i in 0..2 * n {
            let a = std::f64::consts::PI * (i as f64 + 0.5 * (j % 2) as f64) / n as f64;
            points.push(Point3::new(ring(j).sin() * a.cos(), ring(j).sin() * a.sin(), ring(j).cos()));
        }
    }
    points.push(Point3::new(0.0, 0.0, -1.0));
    let at = |j: usize, i: usize| (1 + (j - 1) * 2 * n + i % (2 * n)) as u32;
    let last = points.len() as u32 - 1;
    let mut triangles = Vec::new();
    for i in 0..2 * n {
        triangles.push([0, at(1, i), at(1, i + 1)]);
        triangles.push([last, at(n - 1, i + 1), at(n - 1, i)]);
        for j in 1..n - 1 {
            triangles.push([at(j, i), at(j + 1, i), at(j, i + 1)]);
            triangles.push([at(j, i + 1), at(j + 1, i), at(j + 1, i + 1)]);
        }
    }
    for (k, p) in points.iter_mut().enumerate() {
        p.coords *= 1.0 + noise * (k as f64 * 12.9898).sin();
    }
    (points, triangles)
}

#[test]
fn a_bumpy_sphere_gets_smooth_and_keeps_its_size() {
    let (points, triangles) = sphere(0.01);
    let how = PlaneSmoothing { lambda: 0.5, rounds: 10, hold_border: true };
    let smoothed = smooth_to_planes(&points, &triangles, how);
    let radii = |points: &[Point3]| {
        // The poles' rings are crowded: they are left out of the measure.
        let r: Vec<f64> = points.iter().filter(|p| p.z.abs() < 0.9).map(|p| p.coords.norm()).collect();
        let mean = r.iter().sum::<f64>() / r.len() as f64;
        (mean, (r.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / r.len() as f64).sqrt())
    };
    let ((before, rough), (after, smooth)) = (radii(&points), radii(&smoothed));
    assert!((after / before - 1.0).abs() < 1e-3, "the radius went from {before} to {after}");
    assert!(smooth < rough / 3.0, "roughness went from {rough} to {smooth}");
}

#[test]
fn a_border_in_space_is_held_or_evened_out() {
    let panel = gridded(&disc());
    let mut points: Vec<Point3> = panel.positions.iter().map(|p| Point3::new(p.x, p.y, 0.3)).collect();
    let burr = 1e-4;
    for &v in panel.boundary.iter().step_by(2) {
        let outward = Vector3::new(points[v as usize].x, points[v as usize].y, 0.0).normalize();
        points[v as usize] += outward * burr;
    }
    let roughness = |points: &[Point3]| {
        let r = |k: usize| points[panel.boundary[k % panel.boundary.len()] as usize].xy().coords.norm();
        (0..panel.boundary.len()).map(|k| (r(k + 1) - r(k)).abs()).fold(0.0, f64::max)
    };
    let run = |hold_border| {
        smooth_to_planes(&points, &panel.triangles, PlaneSmoothing { lambda: 0.3, rounds: 30, hold_border })
    };
    assert!(panel.boundary.iter().all(|&v| run(true)[v as usize] == points[v as usize]));
    assert!(roughness(&run(false)) < roughness(&points) / 4.0, "{}", roughness(&run(false)));
    assert!(run(false).iter().all(|p| (p.z - 0.3).abs() < 1e-9), "a flat surface stays flat");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_shaken_panel_is_broken(seed in 0.0..100.0f64, size in 0.0..0.004f64) {
        let mut panel = gridded(&vest());
        let first_inner = panel.boundary.len();
        for (k, p) in panel.positions.iter_mut().enumerate().skip(first_inner) {
            let angle = (k as f64 + seed) * 78.233;
            *p += Vector2::new(angle.cos(), angle.sin()) * size;
        }
        prop_assume!(panel.triangles.iter().all(|t| panel.triangle_area(*t) > 0.0));
        for (_, smoother) in SMOOTHERS {
            check_kept(&panel, &smoother(&panel).unwrap());
        }
    }
}

//! The engine against closed forms and conservation laws.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::fixtures::{Capsules, Grid, garment, hanging, plain};
use super::*;
use nalgebra::Vector3 as V;
use std::sync::Arc;
use toile_core::prelude::*;

const G: f64 = 9.81;

fn settings(gravity: f64, damping: f64) -> Settings {
    Settings {
        gravity: V::new(0.0, -gravity, 0.0),
        damping,
        softening: Softening { steepest: f64::INFINITY },
        max_strain: None,
        friction: 1.0,
        self_thickness: 1.0,
        pull: None,
    }
}

fn simulation<'a>(g: &Garment, settings: Settings, collider: Option<&'a dyn Collide>) -> Simulation<'a> {
    Simulation::new(g, collider, Box::<CentralDifferences>::default(), settings)
}

fn run(s: &mut Simulation, seconds: f64) {
    let end = s.time + seconds;
    while s.time < end {
        s.step().unwrap();
    }
}

fn momentum(s: &Simulation) -> V<f64> {
    s.state.v.iter().zip(&s.cloth.inertia).fold(V::zeros(), |p, (v, m)| p + v * *m)
}

/// Pushes every node a little, differently, always the same.
fn shake(s: &mut Simulation, metres: f64) {
    for (i, x) in s.state.x.iter_mut().enumerate() {
        let wave = |k: f64| metres * (k * (i as f64 + 1.0)).sin();
        *x += V::new(wave(1.3), wave(2.1), wave(3.7));
    }
}

#[test]
fn cloth_falls_freely_as_galileo_says() {
    let (g, _) = hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5));
    let mut s = simulation(&g, settings(G, 0.0), None);
    let start: f64 = s.state.x.iter().map(|x| x.y).sum::<f64>() / s.cloth.len() as f64;
    run(&mut s, 0.3);
    let now: f64 = s.state.x.iter().map(|x| x.y).sum::<f64>() / s.cloth.len() as f64;
    assert!((now - start + G * s.time * s.time / 2.0).abs() < 1e-9);
}

#[test]
fn a_flat_cloth_without_gravity_stays_where_it_is() {
    let (g, _) = hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5));
    let mut s = simulation(&g, settings(0.0, 0.0), None);
    run(&mut s, 0.2);
    let moved = s.state.x.iter().zip(&g.positions).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved < 1e-12, "{moved}");
}

#[test]
fn springs_keep_momentum() {
    let (g, _) = hanging(0.1, 0.1, 0.01, &plain(800.0, 50.0, 1e-5));
    let mut s = simulation(&g, settings(0.0, 0.0), None);
    shake(&mut s, 1e-4);
    for _ in 0..500 {
        s.step().unwrap();
    }
    let scale: f64 = s.state.v.iter().zip(&s.cloth.inertia).map(|(v, m)| m * v.norm()).sum();
    assert!(scale > 0.0 && momentum(&s).norm() < 1e-11 * scale, "{} of {scale}", momentum(&s).norm());
}

#[test]
fn energy_is_kept_without_damping_and_falls_with_it() {
    let (g, _) = hanging(0.1, 0.1, 0.01, &plain(800.0, 50.0, 1e-5));
    let after = |damping: f64| {
        let mut s = simulation(&g, settings(0.0, damping), None);
        shake(&mut s, 1e-5);
        let before = s.energy();
        run(&mut s, 0.1);
        (s.energy() + s.kinetic_energy()) / before
    };
    assert!((after(0.0) - 1.0).abs() < 0.1, "{}", after(0.0));
    assert!(after(30.0) < 0.1, "{}", after(30.0));
}

#[test]
fn a_strip_hangs_as_long_as_the_closed_form_says() {
    // alpha = rho g L / k; the tip of a linear strip comes down by alpha L / 2.
    for k in [1177.2, 117.72, 11.772] {
        let (g, top) = hanging(0.1, 1.0, 0.05, &plain(k, 1e-3, 0.0));
        let mut s = simulation(&g, settings(G, 0.0), None);
        top.iter().for_each(|&i| s.cloth.hold(i));
        let (alpha, slowest) = (0.12 * G / k, (k / 0.12f64).sqrt() * 1.6);
        s.settings.damping = slowest;
        run(&mut s, 30.0 / slowest);
        let tip = -s.state.x.iter().map(|x| x.y).fold(0.0, f64::min) - 1.0;
        assert!((tip / (alpha / 2.0) - 1.0).abs() < 0.01, "alpha {alpha}: {tip}");
    }
}

#[test]
fn stretch_does_not_depend_on_the_mesh() {
    // A bias strip: E(45) = 4 / (1/E1 + 1/E2 + 1/G) with no Poisson coupling, off any mesh line.
    let stiffness = |columns: usize, rows: usize| {
        let turned = |u: f64, v: f64| {
            let (x, y) = (0.1 * u, 0.4 * v);
            Point2::new((x - y) * 0.5f64.sqrt(), (x + y) * 0.5f64.sqrt())
        };
        let back = |p: Point2| Point3::new((p.x + p.y) * 0.5f64.sqrt(), (p.y - p.x) * 0.5f64.sqrt(), 0.0);
        let grid = Grid { columns, rows, flat: turned, lift: back };
        let g = garment(&[("bias", &grid)], &plain(1000.0, 30.0, 0.0));
        let mut s = simulation(&g, settings(0.0, 150.0), None);
        let strain = 1e-3;
        for c in 0..=columns {
            s.cloth.hold(grid.at(c, 0) as usize);
            let top = grid.at(c, rows) as usize;
            s.state.x[top].y += 0.4 * strain;
            s.cloth.hold(top);
        }
        run(&mut s, 0.3);
        let mut forces = vec![V::zeros(); s.cloth.len()];
        s.cloth.add_forces(&s.state.x, &mut forces);
        -(0..=columns).map(|c| forces[grid.at(c, rows) as usize].y).sum::<f64>() / (0.1 * strain)
    };
    let free = 4.0 / (1.0 / 1000.0 + 1.0 / 1000.0 + 1.0 / 30.0);
    let (coarse, fine, skew) = (stiffness(4, 16), stiffness(8, 32), stiffness(8, 16));
    // Clamped ends stiffen a strip four times as long as wide by some per cent.
    for k in [coarse, fine, skew] {
        assert!(k > 0.97 * free && k < 1.25 * free, "{k} against {free}");
        assert!((k / fine - 1.0).abs() < 0.07, "{k} against {fine}");
    }
}

#[test]
fn a_bent_sheet_of_equilateral_triangles_has_the_bending_stiffness() {
    let edge = 0.01;
    let (columns, rows) = (20, 24);
    let mut g = hanging(0.2, 0.24, edge, &plain(500.0, 50.0, 2e-5)).0;
    // Rows shifted by half an edge, one diagonal: equilateral triangles.
    g.triangles.clear();
    for r in 0..rows {
        for c in 0..columns {
            let at = |c: usize, r: usize| (r * (columns + 1) + c) as u32;
            let (a, b, d, e) = (at(c, r), at(c + 1, r), at(c, r + 1), at(c + 1, r + 1));
            g.triangles.extend(if r % 2 == 1 { [[a, b, d], [b, e, d]] } else { [[a, b, e], [a, e, d]] });
        }
    }
    let radius = 0.2;
    for i in 0..g.rest.len() {
        let (c, r) = (i % (columns + 1), i / (columns + 1));
        let shift = if r % 2 == 0 { 0.5 } else { 0.0 };
        let p = Point2::new((c as f64 + shift) * edge, r as f64 * edge * 0.75f64.sqrt());
        g.rest[i] = p;
        let angle = p.x / radius;
        g.positions[i] = Point3::new(radius * angle.sin(), p.y, radius * angle.cos());
    }
    let cloth = Cloth::new(&g, Softening { steepest: f64::INFINITY });
    let area: f64 = cloth.membranes.iter().map(|m| m.area).sum();
    let bent: f64 = cloth.hinges.iter().map(|h| h.energy(&g.positions)).sum();
    let sheet = area * 2e-5 / (2.0 * radius * radius);
    // The boundary's hinges are missing: about one edge's width of 20 by 24.
    assert!((bent / sheet - 1.0).abs() < 0.08, "{}", bent / sheet);
}

#[test]
fn halving_the_time_step_quarters_the_error() {
    let (g, top) = hanging(0.05, 0.1, 0.025, &plain(50.0, 20.0, 0.0));
    let tip = |share: f64| {
        let mut s = simulation(&g, settings(G, 0.0), None);
        top.iter().for_each(|&i| s.cloth.hold(i));
        let steps = (0.02 / (s.dt() * 0.5) * share).round() as usize;
        s.set_dt(0.02 / steps as f64);
        (0..steps).for_each(|_| s.step().unwrap());
        s.state.x[0].y
    };
    let (coarse, middle, fine, exact) = (tip(1.0), tip(2.0), tip(4.0), tip(32.0));
    let order = |a: f64, b: f64| ((a - exact) / (b - exact)).abs().log2();
    assert!(order(coarse, middle) > 1.6 && order(middle, fine) > 1.6, "{coarse} {middle} {fine} {exact}");
}

#[test]
fn a_pendulum_keeps_time() {
    // Half of the mass hangs at the lower edge, the other half is held: a simple pendulum.
    let grid = Grid {
        columns: 1,
        rows: 1,
        flat: |u, v| Point2::new(0.02 * u, 0.1 * (v - 1.0)),
        lift: |p| Point3::new(p.x, p.y * 0.05f64.cos(), p.y * 0.05f64.sin()),
    };
    let g = garment(&[("bob", &grid)], &plain(3000.0, 300.0, 0.0));
    let mut s = simulation(&g, settings(G, 0.0), None);
    s.cloth.hold(2);
    s.cloth.hold(3);
    let mut crossings = Vec::new();
    while crossings.len() < 5 {
        let before = s.state.x[0].z;
        s.step().unwrap();
        if before * s.state.x[0].z < 0.0 {
            crossings.push(s.time);
        }
    }
    let period = (crossings[4] - crossings[0]) / 2.0;
    // Amplitude 0.05 rad lengthens it by 0.016 %.
    let theory = std::f64::consts::TAU * (0.1f64 / G).sqrt() * (1.0 + 0.05f64.powi(2) / 16.0);
    assert!((period / theory - 1.0).abs() < 2e-3, "{period} against {theory}");
}

#[test]
fn joining_keeps_momentum() {
    let grid = |lift| Grid { columns: 4, rows: 4, flat: |u, v| Point2::new(0.1 * u, 0.1 * v), lift };
    let (left, right) = (grid(|p| Point3::new(p.x, p.y, 0.0)), grid(|p| Point3::new(p.x + 0.1005, p.y, 0.0)));
    let mut g = garment(&[("left", &left), ("right", &right)], &plain(500.0, 50.0, 1e-5));
    let pairs = (0..=4).map(|r| [left.at(4, r), right.at(0, r) + 25]).collect();
    g.seams.push(GarmentSeam {
        name: "middle".into(),
        kind: SeamKind::Matched,
        pairs,
        state: SeamState::Open,
    });
    let mut s = simulation(&g, settings(0.0, 0.0), None);
    s.state.v.iter_mut().enumerate().for_each(|(i, v)| *v = V::new(i as f64, 0.3, -(i as f64).sin()));
    let before = momentum(&s);
    assert_eq!(s.join(1e-3), 5);
    assert!(s.seams.all_closed());
    assert!((momentum(&s) - before).norm() < 1e-12 * before.norm(), "{before} {}", momentum(&s));
    let done = s.finish(true);
    for p in &done.seams[0].pairs {
        assert_eq!(done.positions[p[0] as usize], done.positions[p[1] as usize]);
    }
    assert_eq!(done.seams[0].state, SeamState::Closed);
}

#[test]
fn cloth_sticks_on_a_slope_that_friction_holds_and_slides_on_a_steeper_one() {
    // On a ball, at the angle where the slope's tangent is above or below the friction.
    let slid = |angle: f64| {
        let body = Capsules::new(&[([0.0; 3], [0.0; 3], 10.0)]);
        let height = 10.0 + body.card.thickness;
        let (mut g, _) = hanging(0.02, 0.02, 0.02, &plain(300.0, 100.0, 0.0));
        for p in &mut g.positions {
            let flat = V::new(p.x, 0.0, p.y);
            let (sin, cos) = angle.sin_cos();
            let along = V::new(cos, -sin, 0.0);
            *p = Point3::from(V::new(sin, cos, 0.0) * height + along * flat.x + V::z() * flat.z);
        }
        let mut s = simulation(&g, settings(G, 0.0), Some(&body));
        let start = s.state.x[0];
        run(&mut s, 0.1);
        (s.state.x[0] - start).norm()
    };
    assert!(slid(0.27) < 1e-4, "tan = 0.277 < 0.3: {}", slid(0.27));
    // a = g (sin - 0.3 cos) for 0.1 s
    let free = G * (0.4f64.sin() - 0.3 * 0.4f64.cos()) * 0.005;
    assert!((slid(0.4) / free - 1.0).abs() < 0.1, "{} against {free}", slid(0.4));
}

#[test]
fn over_stretched_edges_are_shortened_and_momentum_kept() {
    let (g, _) = hanging(0.1, 0.1, 0.02, &plain(500.0, 50.0, 1e-5));
    let mut s = simulation(&g, settings(0.0, 0.0), None);
    s.state.x.iter_mut().for_each(|x| x.y *= 1.2);
    let longest = |s: &Simulation| {
        let strain = |e: &super::Edge| {
            let [a, b] = e.nodes.map(|n| s.state.x[n as usize]);
            (a - b).norm() / e.length - 1.0
        };
        s.cloth.edges.iter().map(strain).fold(0.0, f64::max)
    };
    for _ in 0..60 {
        s.state.v.fill(V::zeros());
        limit_stretch(&s.cloth, &mut s.state, 0.05, 1e-3);
        assert!(momentum(&s).norm() < 1e-14);
        let moves: Vec<V<f64>> = s.state.v.iter().map(|v| v * 1e-3).collect();
        s.state.x.iter_mut().zip(moves).for_each(|(x, d)| *x += d);
    }
    assert!(longest(&s) < 0.055, "{}", longest(&s));
}

fn refused(change: impl Fn(&mut Garment)) -> StageError {
    let (mut g, _) = hanging(0.1, 0.1, 0.05, &plain(500.0, 50.0, 1e-5));
    change(&mut g);
    check_garment(&g).unwrap_err()
}

#[test]
fn an_empty_garment_is_refused() {
    let e = refused(|g| g.triangles.clear());
    assert_eq!(
        (e.code, e.message.as_str()),
        (ErrorCode::InvalidInput, "the garment is empty: it has no triangles")
    );
    assert_eq!(e.hint.as_deref(), Some("see what the mesher and the placement made of the panels"));
}

#[test]
fn a_coordinate_that_is_no_number_is_refused() {
    let e = refused(|g| g.positions[3].y = f64::NAN);
    assert_eq!(e.message, "vertex 3 has a coordinate that is not a finite number");
}

#[test]
fn a_triangle_without_area_is_refused() {
    let e = refused(|g| g.rest[4] = Point2::new(0.025, -0.1));
    assert_eq!((e.code, e.message.as_str()), (ErrorCode::DegenerateTriangles, "triangle 0 has no area"));
}

#[test]
fn an_edge_without_length_is_refused() {
    let e = refused(|g| g.rest[1] = g.rest[0]);
    assert_eq!(e.message, "the edge between vertices 0 and 1 has no length");
    assert_eq!(e.hint.as_deref(), Some("mesh the panel again"));
}

#[test]
fn cloth_without_mass_is_refused() {
    for density in [0.0, -1.0, f64::NAN] {
        let e = refused(|g| Arc::make_mut(&mut g.panels[0].fabric).area_density = density);
        assert_eq!(e.message, format!("panel \"strip\" has a mass of {density} kg/m2, it must be above 0"));
    }
}

#[test]
fn a_curve_that_falls_is_refused() {
    let e = refused(|g| Arc::make_mut(&mut g.panels[0].fabric).weft = Curve(vec![(0.1, 5.0), (0.2, 4.0)]));
    assert_eq!(e.message, "the weft curve of \"plain\" does not rise from the origin");
}

#[test]
fn a_vertex_that_does_not_exist_is_refused() {
    let e = refused(|g| g.triangles[0][1] = 99);
    assert_eq!(e.message, "the garment names a vertex beyond its 9 vertices");
}

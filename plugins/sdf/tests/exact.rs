//! The field against exact closest points, and cloth against the built-in collider.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use proptest::prelude::*;
use std::sync::Arc;
use std::time::Instant;
use toile_core::artifact::{Body, Collide, Collider, Point3, SelfContact, Vector3};
use toile_core::testkit::dress;
use toile_core::{Context, Inputs, PortValue, Stage};
use toile_sdf::{DistanceField, SdfCollider};

/// The only output of a stage.
fn made<T: Clone + 'static>(stage: &dyn Stage, inputs: Vec<Option<PortValue>>) -> T {
    let out = stage.run_ports(&Inputs(inputs), &Context::quiet()).unwrap();
    let any: &dyn std::any::Any = out[0].entries()[0].1.as_ref();
    any.downcast_ref::<T>().unwrap().clone()
}

fn builtin(name: &str, arguments: &str, inputs: Vec<Option<PortValue>>) -> Box<dyn std::any::Any> {
    let registry = toile::registry();
    let stage = registry.make(registry.card(name).unwrap(), arguments).unwrap();
    match name {
        "Mannequin" => Box::new(made::<Body>(stage.as_ref(), inputs)),
        _ => Box::new(made::<Collider>(stage.as_ref(), inputs)),
    }
}

fn mannequin() -> Body {
    *builtin("Mannequin", "()", vec![]).downcast().unwrap()
}

fn bvh(body: Option<&Body>) -> Collider {
    let body = body.map(|b| PortValue::One(Arc::new(b.clone())));
    *builtin("BvhCollider", "()", vec![body]).downcast().unwrap()
}

fn sdf(body: Option<&Body>) -> Collider {
    made(&SdfCollider::default(), vec![body.map(|b| PortValue::One(Arc::new(b.clone())))])
}

/// Numbers from 0 to 1 that look random and are the same at every run.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn exact(body: &Body) -> impl Fn(&Point3) -> f64 {
    let points = body.positions.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let mesh = TriMesh::with_flags(points, body.triangles.clone(), TriMeshFlags::ORIENTED).unwrap();
    move |p| {
        let p = Vector::new(p.x, p.y, p.z);
        let on = mesh.project_local_point(p, false);
        let d = (on.point - p).length();
        if on.is_inside { -d } else { d }
    }
}

/// Errors of the field at random places around the body, in bands of distance: (band, median, 99 %,
/// greatest), metres.
fn errors(body: &Body, cell: f64, bands: &[f64]) -> Vec<(f64, f64, f64, f64)> {
    let (field, truth) = (DistanceField::of(body, cell, &Context::quiet()).unwrap(), exact(body));
    let mut next = numbers(3);
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); bands.len()];
    for _ in 0..20_000 {
        let v = body.positions[(next() * body.positions.len() as f64) as usize];
        let off = Vector3::new(next() - 0.5, next() - 0.5, next() - 0.5) * (0.2 * next());
        let (p, d) = (v + off, truth(&(v + off)));
        if let Some(k) = bands.iter().position(|b| d.abs() <= *b) {
            found[k].push((field.at(&p).unwrap().distance - d).abs());
        }
    }
    found.iter_mut().for_each(|e| e.sort_by(f64::total_cmp));
    let at = |e: &[f64], q: f64| e[((e.len() - 1) as f64 * q) as usize];
    bands.iter().zip(&found).map(|(b, e)| (*b, at(e, 0.5), at(e, 0.99), at(e, 1.0))).collect()
}

#[test]
fn near_the_skin_the_field_is_exact() {
    let body = mannequin();
    let start = Instant::now();
    let field = DistanceField::of(&body, 0.008, &Context::quiet()).unwrap();
    println!(
        "{} triangles, {} nodes, made in {:.2} s",
        body.triangles.len(),
        field.nodes(),
        start.elapsed().as_secs_f64()
    );
    let found = errors(&body, 0.008, &[0.003, 0.01, 0.05]);
    for (band, median, high, worst) in &found {
        println!(
            "within {:.0} mm: median {:.2e}, 99 % {:.2e}, greatest {:.2e} m",
            band * 1e3,
            median,
            high,
            worst
        );
    }
    // Fingers are two cells thick: the nearest of two of them may be mistaken.
    assert!(found[0].2 < 1e-6 && found[0].3 < 2e-3, "{found:?}");
    assert!(found[1].2 < 1e-6 && found[1].3 < 2e-3, "{found:?}");
    assert!(found[2].2 < 2e-3, "{found:?}");
}

#[test]
fn contacts_lead_back_to_the_skin() {
    let body = dress::body();
    let (collider, truth) = (sdf(Some(&body)), exact(&body));
    let mut next = numbers(8);
    let at: Vec<Point3> =
        (0..2000).map(|_| Point3::new(0.5 * next() - 0.25, 1.8 * next(), 0.4 * next() - 0.2)).collect();
    let mut contacts = Vec::new();
    collider.scheme.body_contacts(&at, 0.005, &mut contacts);
    assert!(contacts.len() > 200 && contacts.is_sorted_by_key(|c| c.vertex));
    for c in contacts {
        let p = at[c.vertex as usize];
        assert!((c.point + c.normal * c.distance - p).norm() < 1e-9);
        assert!((c.normal.norm() - 1.0).abs() < 1e-9 && c.distance <= 0.005);
        if c.distance.abs() < 0.01 {
            assert!((c.distance - truth(&p)).abs() < 1e-4, "{p}: {} and {}", c.distance, truth(&p));
        }
    }
    let missed = at.iter().filter(|p| truth(p) < 0.004).count();
    let mut all = Vec::new();
    collider.scheme.body_contacts(&at, 0.005, &mut all);
    assert!(all.len() >= missed);
}

#[test]
fn paths_enter_where_they_enter() {
    let body = dress::body();
    let (fine, reference) = (sdf(Some(&body)), bvh(Some(&body)));
    let mut next = numbers(4);
    let ring = |next: &mut dyn FnMut() -> f64, r: f64| {
        let a = std::f64::consts::TAU * next();
        Point3::new(r * a.sin(), 0.2 + 1.2 * next(), r * a.cos())
    };
    let from: Vec<Point3> = (0..400).map(|_| ring(&mut next, 0.35)).collect();
    let to: Vec<Point3> = (0..400).map(|_| ring(&mut next, 0.02)).collect();
    let (mut a, mut b) = (Vec::new(), Vec::new());
    fine.scheme.body_hits(&from, &to, &mut a);
    reference.scheme.body_hits(&from, &to, &mut b);
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.vertex, b.vertex);
        assert!((a.point - b.point).norm() < 2e-4, "{} and {}", a.point, b.point);
    }
}

#[test]
fn what_is_no_number_is_in_no_answer() {
    let collider = sdf(Some(&dress::body()));
    let nan = Point3::new(f64::NAN, 1.0, 0.0);
    let (mut contacts, mut hits) = (Vec::new(), Vec::new());
    collider.scheme.body_contacts(&[nan], 1.0, &mut contacts);
    collider.scheme.body_hits(&[nan, Point3::new(0.0, 1.0, 2.0)], &[Point3::origin(), nan], &mut hits);
    assert!(contacts.is_empty() && hits.is_empty());
}

#[test]
fn a_grid_too_fine_is_refused() {
    let stage = SdfCollider { cell: toile_core::Length::mm(0.5), ..SdfCollider::default() };
    let body: PortValue = PortValue::One(Arc::new(dress::body()));
    let error = stage.run_ports(&Inputs(vec![Some(body)]), &Context::quiet()).unwrap_err();
    assert_eq!(
        error.message,
        "cells of 0.5 mm would make a grid of 2099 million nodes, the limit is 40 million"
    );
    assert_eq!((error.hint.as_deref(), error.param), (Some("use cells of at least 1.9 mm"), Some("cell")));
}

#[test]
fn an_open_body_is_refused() {
    let mut body = dress::body();
    body.triangles.pop();
    let error = DistanceField::of(&body, 0.01, &Context::quiet()).unwrap_err();
    assert_eq!(error.message, "the body is not closed: 3 edges lack a second triangle that fits");
    body.triangles.clear();
    assert_eq!(
        DistanceField::of(&body, 0.01, &Context::quiet()).unwrap_err().message,
        "the body has no triangles"
    );
}

/// Triangles of a size in a unit cube; every third shares a vertex with the one before.
fn soup(seed: u64, count: u32, size: f64) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let mut next = numbers(seed);
    let mut point = move |scale: f64| Point3::new(next() * scale, next() * scale, next() * scale);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let center = point(1.0);
        positions.extend((0..3).map(|_| center + point(size).coords));
        triangles.push([if i % 3 == 2 { 3 * i - 1 } else { 3 * i }, 3 * i + 1, 3 * i + 2]);
    }
    (positions, triangles)
}

fn own(scheme: &dyn Collide, cloth: &(Vec<Point3>, Vec<[u32; 3]>), reach: f64) -> Vec<SelfContact> {
    let mut out = Vec::new();
    scheme.self_contacts(&cloth.0, &cloth.1, reach, &mut out);
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn cloth_meets_itself_as_in_the_built_in_collider(
        seed in 0u64..1 << 32, count in 1u32..120, size in 0.02..0.5, reach in 0.0..0.2,
    ) {
        let (ours, theirs) = (sdf(None), bvh(None));
        let cloth = soup(seed, count, size);
        let (a, b) = (own(ours.scheme.as_ref(), &cloth, reach), own(theirs.scheme.as_ref(), &cloth, reach));
        let nodes = |all: &[SelfContact]| all.iter().map(|c| c.vertices).collect::<Vec<_>>();
        prop_assert_eq!(nodes(&a), nodes(&b));
        prop_assert!(a.iter().zip(&b).all(|(a, b)| (a.distance - b.distance).abs() < 1e-12));
        let (positions, triangles) = &cloth;
        let bounds = |c: &Collider| c.scheme.conservative_bounds(positions, triangles, reach);
        prop_assert!(bounds(&ours).iter().zip(bounds(&theirs)).all(|(a, b)| (a - b).abs() < 1e-12));
        let crossings = |c: &Collider| c.scheme.self_crossings(positions, triangles);
        prop_assert_eq!(crossings(&ours), crossings(&theirs));
    }
}

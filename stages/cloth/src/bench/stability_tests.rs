#![allow(clippy::unwrap_used)]
use nalgebra::Vector2;

use super::layout::{Layout, Rectangle};
use super::reference;
use super::stability::{Case, Verdict};
use crate::bending::{Hinge, Rigidity};
use crate::error::ClothError;
use crate::fabric::Fabric;
use crate::force::Vec3;
use crate::membrane::{Triangles, Woven};
use crate::mesh::Sheet;
use crate::solver::{CentralDifferences, ImplicitEuler, Model, Solver, State, Static};

fn all_sound(cases: impl Iterator<Item = (String, Case)>, cells: usize) {
    let faults: Vec<String> = cases
        .filter_map(|(name, case)| match case.verdict(cells) {
            Verdict::Failed(fault) => Some(format!("{name}: {fault}")),
            _ => None,
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_extreme_alone_converges() {
    all_sound(Case::singles(), 10);
}

#[test]
fn all_pairs_of_extremes_converge() {
    all_sound(Case::pairs(), 5);
}

#[test]
#[ignore = "long: all pairs on the 20 x 20 square"]
fn all_pairs_of_extremes_converge_on_the_large_square() {
    all_sound(Case::pairs(), 20);
}

/// Tip displacement over length of a strip of 0.2 m under its own weight.
fn hang(k: f64, edge: f64, gravity: f64) -> Result<(f64, Sheet, State), ClothError> {
    let mesh = Rectangle::new(Layout::Alternating, 4.0 * edge, 0.2, (0.2 / edge).round() as usize);
    let sheet = mesh.sheet(0.15)?;
    let mut model = Model::of(&sheet)
        .with(Triangles::new(&sheet, Woven::new(&Fabric::isotropic(0.15, k, 0.0, 0.0))?))
        .with(Hinge::new(&sheet, &Rigidity::uniform(1e-9))?)
        .pinned(|v| mesh.at_top(v));
    model.gravity *= gravity;
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    let weight = 0.15 * 9.81 * gravity * 0.2 * 4.0 * edge;
    Static::to(1e-6 * weight).advance(&model, &mut state)?;
    let tip = -state.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    Ok((tip / 0.2, sheet, state))
}

#[test]
fn hanging_strip_over_nine_decades_of_stiffness() {
    for k in [1.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        let (tip, ..) = hang(k, 0.02, 1.0).unwrap();
        let exact = 0.5 * 0.15 * 9.81 * 0.2 / k;
        assert!((tip / exact - 1.0).abs() < 0.01, "k {k}: {tip} against {exact}");
    }
}

#[test]
fn a_strip_that_cannot_hold_is_named() {
    for (k, gravity) in [(1e-2, 1.0), (1.0, 100.0)] {
        let (_, sheet, state) = hang(k, 0.02, gravity).unwrap();
        let error = sheet.check_strain(&state.x, 1.0).unwrap_err();
        assert!(matches!(error, ClothError::StrainLimitExceeded { strain, .. } if strain > 1.0), "{error}");
    }
    let (_, sheet, state) = hang(500.0, 0.02, 100.0).unwrap();
    sheet.check_strain(&state.x, 0.1).unwrap();
}

#[test]
fn error_does_not_grow_when_refined() {
    let exact = 0.5 * 0.15 * 9.81 * 0.2 / 100.0;
    let error = |edge: f64| (hang(100.0, edge, 1.0).unwrap().0 / exact - 1.0).abs();
    let errors = [0.1, 0.05, 0.02, 0.01, 0.005, 0.002].map(error);
    assert!(errors.windows(2).all(|w| w[1] <= w[0] + 1e-4), "{errors:?}");
}

#[test]
fn cantilever_over_nine_decades_of_bending() {
    let mesh = Rectangle::new(Layout::Equilateral, 0.02, 0.1, 20);
    let sheet = mesh.sheet(0.15).unwrap();
    for d in [0.0, 1e-9, 1e-6, 1e-5, 1e-3, 1.0] {
        let rigidity = Rigidity::uniform(d);
        let fabric = Fabric::isotropic(0.15, 2e3_f64.max(1e7 * d), 0.0, d);
        let held =
            |[a, b]: [u32; 2]| (mesh.at_bottom(a as usize) && mesh.at_bottom(b as usize)).then(|| -Vec3::x());
        let model = Model::of(&sheet)
            .with(Triangles::new(&sheet, Woven::new(&fabric).unwrap()))
            .with(Hinge::clamped(&sheet, &rigidity, held).unwrap())
            .pinned(|v| mesh.at_bottom(v));
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, 0.0, p.x)).collect());
        Static::to(1e-9).advance(&model, &mut state).unwrap();
        let drop = -state.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min) / 0.1;
        let exact = if d > 1e-8 { reference::cantilever(0.15 * 9.81 * 1e-3 / d).drop } else { 1.0 };
        assert!((drop - exact).abs() < 0.02, "D {d}: {drop} against {exact}");
    }
}

#[test]
fn long_thin_triangles_keep_their_shape_or_are_refused() {
    for aspect in [1.0, 10.0, 100.0, 1000.0] {
        let uv: Vec<Vector2<f64>> = Rectangle::new(Layout::Alternating, 0.1, 0.1, 6)
            .uv
            .iter()
            .map(|p| Vector2::new(p.x, p.y * aspect))
            .collect();
        let sheet =
            Sheet::flat(&uv, &Rectangle::new(Layout::Alternating, 0.1, 0.1, 6).triangles, 0.15).unwrap();
        let model = Model::of(&sheet)
            .with(Triangles::new(&sheet, Woven::new(&Fabric::isotropic(0.15, 500.0, 0.2, 0.0)).unwrap()))
            .with(Hinge::new(&sheet, &Rigidity::uniform(1e-5)).unwrap());
        let mut state = State::at_rest(uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
        let mut solver = ImplicitEuler::new(0.01, 1e-6);
        for _ in 0..20 {
            solver.advance(&model, &mut state).unwrap();
        }
        assert!(sheet.greatest_strain(&state.x).1.abs() < 1e-9, "aspect {aspect}");
    }
    let sliver = [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(0.5, 1e-7)];
    let error = Sheet::flat(&sliver, &[[0, 1, 2]], 0.1).unwrap_err();
    assert!(matches!(error, ClothError::DegenerateTriangle { index: 0, .. }), "{error}");
}

#[test]
fn a_light_vertex_beside_heavy_ones_costs_no_more() {
    let run = |ratio: f64| Case { mass_ratio: ratio, ..Case::default() }.run(10, 10).unwrap();
    let (even, light) = (run(1.0), run(1e4));
    assert!(light.converged && light.iterations <= 10 * even.iterations, "{even:?} {light:?}");
}

#[test]
fn weightless_cloth_stays_put_for_ten_thousand_steps() {
    let mesh = Rectangle::new(Layout::Irregular(4), 0.2, 0.2, 5);
    let sheet = mesh.sheet(0.15).unwrap();
    let model = Model::of(&sheet)
        .with(Triangles::new(&sheet, Woven::new(&Fabric::isotropic(0.15, 500.0, 0.2, 0.0)).unwrap()))
        .with(Hinge::new(&sheet, &Rigidity::uniform(1e-5)).unwrap())
        .under(Vec3::zeros());
    let start: Vec<Vec3> = mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
    let solvers: [Box<dyn Solver>; 2] =
        [Box::new(ImplicitEuler::new(0.01, 1e-9)), Box::new(CentralDifferences::adaptive(0.01))];
    for mut solver in solvers {
        let mut state = State::at_rest(start.clone());
        for _ in 0..10_000 {
            solver.advance(&model, &mut state).unwrap();
        }
        let moved = state.x.iter().zip(&start).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(moved < 1e-9, "{}: {moved:e}", solver.name());
    }
}

#[test]
fn bad_parameters_are_named_before_the_first_step() {
    let text = |case: Case| case.run(3, 1).unwrap_err().to_string();
    let usual = Case::default();
    assert_eq!(text(Case { density: 0.0, ..usual }), "density = 0 is out of range: above 0 kg/m^2");
    assert_eq!(text(Case { density: -1.0, ..usual }), "density = -1 is out of range: above 0 kg/m^2");
    assert_eq!(text(Case { stiffness: -5.0, ..usual }), "warp = -5 is out of range: a slope of 0 or more");
    assert_eq!(text(Case { stiffness: f64::NAN, ..usual }), "warp[0] is not a finite number");
    assert_eq!(text(Case { bending: -1.0, ..usual }), "bending_warp = -1 is out of range: 0 or more");
    assert_eq!(text(Case { dt: 0.0, ..usual }), "dt = 0 is out of range: above 0 s");
    assert_eq!(text(Case { dt: f64::INFINITY, ..usual }), "dt[0] is not a finite number");
    assert_eq!(text(Case { gravity: f64::NAN, ..usual }), "gravity[0] is not a finite number");
    assert_eq!(text(Case { edge: f64::INFINITY, ..usual }), "edge[0] is not a finite number");
    let sheet = Rectangle::new(Layout::OneDiagonal, 0.1, 0.1, 2).sheet(0.1).unwrap();
    let model = Model::of(&sheet);
    let mut state = State::at_rest(vec![Vec3::zeros(); 9]);
    state.x[4].y = f64::NAN;
    let error = ImplicitEuler::new(0.01, 1e-9).advance(&model, &mut state).unwrap_err();
    assert_eq!(error.to_string(), "positions[4] is not a finite number");
}

#[test]
fn millimetres_read_as_metres_are_suspected() {
    let sheet = |size: f64| Rectangle::new(Layout::OneDiagonal, size, size, 20).sheet(0.1).unwrap();
    assert_eq!(sheet(0.6).suspicious_size(), None);
    assert!(sheet(600.0).suspicious_size().is_some_and(|edge| edge > 30.0));
}

/// Ten times the lengths at the same Gamma and alpha give the same shape.
#[test]
fn shapes_scale() {
    let shape = |scale: f64| {
        let mesh = Rectangle::new(Layout::Equilateral, 0.1 * scale, 0.3 * scale, 12);
        let density = 0.2;
        let sheet = mesh.sheet(density).unwrap();
        let fabric = Fabric::isotropic(density, 300.0 * scale, 0.1, 2e-4 * scale.powi(3));
        let model = Model::of(&sheet)
            .with(Triangles::new(&sheet, Woven::new(&fabric).unwrap()))
            .with(Hinge::new(&sheet, &Rigidity::of(&fabric)).unwrap())
            .pinned(|v| mesh.at_bottom(v));
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, 0.02 * p.y, p.x)).collect());
        Static::to(1e-9 * scale.powi(2)).advance(&model, &mut state).unwrap();
        state.x.into_iter().map(|x| x / scale).collect::<Vec<Vec3>>()
    };
    let (small, large) = (shape(1.0), shape(10.0));
    let apart = small.iter().zip(&large).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-6, "{apart:e}");
}

/// A moved and turned scene gives the moved and turned result.
#[test]
fn rigid_motion_of_the_scene_moves_the_result() {
    let turn = nalgebra::Rotation3::new(Vec3::new(0.4, -1.1, 2.0));
    let shift = Vec3::new(3.0, -2.0, 0.5);
    let result = |moved: bool| {
        let place = |p: Vec3| if moved { turn * p + shift } else { p };
        let mesh = Rectangle::new(Layout::Irregular(6), 0.2, 0.3, 8);
        let sheet = mesh.sheet(0.2).unwrap();
        let fabric = Fabric::isotropic(0.2, 100.0, 0.1, 1e-4);
        let gravity = Vec3::new(0.0, -9.81, 0.0);
        let model = Model::of(&sheet)
            .with(Triangles::new(&sheet, Woven::new(&fabric).unwrap()))
            .with(Hinge::new(&sheet, &Rigidity::of(&fabric)).unwrap())
            .pinned(|v| mesh.at_bottom(v))
            .under(if moved { turn * gravity } else { gravity });
        let mut state = State::at_rest(mesh.uv.iter().map(|p| place(Vec3::new(p.y, 0.0, p.x))).collect());
        let mut solver = ImplicitEuler::new(0.01, 1e-11);
        for _ in 0..10 {
            solver.advance(&model, &mut state).unwrap();
        }
        state.x
    };
    let (still, moved) = (result(false), result(true));
    let apart = still.iter().zip(&moved).map(|(a, b)| (turn * a + shift - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-8, "{apart:e}");
}

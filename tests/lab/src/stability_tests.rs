#![allow(clippy::unwrap_used)]
use std::ops::ControlFlow;

use super::stability::{Case, Options, Verdict, axes, stability};
use toile_cloth::solver::layout::{Layout, Rectangle};

use toile_cloth::energy::{Cloth, Models, Vec3};
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::{ImplicitEuler, Model, Solver, State, Static};

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
fn all_pairs_of_extremes_converge() {
    all_sound(Case::pairs(), 5);
}

#[test]
#[ignore = "long: all pairs on the 20 x 20 square"]
fn all_pairs_of_extremes_converge_on_the_large_square() {
    all_sound(Case::pairs(), 20);
}

#[test]
fn every_axis_ends_as_required() {
    let options = Options {
        axes: axes().into_iter().filter(|a| *a != "vertices").map(str::to_owned).collect(),
        ..Options::default()
    };
    let report = stability(&options, &mut |_, _| ControlFlow::Continue(()));
    let faults: Vec<_> = report.rows.iter().filter(|r| !r.pass).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(report.rows.len() > 100 && report.to_json().contains("\"outcome\": \"refused\""));
}

#[test]
fn stacks_of_sheets_end_without_a_fault() {
    let options = Options { axes: vec!["contact_stack".into()], ..Options::default() };
    let report = stability(&options, &mut |_, _| ControlFlow::Continue(()));
    assert!(report.rows.len() == 2 && report.pass(), "{report}");
    // Of five nothing crosses and nothing is in the body; whether they prove their rest in 500
    // steps is chance.
    assert!(matches!(report.rows[0].verdict, Verdict::Converged(_)), "{report}");
    if let Verdict::Refused(text) = &report.rows[1].verdict {
        assert!(text.contains("still moving"), "{report}");
    }
}

#[test]
fn a_caller_can_stop_and_choose() {
    let options = Options { axes: vec!["empty".into()], ..Options::default() };
    let all = stability(&options, &mut |_, _| ControlFlow::Continue(()));
    assert_eq!(all.rows.len(), 2);
    assert!(all.pass() && !all.stopped && all.to_string().contains("the scene has no triangles"));
    let none = stability(&options, &mut |_, _| ControlFlow::Break(()));
    assert!(none.stopped && none.rows.is_empty());
}

#[test]
fn bad_parameters_are_named_before_the_first_step() {
    let text = |case: Case| case.run(3, 1).unwrap_err().to_string();
    let usual = Case::default();
    assert_eq!(text(Case { density: 0.0, ..usual }), "density = 0 is out of range: above 0 kg/m^2");
    assert_eq!(text(Case { density: -1.0, ..usual }), "density = -1 is out of range: above 0 kg/m^2");
    assert_eq!(text(Case { stiffness: -5.0, ..usual }), "warp = -5 is out of range: a slope above 0 N/m");
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
            .made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]))
            .unwrap()
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
            .made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]))
            .unwrap()
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

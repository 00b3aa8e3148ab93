#![allow(clippy::unwrap_used)]
use super::*;
use crate::constraint::Plane;
use crate::energy::bending::Hinge;
use crate::energy::membrane::{StVenantKirchhoff, Triangles};
use crate::energy::{Blocks, Cloth, Models, Projection, Subset, Vec3, add_block_of};
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;
use crate::solver::layout::{Layout, Rectangle};
use nalgebra::Matrix3;

const G: f64 = 9.81;

fn fabric() -> Fabric {
    Fabric::isotropic(0.15, 100.0, 0.0, 1e-5)
}

/// A square of 0.5 m in the plane z = 0, hung or loose.
fn square(layout: Layout, n: usize) -> (Rectangle, Sheet, Model, State) {
    let mesh = Rectangle::new(layout, 0.5, 0.5, n);
    let sheet = mesh.sheet(0.15).unwrap();
    let model = Model::of(&sheet).made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric()])).unwrap();
    let state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    (mesh, sheet, model, state)
}

fn steppers(sheet: &Sheet, model: &Model, dt: f64) -> Vec<Box<dyn Solver>> {
    vec![
        Box::new(ImplicitEuler::new(dt, 1e-9)),
        Box::new(CentralDifferences::adaptive(dt)),
        Box::new(Xpbd::new(sheet, &fabric(), dt, 10).unwrap()),
        Box::new(Projective::new(sheet, model, 100.0, &Rigidity::uniform(1e-5), dt, 10).unwrap()),
    ]
}

fn run(solver: &mut dyn Solver, model: &Model, state: &mut State, seconds: f64) {
    while state.time < seconds - 1e-9 {
        solver.advance(model, state).unwrap();
    }
}

#[test]
fn free_fall_is_exact_in_every_solver() {
    let (_, sheet, model, state) = square(Layout::Alternating, 4);
    for mut solver in steppers(&sheet, &model, 1.0 / 64.0) {
        let mut s = state.clone();
        run(&mut *solver, &model, &mut s, 0.5);
        let fall = 0.5 * G * s.time * s.time;
        for (x, start) in s.x.iter().zip(&state.x) {
            let error = (start.y - x.y - fall).abs() / fall + (x.x - start.x).abs() + x.z.abs();
            assert!(error < 1e-9, "{}: {error:e}", solver.name());
        }
    }
}

#[test]
fn one_triangle_falls_exactly() {
    let mesh = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|p| nalgebra::Vector2::new(p[0], p[1]));
    let sheet = Sheet::flat(&mesh, &[[0, 1, 2]], 0.15).unwrap();
    let model = Model::of(&sheet).made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric()])).unwrap();
    for mut solver in steppers(&sheet, &model, 0.01) {
        let mut s = State::at_rest(mesh.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect());
        run(&mut *solver, &model, &mut s, 0.1);
        assert!((s.x[1].y + 0.5 * G * s.time * s.time).abs() < 1e-12, "{}", solver.name());
    }
}

#[test]
fn all_solvers_hang_a_sheet_at_the_same_length() {
    let (mesh, sheet, mut model, state) = square(Layout::Alternating, 6);
    model = model.pinned(|v| mesh.at_top(v));
    model.drag = 8.0;
    let tip = |s: &State| -(0..s.x.len()).map(|v| s.x[v].y).fold(f64::INFINITY, f64::min);
    let exact = 0.5 * 0.15 * G * 0.25 / 100.0;
    let mut rest = state.clone();
    Static::to(1e-9).advance(&model, &mut rest).unwrap();
    assert!((tip(&rest) / exact - 1.0).abs() < 0.01, "static: {} against {exact}", tip(&rest));
    for mut solver in steppers(&sheet, &model, 0.005) {
        let mut s = state.clone();
        run(&mut *solver, &model, &mut s, 1.5);
        assert!((tip(&s) / exact - 1.0).abs() < 0.02, "{}: {} against {exact}", solver.name(), tip(&s));
    }
}

#[test]
fn implicit_euler_converges_at_any_step() {
    let (mesh, _, mut model, state) = square(Layout::Irregular(3), 6);
    model = model.pinned(|v| mesh.at_top(v) && (mesh.uv[v].x < 1e-9 || mesh.uv[v].x > 0.5 - 1e-9));
    let mut depths = Vec::new();
    for dt in [1e-3, 1.0 / 240.0, 1.0 / 60.0, 1e-2, 1e-1] {
        let mut s = state.clone();
        s.x.iter_mut().for_each(|x| x.z += 1e-3 * (20.0 * x.x).sin());
        let mut solver = ImplicitEuler::new(dt, 1e-8);
        let steps = (if dt < 5e-3 { 150.0 * dt } else { 6.0 } / dt).ceil() as usize;
        model.drag = if dt < 5e-3 { 0.0 } else { 4.0 };
        let before = model.total_energy(&s);
        for _ in 0..steps {
            assert!(solver.advance(&model, &mut s).unwrap().converged, "dt {dt}");
        }
        assert!(model.total_energy(&s) < before + 0.01 * before.abs(), "dt {dt}");
        if dt >= 5e-3 {
            depths.push(s.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min));
        }
    }
    let spread = depths.iter().fold(0.0_f64, |w, d| w.max((d - depths[0]).abs()));
    assert!(spread < 0.005, "{depths:?}");
}

#[test]
fn conjugate_gradients_and_factor_take_the_same_step() {
    let (mesh, _, mut model, state) = square(Layout::Equilateral, 6);
    model = model.pinned(|v| mesh.at_top(v));
    let mut ends = Vec::new();
    for linear in [LinearMethod::Cholesky, LinearMethod::ConjugateGradients { tolerance: 1e-6 }] {
        let mut solver = ImplicitEuler::new(0.01, 1e-10);
        solver.newton.linear = linear;
        let mut s = state.clone();
        run(&mut solver, &model, &mut s, 0.1);
        ends.push(s);
    }
    assert!(ends[0].x.iter().zip(&ends[1].x).all(|(a, b)| (a - b).norm() < 1e-9));
}

#[test]
fn an_unstable_step_is_refused_and_the_limit_is_the_measured_one() {
    let (mesh, _, mut model, state) = square(Layout::OneDiagonal, 8);
    model = model.under(Vec3::zeros());
    let limit = CentralDifferences::limit(&model, &state.x);
    let error = CentralDifferences::fixed(1.01 * limit).advance(&model, &mut state.clone()).unwrap_err();
    assert!(matches!(error, crate::error::ClothError::TimeStepUnstable { .. }), "{error}");
    // The small-motion blow-up, by running the linearised sheet.
    let k = model.stiffness(&state.x, crate::energy::Projection::Exact);
    let grows = |dt: f64| {
        let mut u: Vec<Vec3> = mesh
            .uv
            .iter()
            .enumerate()
            .map(|(v, _)| Vec3::new((v as f64).sin(), (2.7 * v as f64).cos(), (v as f64 * 1.3).sin()))
            .collect();
        let mut w = vec![Vec3::zeros(); u.len()];
        for _ in 0..3000 {
            let f = k.times(&u);
            for v in 0..u.len() {
                w[v] -= f[v] * (dt / model.masses[v]);
                u[v] += w[v] * dt;
            }
            if u.iter().any(|u| u.norm() > 1e4) {
                return true;
            }
        }
        false
    };
    let (mut low, mut high) = (0.8 * limit, 1.2 * limit);
    for _ in 0..10 {
        let middle = 0.5 * (low + high);
        if grows(middle) { high = middle } else { low = middle }
    }
    assert!((low / limit - 1.0).abs() < 0.02, "measured {low:e}, computed {limit:e}");
}

#[test]
fn limits_of_springs_are_those_of_the_books() {
    // One spring, two masses of ratio 1e4: omega² = k (1/m1 + 1/m2).
    #[derive(Clone)]
    struct Spring;
    impl crate::energy::Element<2> for Spring {
        type State = Blocks<2>;
        fn name(&self) -> &'static str {
            "spring"
        }
        fn count(&self) -> usize {
            1
        }
        fn nodes(&self, _: usize) -> [u32; 2] {
            [0, 1]
        }
        fn value(&self, _: usize, x: &[Vec3; 2]) -> f64 {
            500.0 * ((x[1] - x[0]).norm() - 0.1).powi(2)
        }
        fn gradient(&self, _: usize, x: &[Vec3; 2]) -> [Vec3; 2] {
            let d = x[1] - x[0];
            let pull = d.normalize() * (1000.0 * (d.norm() - 0.1));
            [-pull, pull]
        }
        fn state(&self, _: usize, _: &[Vec3; 2], _: Projection) -> Blocks<2> {
            let h = Matrix3::from_diagonal(&Vec3::new(1000.0, 0.0, 0.0));
            [[h, -h], [-h, h]]
        }
        fn add_block(&self, _: usize, of: &Blocks<2>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
            add_block_of(of, row, column, sum);
        }
        fn part(&self, _: &[usize], _: &Subset) -> Self {
            self.clone()
        }
    }
    let sheet = Rectangle::new(Layout::OneDiagonal, 0.1, 0.1, 1).sheet(1.0).unwrap();
    let mut model = Model::of(&sheet).with(crate::energy::Assembled::<2, _>(Spring)).under(Vec3::zeros());
    model.masses = vec![1e-2, 1e-6, 1.0, 1.0];
    let x: Vec<Vec3> = [0.0, 0.1, 0.2, 0.3].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec();
    let wanted = (1000.0_f64 * (1e2 + 1e6)).sqrt();
    assert!((omega_max(&model, &x) / wanted - 1.0).abs() < 1e-9);
}

#[test]
fn drag_falls_as_the_formula_says() {
    let (_, sheet, mut model, state) = square(Layout::Alternating, 3);
    model.drag = 10.0;
    let (t, c) = (0.5_f64, 10.0_f64);
    let exact = G / c * (t - (1.0 - (-c * t).exp()) / c);
    for mut solver in steppers(&sheet, &model, 1e-3) {
        let mut s = state.clone();
        run(&mut *solver, &model, &mut s, t);
        let fall = state.x[0].y - s.x[0].y;
        assert!((fall / exact - 1.0).abs() < 0.01, "{}: {fall} against {exact}", solver.name());
    }
}

#[test]
fn momentum_and_energy_of_a_free_sheet() {
    let (_, _, mut model, mut state) = square(Layout::Irregular(5), 5);
    model = model.under(Vec3::zeros());
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = Vec3::new((9.0 * x.y).sin(), x.x, (7.0 * x.x).cos()) * 0.3;
    }
    let momentum = |s: &State| -> Vec3 { s.v.iter().zip(&model.masses).map(|(v, m)| v * *m).sum() };
    let (before, energy) = (momentum(&state), model.total_energy(&state));
    let mut solver = ImplicitEuler::new(5e-3, 1e-12);
    let mut last = energy;
    for _ in 0..50 {
        solver.advance(&model, &mut state).unwrap();
        let now = model.total_energy(&state);
        assert!(now <= last + 1e-6 * energy, "{now} after {last}");
        last = now;
    }
    assert!((momentum(&state) - before).norm() < 1e-9 * 50.0 * before.norm());
}

#[test]
fn thread_count_does_not_change_a_bit() {
    let (mesh, _, mut model, state) = square(Layout::Irregular(2), 14);
    model = model.pinned(|v| mesh.at_top(v));
    let end = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut s = state.clone();
            s.x.iter_mut().for_each(|x| x.z = 0.01 * (9.0 * x.y).sin());
            run(&mut ImplicitEuler::new(0.01, 1e-8), &model, &mut s, 0.05);
            run(&mut CentralDifferences::adaptive(0.01), &model, &mut s, 0.06);
            s
        })
    };
    assert!(end(1) == end(2) && end(1) == end(3));
}

#[test]
fn a_sheet_on_a_slope_sticks_or_slides_without_creep() {
    let (_, sheet, mut model, _) = square(Layout::OneDiagonal, 3);
    let slope = 20_f64.to_radians();
    let normal = Vec3::new(-slope.sin(), slope.cos(), 0.0);
    let down = Vec3::new(-slope.cos(), -slope.sin(), 0.0);
    let mesh = Rectangle::new(Layout::OneDiagonal, 0.5, 0.5, 3);
    for (mu, slides) in [(0.3, true), (0.4, false), (10.0, false)] {
        model.obstacles = vec![Box::new(Plane::new(Vec3::zeros(), normal, mu).unwrap())];
        let start: Vec<Vec3> = mesh.uv.iter().map(|p| down * p.y + Vec3::z() * p.x).collect();
        let mut s = State::at_rest(start.clone());
        run(&mut CentralDifferences::adaptive(1e-3), &model, &mut s, 0.3);
        let moved = (s.x[0] - start[0]).norm();
        let exact = 0.5 * G * (slope.sin() - mu * slope.cos()).max(0.0) * s.time * s.time;
        assert!(
            (moved - exact).abs() < if slides { 0.005 * exact } else { 1e-9 },
            "mu {mu}: {moved} against {exact}"
        );
    }
    assert_eq!(sheet.triangles().len(), 18);
}

#[test]
fn st_venant_kirchhoff_hangs_by_its_own_law() {
    let (mesh, sheet, _, state) = square(Layout::Alternating, 10);
    let alpha: f64 = 0.3;
    let k = 0.15 * G * 0.5 / alpha;
    let mut model = Model::of(&sheet)
        .with(Triangles::new(&sheet, StVenantKirchhoff::new(k, 0.0).unwrap()))
        .with(Hinge::new(&Cloth::of(&sheet, &[&Fabric::isotropic(0.15, k, 0.0, 1e-8)])))
        .pinned(|v| mesh.at_top(v));
    model.viscosity = 0.0;
    let mut s = state;
    Static::to(1e-9).advance(&model, &mut s).unwrap();
    let tip = -s.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    // The stretch under the load q below a point: s (s^2 - 1) / 2 = q; its mean above 1 over the
    // length is the tip's way.
    let stretch =
        |q: f64| (0..50).fold(1.0 + q, |s: f64, _| s - (0.5 * s * (s * s - 1.0) - q) / (1.5 * s * s - 0.5));
    let exact =
        (0..2000).map(|i| stretch(alpha * (f64::from(i) + 0.5) / 2000.0) - 1.0).sum::<f64>() / 2000.0 * 0.5;
    assert!((tip / exact - 1.0).abs() < 0.005, "{tip} against {exact}");
}

/// Internal forces alone change neither momentum of a free sheet, whatever shape and speeds it
/// starts with.
#[test]
fn central_differences_keep_both_momenta() {
    for seed in 1..6_u32 {
        let (_, _, mut model, mut state) = square(Layout::Irregular(u64::from(seed)), 4);
        model = model.under(Vec3::zeros());
        let s = f64::from(seed);
        for (k, v) in state.v.iter_mut().enumerate() {
            let k = k as f64;
            *v = Vec3::new((s * k).sin(), (1.3 * k + s).cos(), (0.7 * s * k).sin()) * 0.5;
        }
        let mut solver = CentralDifferences::adaptive(1e-3);
        // Velocities lie between two states: turning momentum is taken with the mean of both.
        let mut momenta = Vec::new();
        for _ in 0..200 {
            let before = state.x.clone();
            solver.advance(&model, &mut state).unwrap();
            let linear: Vec3 = state.v.iter().zip(&model.masses).map(|(v, m)| v * *m).sum();
            let middle = |v: usize| 0.5 * (before[v] + state.x[v]);
            let turning: Vec3 =
                (0..state.x.len()).map(|v| middle(v).cross(&state.v[v]) * model.masses[v]).sum();
            momenta.push((linear, turning));
        }
        let (linear, turning) = momenta[0];
        let size: f64 = state.v.iter().zip(&model.masses).map(|(v, m)| v.norm() * m).sum();
        for (l, t) in momenta {
            assert!((l - linear).norm() < 1e-12 * size, "{seed}: {:e}", (l - linear).norm());
            assert!((t - turning).norm() < 1e-9 * size, "{seed}: {:e}", (t - turning).norm());
        }
    }
}

#[test]
fn vertices_too_light_for_the_least_step_get_inertia_and_no_weight() {
    // It hangs from its upper edge.
    let (mesh, _, mut model, state) = square(Layout::OneDiagonal, 8);
    model.fixed = mesh.uv.iter().map(|p| p.y > 0.499).collect();
    model.masses[20] *= 1e-3;
    model.drag = 30.0;
    let limit = CentralDifferences::limit(&model, &state.x);
    let least = 8.0 * limit;
    let rest = |solver: &mut CentralDifferences, model: &Model| {
        let (mut s, mut shortest) = (state.clone(), f64::INFINITY);
        while s.time < 3.0 {
            shortest = shortest.min(solver.advance(model, &mut s).unwrap().advanced);
        }
        (s.x, shortest)
    };
    let (exact, short) = rest(&mut CentralDifferences::adaptive(1e-3), &model);
    model.inertia = CentralDifferences::inertia(&model, &state.x, least);
    assert!(model.inertia.iter().zip(&model.masses).all(|(i, m)| i >= m));
    let (heavier, long) = rest(&mut CentralDifferences::bounded(1e-3, least), &model);
    assert!(long >= 0.999 * least && short < 0.5 * long, "{short} {long}");
    let apart = exact.iter().zip(&heavier).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "the state of rest is the same: {apart}");
}

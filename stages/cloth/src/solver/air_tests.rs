//! Air against what can be written down: terminal speeds, a sheet that the wind carries off, a flap
//! in the wind, energy.
#![allow(clippy::unwrap_used)]
use super::*;
use crate::energy::{Air, AirDrag, Cloth, Models, Vec3};
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;
use crate::solver::layout::{Layout, Rectangle};
use proptest::prelude::*;

const G: f64 = 9.81;
const SIGMA: f64 = 0.15;
const AIR: Air = Air { density: 1.2, normal: 1.17, tangential: 0.4, wind: Vec3::new(0.0, 0.0, 0.0) };

struct Flown {
    mesh: Rectangle,
    sheet: Sheet,
    fabric: Fabric,
    model: Model,
    /// Flat in the plane z = 0, top edge up.
    state: State,
}

fn flown(stretch: f64, n: usize, air: Air) -> Flown {
    let fabric = Fabric::isotropic(SIGMA, stretch, 0.0, 1e-5);
    let mesh = Rectangle::new(Layout::Alternating, 0.5, 0.5, n);
    let sheet = mesh.sheet(SIGMA).unwrap();
    let model = Model::of(&sheet)
        .made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]))
        .unwrap()
        .in_air(air, &sheet);
    let state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    Flown { mesh, sheet, fabric, model, state }
}

impl Flown {
    fn steppers(&self, dt: f64) -> Vec<Box<dyn Solver>> {
        let (stretch, rigidity) = (self.fabric.stretch(), Rigidity::of(&self.fabric));
        vec![
            Box::new(ImplicitEuler::new(dt, 1e-9)),
            Box::new(CentralDifferences::adaptive(dt)),
            Box::new(Xpbd::new(&self.sheet, &self.fabric, dt, 10).unwrap()),
            Box::new(Projective::new(&self.sheet, &self.model, stretch, &rigidity, dt, 20).unwrap()),
        ]
    }

    /// The velocity of vertex 0 over the last of the steps that take `seconds`.
    fn speed_after(&self, solver: &mut dyn Solver, seconds: f64) -> (f64, Vec3, State) {
        let (mut s, mut before, mut dt) = (self.state.clone(), self.state.clone(), 0.0);
        while s.time < seconds - 1e-9 {
            before.clone_from(&s);
            dt = solver.advance(&self.model, &mut s).unwrap().advanced;
        }
        (s.time, (s.x[0] - before.x[0]) / dt, s)
    }

    /// Turned about the x axis, so that its normal leaves the z axis by `angle`.
    fn turned(mut self, angle: f64) -> Self {
        let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), angle);
        self.state.x.iter_mut().for_each(|x| *x = turn * *x);
        self
    }
}

#[test]
fn a_sheet_falls_face_on_at_its_terminal_speed() {
    let flown = flown(100.0, 4, AIR).turned(-std::f64::consts::FRAC_PI_2);
    let exact = (2.0 * SIGMA * G / (AIR.density * AIR.normal)).sqrt();
    for mut solver in flown.steppers(1.0 / 120.0) {
        let (_, v, _) = flown.speed_after(&mut *solver, 3.0);
        assert!((v + Vec3::y() * exact).norm() < 1e-6 * exact, "{}: {v} against {exact}", solver.name());
    }
}

#[test]
fn a_sheet_falls_edge_on_by_the_tangential_part_alone() {
    let flown = flown(100.0, 4, AIR);
    let exact = (2.0 * SIGMA * G / (AIR.density * AIR.tangential)).sqrt();
    for mut solver in flown.steppers(1.0 / 120.0) {
        let (_, v, _) = flown.speed_after(&mut *solver, 4.0);
        assert!((v + Vec3::y() * exact).norm() < 1e-4 * exact, "{}: {v} against {exact}", solver.name());
    }
}

#[test]
fn a_slanted_sheet_falls_with_each_part_at_its_own_terminal_speed() {
    let angle = 0.6_f64;
    let flown = flown(100.0, 4, AIR).turned(-angle);
    // Its normal and the way down along it.
    let (n, t) = (Vec3::new(0.0, angle.sin(), angle.cos()), Vec3::new(0.0, angle.cos(), -angle.sin()));
    let speed = |share: f64, c: f64| (2.0 * SIGMA * G * share / (AIR.density * c)).sqrt();
    let exact = -n * speed(angle.sin(), AIR.normal) - t * speed(angle.cos(), AIR.tangential);
    for mut solver in flown.steppers(1.0 / 120.0) {
        let (_, v, _) = flown.speed_after(&mut *solver, 4.0);
        assert!((v - exact).norm() < 1e-4 * exact.norm(), "{}: {v} against {exact}", solver.name());
    }
}

#[test]
fn wind_gives_a_free_sheet_its_momentum_to_the_exact_amount_whatever_the_step() {
    let wind = Vec3::new(3.0, 0.0, -8.0);
    let mut flown = flown(100.0, 4, Air { wind, ..AIR });
    flown.model.gravity = Vec3::zeros();
    // m s' = -k s² for either part s of the slip: s = s0 / (1 + k s0 t / m).
    let left = |slip: f64, c: f64, t: f64| slip / (1.0 + 0.5 * AIR.density * c / SIGMA * slip * t);
    for dt in [1e-3, 1.0 / 60.0, 0.1] {
        for (k, mut solver) in flown.steppers(dt).into_iter().enumerate() {
            let (time, _, s) = flown.speed_after(&mut *solver, 0.4);
            let v = s.v[0];
            // The first of central differences' steps moves velocities by half of its length.
            let t = if k == 1 { time - first_half(&flown, dt) } else { time };
            let exact = wind - Vec3::new(left(3.0, AIR.tangential, t), 0.0, -left(8.0, AIR.normal, t));
            // Iterations bound drag by its greatest part: over long steps the lesser one is left by
            // some of them.
            let left_over = if k == 3 && dt > 0.05 { 5e-4 } else { 1e-7 };
            assert!((v - exact).norm() < left_over, "{} at {dt}: {v} against {exact}", solver.name());
            let momentum: Vec3 = s.v.iter().zip(&flown.model.masses).map(|(v, m)| v * *m).sum();
            assert!((momentum - exact * (SIGMA * 0.25)).norm() < left_over, "{} at {dt}", solver.name());
        }
    }
}

/// Half the step that central differences take where they may take `dt`.
fn first_half(flown: &Flown, dt: f64) -> f64 {
    let mut s = flown.state.clone();
    0.5 * CentralDifferences::adaptive(dt).advance(&flown.model, &mut s).unwrap().advanced
}

#[test]
fn a_flap_hangs_in_the_wind_at_the_angle_that_weight_and_wind_balance() {
    let speed = 2.0;
    let mut flown = flown(300.0, 5, Air { wind: Vec3::z() * speed, ..AIR });
    flown.model = flown.model.pinned(|v| flown.mesh.at_top(v));
    flown.model.drag = 6.0;
    // sigma g sin a = rho c_n (w cos a)² / 2, for every part of the flap: it is straight without
    // being stiff.
    let q = AIR.density * AIR.normal * speed * speed / (2.0 * SIGMA * G);
    let sine = ((1.0 + 4.0 * q * q).sqrt() - 1.0) / (2.0 * q);
    for mut solver in flown.steppers(1.0 / 200.0) {
        let (_, _, s) = flown.speed_after(&mut *solver, 6.0);
        for (v, x) in s.x.iter().enumerate().filter(|(v, _)| !flown.mesh.at_top(*v)) {
            let (out, down) = (x.z, 0.5 - x.y);
            let found = out / out.hypot(down);
            assert!((found - sine).abs() < 2e-3, "{} at {v}: {found} against {sine}", solver.name());
        }
        assert!(s.greatest_speed() < 0.05, "{}: {}", solver.name(), s.greatest_speed());
    }
}

#[test]
fn still_air_never_gives_energy() {
    let mut flown = flown(100.0, 5, Air { density: 20.0, ..AIR });
    flown.model = flown.model.pinned(|v| flown.mesh.at_top(v)).under(Vec3::zeros());
    for (v, x) in flown.state.v.iter_mut().zip(&flown.state.x) {
        let reach = 0.5 - x.y;
        *v = Vec3::new(0.1 * x.y.sin(), 0.0, 3.0 * reach * (5.0 * x.x).cos());
    }
    let start = flown.model.total_energy(&flown.state);
    for dt in [1e-3, 0.01, 0.1] {
        let mut s = flown.state.clone();
        let mut solver = ImplicitEuler::new(dt, 1e-8);
        let mut last = start;
        while s.time < 0.5 {
            solver.advance(&flown.model, &mut s).unwrap();
            let now = flown.model.total_energy(&s);
            assert!(now <= last + 1e-7 * start.abs(), "{dt}: {now} after {last}");
            last = now;
        }
        for mut solver in flown.steppers(dt) {
            let (_, _, s) = flown.speed_after(&mut *solver, 0.5);
            let now = flown.model.total_energy(&s);
            assert!(now < start, "{} at {dt}: {now} after {start}", solver.name());
        }
    }
}

#[test]
fn a_storm_in_water_throws_no_sheet_faster_than_itself() {
    let wind = Vec3::new(600.0, 0.0, 800.0);
    let air = Air { density: 2000.0, normal: 100.0, tangential: 100.0, wind };
    let mut flown = flown(100.0, 3, air);
    flown.model.gravity = Vec3::zeros();
    for dt in [1e-4, 0.1] {
        for mut solver in flown.steppers(dt) {
            let (_, v, _) = flown.speed_after(&mut *solver, 5.0 * dt);
            assert!(v.norm() <= 1000.0 * (1.0 + 1e-9) && v.z > 0.0, "{} at {dt}: {v}", solver.name());
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit_in_wind() {
    let flown = flown(100.0, 12, Air { wind: Vec3::new(1.0, 0.5, 4.0), ..AIR });
    for k in 0..4 {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| flown.speed_after(&mut *flown.steppers(0.01).swap_remove(k), 0.05).2)
        };
        assert_eq!(on(1), on(3));
    }
}

#[test]
fn what_is_no_air_is_refused() {
    let said = |change: &dyn Fn(&mut Air)| {
        let mut air = AIR;
        change(&mut air);
        air.check().unwrap_err().to_string()
    };
    assert_eq!(said(&|a| a.density = -1.0), "air density = -1 is out of range: from 0 to 2000 kg/m^3");
    assert_eq!(said(&|a| a.density = 1e9), "air density = 1000000000 is out of range: from 0 to 2000 kg/m^3");
    assert_eq!(said(&|a| a.density = f64::NAN), "air density[0] is not a finite number");
    assert_eq!(said(&|a| a.normal = -0.1), "normal drag coefficient = -0.1 is out of range: from 0 to 100");
    assert_eq!(
        said(&|a| a.tangential = 101.0),
        "tangential drag coefficient = 101 is out of range: from 0 to 100"
    );
    assert_eq!(said(&|a| a.normal = f64::INFINITY), "normal drag coefficient[0] is not a finite number");
    assert_eq!(said(&|a| a.wind.y = f64::NAN), "wind[1] is not a finite number");
    let text = said(&|a| a.wind.z = 1e200);
    assert!(
        text.starts_with("wind speed = 1000") && text.ends_with("0 is out of range: at most 1000 m/s"),
        "{text}"
    );
    assert_eq!(said(&|a| a.wind.z = 2000.0), "wind speed = 2000 is out of range: at most 1000 m/s");
    let flown = flown(100.0, 2, Air { wind: Vec3::new(f64::NAN, 0.0, 0.0), ..AIR });
    for mut solver in flown.steppers(0.01) {
        let error = solver.advance(&flown.model, &mut flown.state.clone()).unwrap_err();
        assert_eq!(error.to_string(), "wind[0] is not a finite number", "{}", solver.name());
    }
}

#[test]
fn the_static_solver_rests_in_still_air_and_names_others_for_wind() {
    let mut flown = flown(100.0, 3, AIR);
    flown.model = flown.model.pinned(|v| flown.mesh.at_top(v));
    let (mut in_air, mut without) = (flown.state.clone(), flown.state.clone());
    Static::to(1e-9).advance(&flown.model, &mut in_air).unwrap();
    let windy = Air { wind: Vec3::new(3.0, 4.0, 0.0), ..AIR };
    let blown = Model { air: Some(AirDrag::new(windy, flown.sheet.triangles())), ..flown.model };
    let error = Static::to(1e-9).advance(&blown, &mut flown.state.clone()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "wind of 5 m/s has no potential, so this solver finds no state of rest in it; take ImplicitEuler, \
         CentralDifferences, Xpbd or Projective, which move the cloth until it rests"
    );
    Static::to(1e-9).advance(&Model { air: None, ..blown }, &mut without).unwrap();
    assert_eq!(in_air.x, without.x);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// For any position and velocity of the sheet, still air takes energy, and the drag tensors of
    /// the linear step sum to the force of the drag law.
    #[test]
    fn air_takes_energy_and_the_drag_tensors_add_up_to_the_law(
        numbers in prop::collection::vec(-3.0..3.0_f64, 24), wind in prop::collection::vec(-20.0..20.0_f64, 3),
    ) {
        let vec = |k: usize| Vec3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
        let (x, v): (Vec<Vec3>, Vec<Vec3>) = ((0..4).map(vec).collect(), (4..8).map(vec).collect());
        let triangles = [[0, 1, 2], [2, 1, 3]];
        let power = |f: &[Vec3]| f.iter().zip(&v).map(|(f, v)| f.dot(v)).sum::<f64>();
        let still = AirDrag::new(AIR, &triangles);
        prop_assert!(power(&still.forces(&x, &v)) <= 1e-12);
        for b in still.drag_tensors(&x, &v) {
            prop_assert!(b.symmetric_eigenvalues().min() >= -1e-12 && (b - b.transpose()).amax() < 1e-12);
        }
        let windy = AirDrag::new(Air { wind: Vec3::new(wind[0], wind[1], wind[2]), ..AIR }, &triangles);
        let law: Vec3 = windy.forces(&x, &v).iter().sum();
        let held: Vec3 = windy.drag_tensors(&x, &v).iter().zip(&v).map(|(b, v)| b * (windy.air.wind - v)).sum();
        prop_assert!((law - held).norm() < 1e-10 * (1.0 + law.norm()));
    }
}

//! Diagnostics: what the models do where no score is agreed on, each beside the figure that theory
//! or custom knows.
//!
//! Lateral buckling (the implied Poisson's ratio of bending), the foot of a pressed strip (stick or
//! slip), the heart loop, the picture frame, a swinging plate, and Cusick's drape test. No limits:
//! they show where a difference comes from.

use std::f64::consts::{FRAC_PI_3, PI};
use std::fmt;
use std::ops::ControlFlow;
use std::time::Instant;

use serde::Serialize;

use super::table::Table;
use super::{Models, Progress, reference};
use toile_cloth::energy::{Bending, Clamp, Cloth, Membrane, Projection, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::fabric::Rigidity;
use toile_cloth::linear::Cholesky;
use toile_cloth::scene::{Scene, generate};
use toile_cloth::solver::layout::{Layout, Rectangle, disc};
use toile_cloth::solver::{
    CentralDifferences, ImplicitEuler, Model, Projective, Solver, State, Static, Xpbd,
};
use toile_cloth::statics::drive::solve::{StaticEquilibrium, StaticsError};

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Which diagnostic.
    pub diagnostic: &'static str,
    /// Models or solver, and the parameter.
    pub case: String,
    /// What is measured, with its unit.
    pub quantity: &'static str,
    /// As measured; none if refused.
    pub measured: Option<f64>,
    /// What it should be, or is known to be about.
    pub reference: f64,
    /// Whether the reference is exact for the case; else a bound or a custom.
    pub exact: bool,
    /// Wall time, s.
    pub seconds: f64,
    /// Why there is no figure.
    pub refused: Option<String>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Diagnostic by diagnostic.
    pub rows: Vec<Row>,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

/// One figure to be made.
struct Task {
    diagnostic: &'static str,
    case: String,
    quantity: &'static str,
    reference: f64,
    exact: bool,
    run: Box<dyn Fn() -> Result<f64, String>>,
}

/// Runs all diagnostics; `progress` hears of each figure before it begins and may stop there.
#[must_use]
pub fn diagnostics(progress: &mut Progress<'_>) -> Report {
    let tasks = tasks();
    let mut report = Report { rows: vec![], stopped: false };
    for (k, task) in tasks.iter().enumerate() {
        let name = format!("{}, {}", task.diagnostic, task.case);
        if progress(k as f64 / tasks.len() as f64, &name) == ControlFlow::Break(()) {
            report.stopped = true;
            break;
        }
        report.rows.push(task.row());
    }
    report
}

impl Task {
    fn row(&self) -> Row {
        let clock = Instant::now();
        let result =
            (self.run)().and_then(|m| if m.is_nan() { Err("did not get there".into()) } else { Ok(m) });
        Row {
            diagnostic: self.diagnostic,
            case: self.case.clone(),
            quantity: self.quantity,
            measured: result.as_ref().ok().copied(),
            reference: self.reference,
            exact: self.exact,
            seconds: clock.elapsed().as_secs_f64(),
            refused: result.err(),
        }
    }
}

const WITH_HINGES: [Models; 2] = [Models::DEFAULT, Models::STATIC];

fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    for models in WITH_HINGES {
        tasks.push(Task {
            diagnostic: "lateral buckling",
            case: models.name(),
            quantity: "rho g L³/D of a narrow strip on edge",
            reference: reference::lateral_buckling(0.0),
            exact: true,
            run: Box::new(move || text(buckling(models))),
        });
    }
    for shortening in [0.1, 0.3] {
        tasks.push(Task {
            diagnostic: "stick-slip strip",
            case: format!("{}, pressed by {shortening}", Models::DEFAULT.name()),
            quantity: "friction at which the foot slips",
            reference: reference::pressed_column(shortening).value,
            exact: true,
            run: Box::new(move || text(pressed(shortening))),
        });
    }
    for gamma in [0.0, 20.0, 80.0] {
        tasks.push(Task {
            diagnostic: "heart loop",
            case: format!("{}, Gamma {gamma}", Models::DEFAULT.name()),
            quantity: "height in lengths",
            reference: reference::heart_loop(gamma).value,
            exact: true,
            run: Box::new(move || text(heart(gamma))),
        });
    }
    for models in Models::ALL.into_iter().filter(|m| matches!(m.bending, Bending::Hinge | Bending::SkipOne)) {
        for degrees in [5.0, 30.0] {
            tasks.push(Task {
                diagnostic: "picture frame",
                case: format!("{}, {degrees} degrees", models.name()),
                quantity: "torque over G times angle and area",
                reference: 1.0,
                exact: models.membrane == Membrane::Woven,
                run: Box::new(move || text(frame(models, degrees))),
            });
        }
    }
    tasks.extend(pendulums());
    for d in [1e-6, 1e-5, 1e-4, 1e-3] {
        tasks.push(Task {
            diagnostic: "Cusick drape",
            case: format!("StaticEquilibrium, D {d:e} N m, 0.15 kg/m²"),
            quantity: "drape coefficient; radial strips alone",
            reference: radial_strips(d),
            exact: false,
            run: Box::new(move || cusick(d)),
        });
    }
    tasks
}

fn text<T>(result: Result<T, ClothError>) -> Result<T, String> {
    result.map_err(|e| e.to_string())
}

/// The least load at which a strip on edge is no longer stable in its plane.
fn buckling(models: Models) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(Layout::Equilateral, 0.1, 1.0, 60);
    let sheet = mesh.sheet(1.0)?;
    let held = Clamp { chosen: &|v| mesh.at_bottom(v as usize), outward: &|_| -Vec3::x() };
    let stable = |gamma: f64| -> Result<bool, ClothError> {
        let fabric = Fabric::isotropic(1.0, 1e6, 0.0, 1.0);
        let mut model = Model::of(&sheet).pinned(|v| mesh.at_bottom(v)).under(Vec3::new(0.0, -gamma, 0.0));
        let fixed = model.fixed.clone();
        model = model.made_of(models, &Cloth::of(&sheet, &[&fabric]).holding(&fixed).clamped(held))?;
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y, p.x, 0.0)).collect());
        Static::to(1e-6 * gamma).advance(&model, &mut state)?;
        let mut stiffness = model.stiffness(&state.x, Projection::Exact);
        stiffness.fix(&model.fixed);
        Ok(Cholesky::analyse(&stiffness)?.factor(&stiffness).is_ok())
    };
    let (mut low, mut high) = (5.0, 60.0);
    for _ in 0..10 {
        let middle = 0.5 * (low + high);
        if stable(middle)? { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Horizontal over vertical force at the foot of a strip clamped upright and pressed on the ground.
fn pressed(shortening: f64) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(Layout::Equilateral, 0.2, 1.0, 40);
    let sheet = mesh.sheet(1.0)?;
    let curve = reference::pressed_column(shortening);
    // Along the curve: +x is down here.
    let place = |p: &nalgebra::Vector2<f64>| {
        let [down, aside] = curve.at(p.y);
        Vec3::new(aside, -down, p.x)
    };
    let held = Clamp { chosen: &|v| mesh.at_bottom(v as usize), outward: &|_| Vec3::y() };
    let mut model = Model::of(&sheet).pinned(|v| mesh.at_bottom(v) || mesh.at_top(v)).under(Vec3::zeros());
    let fabric = Fabric::isotropic(1.0, 1e5, 0.0, 1.0);
    let fixed = model.fixed.clone();
    model = model.made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]).holding(&fixed).clamped(held))?;
    let mut state = State::at_rest(mesh.uv.iter().map(place).collect());
    Static::to(1e-6).advance(&model, &mut state)?;
    let force = model.forces(&state.x);
    let foot: Vec3 = (0..mesh.uv.len()).filter(|&v| mesh.at_top(v)).map(|v| force[v]).sum();
    Ok((foot.x / foot.y).abs())
}

/// Height of a heart loop.
fn heart(gamma: f64) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(Layout::Equilateral, 0.15, 1.0, 80);
    let sheet = mesh.sheet(1.0)?;
    // From the weightless shape, so that the weight has work to do.
    let curve = reference::heart_loop(0.0);
    let place = |p: &nalgebra::Vector2<f64>| {
        let [x, y] = curve.at(p.y);
        Vec3::new(x, y, p.x)
    };
    let end = |v: usize| mesh.at_bottom(v) || mesh.at_top(v);
    let held = Clamp { chosen: &|v| end(v as usize), outward: &|_| -Vec3::y() };
    let mut model = Model::of(&sheet).pinned(end).under(Vec3::new(0.0, -gamma, 0.0));
    let fabric = Fabric::isotropic(1.0, 1e5_f64.max(2e3 * gamma), 0.0, 1.0);
    let fixed = model.fixed.clone();
    model = model.made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]).holding(&fixed).clamped(held))?;
    let mut state = State::at_rest(mesh.uv.iter().map(place).collect());
    Static::to(1e-6 * gamma.max(1.0)).advance(&model, &mut state)?;
    let low = state.x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    Ok(curve.at(0.0)[1] - low)
}

/// Torque of a sheared frame over what shear stiffness times angle gives.
fn frame(models: Models, degrees: f64) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(Layout::Alternating, 1.0, 1.0, 8);
    let sheet = mesh.sheet(1.0)?;
    let g = 40.0;
    let mut fabric = Fabric::isotropic(1.0, 2.6 * g, 0.3, 0.0);
    fabric.shear = toile_cloth::fabric::Curve::linear(g);
    let membrane = models.membrane(&Cloth::of(&sheet, &[&fabric]))?;
    let energy = |angle: f64| {
        let place = |p: &nalgebra::Vector2<f64>| Vec3::new(p.x + p.y * angle.sin(), p.y * angle.cos(), 0.0);
        membrane.value(&mesh.uv.iter().map(place).collect::<Vec<_>>())
    };
    let (angle, step) = (degrees.to_radians(), 1e-5);
    Ok((energy(angle + step) - energy(angle - step)) / (2.0 * step * g * angle))
}

/// The swinging plate, solver by solver: its period and what it loses in one.
fn pendulums() -> Vec<Task> {
    let exact = reference::plate_pendulum(FRAC_PI_3);
    let names =
        ["central differences", "implicit Euler, 200 steps", "XPBD, 200 x 20", "projective, 200 x 10"];
    let task =
        |(k, name): (usize, &'static str), quantity: &'static str, reference: f64, which: usize| Task {
            diagnostic: "pendulum",
            case: name.into(),
            quantity,
            reference,
            exact: true,
            run: Box::new(move || text(swing(k)).map(|s| s[which])),
        };
    let each = || names.into_iter().enumerate();
    let periods = each().map(|n| task(n, "period over sqrt(L/g)", exact, 0));
    let heights = each().map(|n| task(n, "height kept in a period", 1.0, 1));
    periods.chain(heights).collect()
}

/// Period (from three zero crossings) and share of the height kept, of a stiff plate released at 60
/// degrees.
fn swing(solver: usize) -> Result<[f64; 2], ClothError> {
    let mesh = Rectangle::new(Layout::Equilateral, 0.3, 1.0, 10);
    let sheet = mesh.sheet(1.0)?;
    let fabric = Fabric::isotropic(1.0, 2e3, 0.0, 50.0);
    let mut model = Model::of(&sheet).pinned(|v| mesh.at_bottom(v)).under(Vec3::new(0.0, -1.0, 0.0));
    let fixed = model.fixed.clone();
    model = model.made_of(Models::DEFAULT, &Cloth::of(&sheet, &[&fabric]).holding(&fixed))?;
    let dt = reference::plate_pendulum(FRAC_PI_3) / 200.0;
    let mut solver: Box<dyn Solver> = match solver {
        0 => Box::new(CentralDifferences::adaptive(dt)),
        1 => Box::new(ImplicitEuler::new(dt, 1e-8)),
        2 => Box::new(Xpbd::new(&sheet, &fabric, dt, 20)?),
        _ => Box::new(Projective::new(&sheet, &model, 2e3, &Rigidity::of(&fabric), dt, 10)?),
    };
    let (s, c) = FRAC_PI_3.sin_cos();
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.y * s, -p.y * c, p.x)).collect());
    let tips: Vec<usize> = (0..mesh.uv.len()).filter(|&v| mesh.at_top(v)).collect();
    let angle = |x: &[Vec3]| {
        let tip: Vec3 = tips.iter().map(|&v| x[v]).sum();
        tip.x.atan2(-tip.y)
    };
    let (mut crossings, mut last, mut farthest) = (Vec::new(), (0.0, FRAC_PI_3), 0.0_f64);
    while crossings.len() < 3 && state.time < 20.0 {
        solver.advance(&model, &mut state)?;
        let now = (state.time, angle(&state.x));
        if now.1 * last.1 < 0.0 {
            crossings.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
        }
        // Back on the first side: a full period after the start.
        if crossings.len() == 2 {
            farthest = farthest.max(now.1);
        }
        last = now;
    }
    match crossings[..] {
        [first, _, third] => Ok([third - first, (1.0 - farthest.cos()) / (1.0 - FRAC_PI_3.cos())]),
        _ => Ok([f64::NAN; 2]),
    }
}

/// Specimen and support radius, m, and rings of the mesh: the support's rim lies on one.
const SPECIMEN: f64 = 0.15;
const SUPPORT: f64 = 0.09;
const RINGS: usize = 20;

/// Drape coefficient if every radius were a strip of its own, without hoops that hold the cloth up.
fn radial_strips(d: f64) -> f64 {
    let overhang = SPECIMEN - SUPPORT;
    let reach = reference::cantilever(0.15 * 9.81 * overhang.powi(3) / d).reach;
    coefficient(PI * (SUPPORT + overhang * reach).powi(2))
}

/// Shadow's share of the ring around the support.
fn coefficient(shadow: f64) -> f64 {
    (shadow - PI * SUPPORT * SUPPORT) / (PI * (SPECIMEN * SPECIMEN - SUPPORT * SUPPORT))
}

/// Drape coefficient of a disc of cloth clamped on its support.
fn cusick(d: f64) -> Result<f64, String> {
    let (uv, triangles) = disc(SPECIMEN, RINGS);
    let mut scene = Scene::new("Cusick", Fabric::isotropic(0.15, 500.0, 0.0, d));
    let start: Vec<Vec3> = uv.iter().map(|p| Vec3::new(p.x, 0.0, -p.y)).collect();
    scene.add_panel("specimen", &uv, &start, &triangles);
    scene.pinned = (0..uv.len()).filter(|&v| uv[v].norm() < SUPPORT + 1e-9).map(|v| v as u32).collect();
    scene.self_collision = false;
    generate::jitter(&mut scene, 1e-4, 1);
    let x = match StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(())) {
        Ok(state) => state.positions,
        Err(StaticsError::NotAtRest { state, .. }) => state.positions,
        Err(e) => return Err(e.to_string()),
    };
    let rim = &x[uv.len() - 6 * RINGS..];
    let fan = |k: usize| {
        let (a, b) = (&rim[k], &rim[(k + 1) % rim.len()]);
        0.5 * (a.x * -b.z - b.x * -a.z)
    };
    Ok(coefficient((0..rim.len()).map(fan).sum()))
}

impl Report {
    /// As JSON, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = Table::new(&["diagnostic", "case", "quantity", "measured", "reference", "off", "s"]);
        for r in &self.rows {
            let off =
                r.measured.filter(|_| r.exact).map(|m| format!("{:+.2} %", 100.0 * (m / r.reference - 1.0)));
            table.row([
                r.diagnostic.into(),
                r.case.clone(),
                r.quantity.into(),
                r.measured.map_or_else(|| r.refused.clone().unwrap_or_default(), |m| format!("{m:.4}")),
                format!("{:.4}", r.reference),
                off.unwrap_or_default(),
                format!("{:.2}", r.seconds),
            ]);
        }
        write!(f, "{table}")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn loops_frames_and_strips_on_edge_agree_with_theory() {
        assert!((heart(20.0).unwrap() / reference::heart_loop(20.0).value - 1.0).abs() < 2e-3);
        assert!((frame(Models::DEFAULT, 30.0).unwrap() - 1.0).abs() < 1e-3);
        // The theory is of narrow strips; this one is a tenth as wide as long.
        assert!((buckling(Models::DEFAULT).unwrap() / reference::lateral_buckling(0.0) - 1.0).abs() < 0.08);
    }

    #[test]
    fn a_plate_swings_with_its_period() {
        let [period, kept] = swing(0).unwrap();
        assert!(
            (period / reference::plate_pendulum(FRAC_PI_3) - 1.0).abs() < 0.006 && (kept - 1.0).abs() < 1e-3
        );
    }

    #[test]
    fn stiffer_cloth_drapes_less() {
        let [soft, stiff] = [1e-5, 1e-3].map(|d| cusick(d).unwrap());
        assert!((0.3..0.8).contains(&soft) && stiff > 0.98, "{soft} {stiff}");
    }
}

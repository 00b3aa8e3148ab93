//! Extremes of contact, speed, size and arithmetic with solvers that step.

use std::time::Instant;

use super::strip::judged;
use super::{Check, Must, Verdict};
use toile_cloth::constraint::{Plane, Sphere};
use toile_cloth::energy::{Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::{Fabric, Rigidity};
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{CentralDifferences, ImplicitEuler, Model, Projective, Solver, State, Xpbd};

const DENSITY: f64 = 0.15;
const FRAME: f64 = 1.0 / 60.0;
/// The time of a step may grow with this power of the vertices.
const MOST_SLOPE: f64 = 1.2;
/// Bytes a vertex.
const MOST_MEMORY: f64 = 1024.0;
/// Small steps of which the fastest counts, for other work on the machine only slows: so many, but
/// for more than a second only the least.
const TIMED: usize = 60;
const LEAST_TIMED: usize = 5;

pub(super) fn checks(large: bool) -> Vec<Check> {
    let must = Must::Converge;
    let mut checks = Vec::new();
    for speed in [0.0, 1.0, 10.0, 100.0] {
        checks.push(Check::new("initial_speed", format!("{speed} m/s"), must, move || judged(thrown(speed))));
    }
    for mu in [0.0, 0.3, 1.0, 10.0] {
        checks.push(Check::new("friction", mu, must, move || judged(slide(mu))));
    }
    for threads in [1, 2, 5] {
        checks
            .push(Check::new("determinism", format!("{threads} threads"), must, move || same_bits(threads)));
    }
    let most = if large { 1000 } else { 100 };
    for across in [32, 100, 316, 1000].into_iter().filter(|&n| n <= most.max(100)) {
        checks.push(Check::new("vertices", (across + 1) * (across + 1), must, move || judged(sized(across))));
    }
    checks
}

fn fabric() -> Fabric {
    Fabric::isotropic(DENSITY, 500.0, 0.0, 1e-5)
}

fn cloth(sheet: &Sheet) -> Result<Model, ClothError> {
    Model::of(sheet).made_of(Models::DEFAULT, &Cloth::of(sheet, &[&fabric()]))
}

/// A square thrown at a ball: no vertex may get into it or past it, with any solver that knows
/// obstacles.
fn thrown(speed: f64) -> Result<(bool, String), ClothError> {
    let mesh = Rectangle::new(Layout::Alternating, 0.3, 0.3, 10);
    let sheet = mesh.sheet(DENSITY)?;
    let (centre, radius) = (Vec3::new(0.15, 0.15, -0.5), 0.3);
    let mut model = cloth(&sheet)?.under(Vec3::zeros());
    model.obstacles = vec![Box::new(Sphere::new(centre, radius, 0.3)?)];
    let solvers: [Box<dyn Solver>; 3] = [
        Box::new(CentralDifferences::adaptive(FRAME)),
        Box::new(Xpbd::new(&sheet, &fabric(), FRAME, 4)?),
        Box::new(Projective::new(&sheet, &model, 500.0, &Rigidity::of(&fabric()), FRAME, 4)?),
    ];
    let mut deepest = f64::INFINITY;
    for mut solver in solvers {
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
        state.v.fill(Vec3::new(0.0, 0.0, -speed));
        let end = if speed > 0.0 { 0.5 / speed } else { 0.1 };
        while state.time < end {
            solver.advance(&model, &mut state)?;
            let gap = state.x.iter().map(|x| (x - centre).norm() - radius).fold(f64::INFINITY, f64::min);
            deepest = deepest.min(if gap.is_nan() { f64::NEG_INFINITY } else { gap });
        }
    }
    Ok((deepest > -1e-9, format!("nearest {:.1e} m off the ball", deepest)))
}

/// A sheet sliding on a level floor: it must not gain energy, and with high friction stop.
fn slide(mu: f64) -> Result<(bool, String), ClothError> {
    let mesh = Rectangle::new(Layout::Alternating, 0.2, 0.2, 6);
    let sheet = mesh.sheet(DENSITY)?;
    let mut model = cloth(&sheet)?;
    model.obstacles = vec![Box::new(Plane::new(Vec3::zeros(), Vec3::y(), mu)?)];
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, 0.0, p.y)).collect());
    state.v.fill(Vec3::new(0.5, 0.0, 0.0));
    let mut solver = CentralDifferences::adaptive(1e-3);
    let first = model.total_energy(&state);
    let mut most = first;
    while state.time < 0.5 {
        solver.advance(&model, &mut state)?;
        most = most.max(model.total_energy(&state));
    }
    let (gain, speed) = (most - first, state.greatest_speed());
    // Coulomb: 0.5 m/s is gone after 0.5 / (mu g).
    let stops = mu >= 0.3;
    let right = if stops { speed < 1e-6 } else { (speed - 0.5).abs() < 1e-9 };
    Ok((gain <= 1e-6 && right, format!("energy gained {gain:.0e} J, speed at the end {speed:.0e} m/s")))
}

/// The state after some steps of two solvers, as bits.
fn stepped() -> Result<Vec<u64>, ClothError> {
    let mesh = Rectangle::new(Layout::Irregular(2), 0.5, 0.5, 24);
    let sheet = mesh.sheet(DENSITY)?;
    let model = cloth(&sheet)?.pinned(|v| mesh.at_top(v));
    let bump = |p: &nalgebra::Vector2<f64>| Vec3::new(p.x, p.y, 0.01 * (9.0 * p.y).sin());
    let mut state = State::at_rest(mesh.uv.iter().map(bump).collect());
    let (mut implicit, mut explicit) = (ImplicitEuler::new(0.01, 1e-8), CentralDifferences::adaptive(0.01));
    for _ in 0..3 {
        implicit.advance(&model, &mut state)?;
        explicit.advance(&model, &mut state)?;
    }
    Ok(state.x.iter().flat_map(|x| x.iter().map(|c| c.to_bits()).collect::<Vec<_>>()).collect())
}

fn same_bits(threads: usize) -> Verdict {
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else {
        return Verdict::Failed("no threads to be had".into());
    };
    match (stepped(), pool.install(stepped)) {
        (Ok(a), Ok(b)) if a == b => Verdict::Converged("the same bits".into()),
        (Err(e), _) | (_, Err(e)) => Verdict::Failed(e.to_string()),
        _ => Verdict::Failed("other bits".into()),
    }
}

/// Time and memory of small steps against those of a tenth as many vertices.
fn sized(across: usize) -> Result<(bool, String), ClothError> {
    let (small, _) = stepping(across * 10 / 32)?;
    let (time, memory) = stepping(across)?;
    let slope = (time / small).ln() / 10.24_f64.ln();
    let bytes = memory.map_or("not known here".into(), |b| format!("{b:.0} bytes a vertex"));
    let lean = memory.is_none_or(|b| b <= MOST_MEMORY);
    // Below ten thousand vertices caches and timers decide.
    let fair = across < 100 || (slope <= MOST_SLOPE && lean);
    Ok((fair, format!("{:.1} ms a small step, grows with n^{slope:.2}, {bytes}", 1e3 * time)))
}

/// Seconds a small step of XPBD, and what sheet, model and solver hold in memory a vertex.
fn stepping(across: usize) -> Result<(f64, Option<f64>), ClothError> {
    let before = resident();
    let mesh = Rectangle::new(Layout::Alternating, 1.0, 1.0, across);
    let sheet = mesh.sheet(DENSITY)?;
    let model = Model::of(&sheet).pinned(|v| mesh.at_top(v));
    let mut solver = Xpbd::new(&sheet, &fabric(), FRAME / 4.0, 1)?;
    let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
    let memory = before.zip(resident()).map(|(b, a)| (a - b).max(0.0) / mesh.uv.len() as f64);
    let (mut best, all) = (f64::INFINITY, Instant::now());
    for done in 0..TIMED {
        if done >= LEAST_TIMED && all.elapsed().as_secs_f64() > 1.0 {
            break;
        }
        let clock = Instant::now();
        solver.advance(&model, &mut state)?;
        best = best.min(clock.elapsed().as_secs_f64());
    }
    Ok((best, memory))
}

/// Bytes of this process in memory, where the system reports it.
fn resident() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|l| l.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kb| 1024.0 * kb)
}

//! E6: the swing of a hanging sheet and the tone of a drumhead, from steps in time; and the damping
//! that backward Euler adds.

use super::reference;
use toile_cloth::energy::{Cloth, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{CentralDifferences, ImplicitEuler, Model, Solver, State, Static, lowest_modes};

/// Greatest displacement of the motion, in lengths.
const AMPLITUDE: f64 = 1e-3;
/// Angle of motion in one step of backward Euler.
const PHASE_STEP: f64 = 0.05;
const WIDTH: f64 = 0.3;
/// Pre-strain of the drumhead.
const PRESTRAIN: f64 = 1e-3;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let (hanging, shape, exact) = hanging_sheet(models, layout, along)?;
    let mut parts = vec![("swing".into(), measured_omega(&hanging, &shape, exact)? / exact - 1.0)];
    parts.push(("damping".into(), damping(&hanging, &shape, exact)?));
    let (drum, shape, exact) = drumhead(models, layout, along.max(16))?;
    parts.push(("drumhead".into(), measured_omega(&drum, &shape, exact)? / exact - 1.0));
    Ok(parts)
}

/// A model at equilibrium and its slowest motion.
struct Shape {
    rest: Vec<Vec3>,
    mode: Vec<Vec3>,
}

/// L = 1, g = 1: the sheet, its slowest swing across its plane and the exact angular frequency.
fn hanging_sheet(models: Models, layout: Layout, along: usize) -> Result<(Model, Shape, f64), ClothError> {
    let mesh = Rectangle::new(layout, WIDTH, 1.0, along);
    let sheet = mesh.sheet(1.0)?;
    let mut model = Model::of(&sheet).pinned(|v| mesh.at_top(v)).under(Vec3::new(0.0, -1.0, 0.0));
    let fixed = model.fixed.clone();
    model = model
        .made_of(models, &Cloth::of(&sheet, &[&Fabric::isotropic(1.0, 2000.0, 0.0, 1e-5)]).holding(&fixed))?;
    let shape = shape(&model, mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(), |p| 1.0 - p.y)?;
    Ok((model, shape, reference::hanging_omega(1)))
}

/// A unit square stretched alike both ways, held on its border.
fn drumhead(models: Models, layout: Layout, along: usize) -> Result<(Model, Shape, f64), ClothError> {
    let mesh = Rectangle::new(layout, 1.0, 1.0, along);
    let sheet = mesh.sheet(1.0)?;
    let k = 1000.0;
    let mut model = Model::of(&sheet).pinned(|v| mesh.on_border(v)).under(Vec3::zeros());
    let fixed = model.fixed.clone();
    model = model
        .made_of(models, &Cloth::of(&sheet, &[&Fabric::isotropic(1.0, k, 0.0, 1e-9)]).holding(&fixed))?;
    let side = 1.0 + PRESTRAIN;
    let start = mesh.uv.iter().map(|p| Vec3::new(side * p.x, side * p.y, 0.0)).collect();
    let shape = shape(&model, start, |p| {
        let s = |t: f64| (std::f64::consts::PI * t / side).sin();
        s(p.x) * s(p.y)
    })?;
    // Tension and density of the stretched sheet.
    let (tension, density) = (k * PRESTRAIN / side, 1.0 / (side * side));
    let exact = 2.0 * std::f64::consts::PI * reference::membrane_frequency(1.0, 1.0, side, tension, density);
    Ok((model, shape, exact))
}

/// Equilibrium, then the slowest mode that moves like `across` along z.
fn shape(model: &Model, start: Vec<Vec3>, across: impl Fn(&Vec3) -> f64) -> Result<Shape, ClothError> {
    let mut state = State::at_rest(start);
    let weight: f64 = model.masses.iter().sum::<f64>() * model.gravity.norm().max(1.0);
    Static::to(1e-10 * weight).advance(model, &mut state)?;
    let modes = lowest_modes(model, &state.x, 4)?;
    let guess: Vec<Vec3> = state.x.iter().map(|p| Vec3::z() * across(p)).collect();
    let overlap = |m: &Vec<Vec3>| weighed(model, m, &guess).abs() / weighed(model, m, m).sqrt();
    let best = modes.into_iter().map(|m| m.1).max_by(|a, b| overlap(a).total_cmp(&overlap(b)));
    let mut mode = best.unwrap_or(guess);
    let largest = mode.iter().map(|m| m.norm()).fold(0.0, f64::max);
    mode.iter_mut().for_each(|m| *m *= AMPLITUDE / largest);
    Ok(Shape { rest: state.x, mode })
}

fn weighed(model: &Model, a: &[Vec3], b: &[Vec3]) -> f64 {
    (0..a.len()).filter(|&v| !model.fixed[v]).map(|v| model.masses[v] * a[v].dot(&b[v])).sum()
}

/// How much of the mode a state shows.
fn amplitude(model: &Model, shape: &Shape, x: &[Vec3]) -> f64 {
    let moved: Vec<Vec3> = x.iter().zip(&shape.rest).map(|(x, r)| x - r).collect();
    weighed(model, &moved, &shape.mode) / weighed(model, &shape.mode, &shape.mode)
}

/// Angular frequency by the zero crossings of two periods of central differences.
fn measured_omega(model: &Model, shape: &Shape, guess: f64) -> Result<f64, ClothError> {
    let mut state = State::at_rest(shape.rest.iter().zip(&shape.mode).map(|(r, m)| r + m).collect());
    let mut solver = CentralDifferences::adaptive(0.1 / guess);
    let mut crossings = Vec::new();
    let mut last = (0.0, 1.0);
    while crossings.len() < 5 && state.time < 30.0 / guess {
        solver.advance(model, &mut state)?;
        let now = (state.time, amplitude(model, shape, &state.x));
        if now.1 * last.1 < 0.0 {
            crossings.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
        }
        last = now;
    }
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(end)) if crossings.len() == 5 => Ok(4.0 * std::f64::consts::PI / (end - first)),
        _ => Ok(f64::NAN),
    }
}

/// Logarithmic loss of backward Euler over about one period against its own theory.
fn damping(model: &Model, shape: &Shape, omega: f64) -> Result<f64, ClothError> {
    let dt = PHASE_STEP / omega;
    let mut state = State::at_rest(shape.rest.iter().zip(&shape.mode).map(|(r, m)| r + m).collect());
    let weight: f64 = model.masses.iter().sum();
    let mut solver = ImplicitEuler::new(dt, 1e-6 * weight * AMPLITUDE);
    solver.newton.linear = toile_cloth::solver::LinearMethod::Cholesky;
    // Peaks of the decaying swing: the values where it turns, by a parabola through three samples.
    let mut samples = vec![1.0];
    for _ in 0..(2.2 * std::f64::consts::PI / PHASE_STEP) as usize {
        solver.advance(model, &mut state)?;
        samples.push(amplitude(model, shape, &state.x));
    }
    let peak = |w: &[f64]| {
        let (a, b) = (0.5 * (w[2] + w[0]) - w[1], 0.5 * (w[2] - w[0]));
        (w[1] - 0.25 * b * b / a).abs()
    };
    let turns: Vec<(usize, f64)> = samples
        .windows(3)
        .enumerate()
        .filter(|(_, w)| (w[1] - w[0]) * (w[2] - w[1]) < 0.0)
        .map(|(k, w)| (k, peak(w)))
        .collect();
    let Some([first, second]) = turns.windows(2).next().map(|w| [w[0], w[1]]) else { return Ok(f64::NAN) };
    let half_period = std::f64::consts::PI / omega * reference::backward_euler_period(omega, dt);
    let theory = reference::backward_euler_loss(omega, dt) * half_period / dt;
    Ok((first.1 / second.1).ln() / theory - 1.0)
}

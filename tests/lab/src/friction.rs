//! E5: when a belt slips round a drum, when a sheet slips on an incline, and how far it creeps
//! before.

use toile_cloth::constraint::{CylinderObstacle, Plane};
use toile_cloth::energy::{Cloth, DeadLoad, Models, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{CentralDifferences, Model, Solver, State};

const FRICTIONS: [f64; 3] = [0.1, 0.3, 0.5];
const RADIUS: f64 = 0.1;
/// Free legs below the drum's axis, in radii.
const LEG: f64 = 0.5;
/// Belt tension on the light side, N/m.
const LIGHT: f64 = 1.0;
/// Stretch stiffness, N/m: under 1 % strain at the greatest pull.
const STIFFNESS: f64 = 600.0;
const DENSITY: f64 = 0.2;
/// Share by which the pull rises in each trial.
const PULL_STEP: f64 = 1.0025;
/// A belt whose light end still moves this fast (m/s) after settling slips.
const SLIP_SPEED: f64 = 5e-5;

pub(super) fn errors(models: Models, layout: Layout, along: usize) -> Result<Vec<(String, f64)>, ClothError> {
    let mut parts = Vec::new();
    for mu in FRICTIONS {
        let wrap = std::f64::consts::PI * mu;
        parts.push((format!("belt {mu}"), slipping_pull(models, layout, along, mu)?.ln() / wrap - 1.0));
        let (slope, creep) = slipping_slope(models, layout, mu)?;
        parts.push((format!("incline {mu}"), slope / mu - 1.0));
        parts.push((format!("creep {mu} m/s"), creep));
    }
    Ok(parts)
}

/// Pull over light tension at which a weightless belt over half a drum begins to slip.
fn slipping_pull(models: Models, layout: Layout, along: usize, mu: f64) -> Result<f64, ClothError> {
    let arc = std::f64::consts::PI * RADIUS;
    let (length, leg) = (arc + 2.0 * LEG * RADIUS, LEG * RADIUS);
    let segments = (along as f64 * length / arc).round() as usize;
    let mesh = Rectangle::new(layout, length / segments as f64 * 2.0, length, segments);
    let sheet = mesh.sheet(DENSITY)?;
    let mut model = Model::of(&sheet).under(Vec3::zeros());
    model = model
        .with_membrane(models, &Cloth::of(&sheet, &[&Fabric::isotropic(DENSITY, STIFFNESS, 0.0, 0.0)]))?;
    model.obstacles = vec![Box::new(CylinderObstacle::new(Vec3::zeros(), RADIUS, mu)?)];
    model.drag = 300.0;
    let mut state = State::at_rest(mesh.uv.iter().map(|p| wrapped(p.x, p.y, leg, arc)).collect());
    let width = mesh.size.x;
    let mut pull = (0.95 * std::f64::consts::PI * mu).exp();
    model.energies.push(Box::new(DeadLoad { forces: vec![Vec3::zeros(); mesh.uv.len()] }));
    let mut solver = CentralDifferences::adaptive(1.0);
    for trial in 0..200 {
        let last = model.energies.len() - 1;
        model.energies[last] = Box::new(tensions(&mesh, LIGHT * width, LIGHT * width * pull));
        settle(&mut solver, &model, &mut state, if trial == 0 { 0.2 } else { 0.02 })?;
        let light_end = (0..mesh.uv.len()).find(|&v| mesh.at_bottom(v)).unwrap_or(0);
        if trial > 0 && state.v[light_end].norm() > SLIP_SPEED {
            return Ok(pull);
        }
        pull *= PULL_STEP;
    }
    Ok(f64::NAN)
}

/// A belt whose middle lies on the drum and whose legs hang straight.
fn wrapped(across: f64, along: f64, leg: f64, arc: f64) -> Vec3 {
    if along < leg {
        return Vec3::new(-RADIUS, along - leg, across);
    }
    if along > leg + arc {
        return Vec3::new(RADIUS, leg + arc - along, across);
    }
    let angle = (along - leg) / RADIUS;
    Vec3::new(-RADIUS * angle.cos(), RADIUS * angle.sin(), across)
}

fn tensions(mesh: &Rectangle, light: f64, heavy: f64) -> DeadLoad {
    let share = |at: &dyn Fn(usize) -> bool| {
        let ends: Vec<usize> = (0..mesh.uv.len()).filter(|&v| at(v)).collect();
        // End vertices at the corners stand for half as much width.
        let weight =
            |v: usize| if mesh.uv[v].x < 1e-9 || mesh.uv[v].x > mesh.size.x - 1e-9 { 0.5 } else { 1.0 };
        let sum: f64 = ends.iter().map(|&v| weight(v)).sum();
        ends.into_iter().map(move |v| (v, weight(v) / sum)).collect::<Vec<_>>()
    };
    let mut forces = vec![Vec3::zeros(); mesh.uv.len()];
    share(&|v| mesh.at_bottom(v)).into_iter().for_each(|(v, s)| forces[v].y = -s * light);
    share(&|v| mesh.at_top(v)).into_iter().for_each(|(v, s)| forces[v].y = -s * heavy);
    DeadLoad { forces }
}

fn settle(
    solver: &mut CentralDifferences,
    model: &Model,
    state: &mut State,
    seconds: f64,
) -> Result<(), ClothError> {
    let end = state.time + seconds;
    while state.time < end {
        solver.advance(model, state)?;
    }
    Ok(())
}

/// Tangent of the slope at which a sheet begins to slide, by bisection, and its speed of creep one
/// degree below.
fn slipping_slope(models: Models, layout: Layout, mu: f64) -> Result<(f64, f64), ClothError> {
    let mut failure = None;
    let mut slides = |degrees: f64| match slide(models, layout, mu, degrees.to_radians(), 0.2) {
        Ok(speed) => speed,
        Err(e) => {
            failure = Some(e);
            0.0
        }
    };
    let (mut low, mut high) = (0.0, 60.0);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        if slides(middle) > 1e-6 { high = middle } else { low = middle }
    }
    let creep = slides(mu.atan().to_degrees() - 1.0);
    match failure {
        Some(e) => Err(e),
        None => Ok(((0.5 * (low + high)).to_radians().tan(), creep)),
    }
}

/// Greatest speed after some seconds on an incline.
fn slide(models: Models, layout: Layout, mu: f64, slope: f64, seconds: f64) -> Result<f64, ClothError> {
    let mesh = Rectangle::new(layout, 0.1, 0.1, 4);
    let sheet = mesh.sheet(DENSITY)?;
    let normal = Vec3::new(-slope.sin(), slope.cos(), 0.0);
    let down = Vec3::new(-slope.cos(), -slope.sin(), 0.0);
    let mut model = Model::of(&sheet);
    model =
        model.with_membrane(models, &Cloth::of(&sheet, &[&Fabric::isotropic(DENSITY, 100.0, 0.0, 0.0)]))?;
    model.obstacles = vec![Box::new(Plane::new(Vec3::zeros(), normal, mu)?)];
    let mut state = State::at_rest(mesh.uv.iter().map(|p| down * p.y + Vec3::z() * p.x).collect());
    let mut solver = CentralDifferences::adaptive(1e-3);
    settle(&mut solver, &model, &mut state, seconds)?;
    Ok(state.greatest_speed())
}

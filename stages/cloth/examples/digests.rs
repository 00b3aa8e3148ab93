//! Solves scenes that between them use every force of the static solver, and prints the steps and a
//! digest of all bits of each answer: `digests [NAME]`. Two builds that print the same have done
//! the same.
#![allow(clippy::print_stdout)]
use nalgebra::Vector3;
use std::error::Error;
use std::ops::ControlFlow;
use toile_cloth::contact::body::Body;
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_cloth::scene::{Scene, generate};
use toile_cloth::statics::drive::live::Live;
use toile_cloth::statics::drive::solve::{Collider, Equilibrium, StaticEquilibrium, StaticsError};
use toile_cloth::stopper::Stopper;

type Solved = Result<Equilibrium, StaticsError>;

/// All bits of an equilibrium, as one number.
fn digest(state: &Equilibrium) -> u64 {
    let mut bits: Vec<u64> = Vec::new();
    let mut add = |v: &Vector3<f64>| bits.extend([v.x, v.y, v.z].map(f64::to_bits));
    state.positions.iter().chain(&state.slides).for_each(&mut add);
    state
        .friction_contacts
        .iter()
        .for_each(|c| [c.memory.anchor, c.slid, c.normal].iter().for_each(&mut add));
    bits.extend(state.friction_contacts.iter().map(|c| c.memory.load.to_bits()));
    bits.extend(state.folds.iter().chain(&state.offsets).map(|v| v.to_bits()));
    bits.extend([state.energy, state.residual, state.outcome.speed].map(f64::to_bits));
    bits.iter().fold(0xcbf2_9ce4_8422_2325, |d: u64, b| (d ^ b).wrapping_mul(0x0100_0000_01b3))
}

fn tell(name: &str, solved: Solved) -> Result<Equilibrium, StaticsError> {
    let state = match solved {
        Err(StaticsError::NotAtRest { state, .. } | StaticsError::Crossing { state, .. }) => *state,
        other => other?,
    };
    let steps: usize = state.levels.iter().map(|l| l.outcome.steps).sum();
    println!("{name:16} {:5} vertices {steps:4} steps {:016x}", state.positions.len(), digest(&state));
    Ok(state)
}

fn solve(settings: StaticEquilibrium, scene: &Scene) -> Solved {
    settings.solve(scene, &mut |_, _| ControlFlow::Continue(()))
}

/// A skirt with friction between its yarns, as solved, from there, and after changes of its fabric.
fn skirt(plain: StaticEquilibrium) -> Result<(), StaticsError> {
    let mut scene = generate::tube(18, 12);
    (scene.material.bending_friction_warp, scene.material.bending_friction_weft) = (3e-4, 3e-4);
    let first = tell("skirt", solve(plain, &scene))?;
    let worn = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
    let collider = worn.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
    let mut live = Live::new(plain, scene.clone(), collider, &first)?;
    for k in 1..=4 {
        live.change(|s| s.material.density *= 1.0 + 0.1 * f64::from(k))?;
        live.follow(2)?;
    }
    tell("skirt, changed", live.settle(&mut |_, _| ControlFlow::Continue(())))?;
    scene.positions.clone_from(&first.positions);
    scene.held = first.held();
    tell("skirt, from here", solve(StaticEquilibrium { from_here: true, ..plain }, &scene))?;
    Ok(())
}

/// A skirt sewn on lowered bodies, then pushed out by its own.
fn lifted(graded: StaticEquilibrium) -> Result<(), StaticsError> {
    let scene = generate::tube(12, 12);
    let solid = |lower: f64| {
        let down = |p: &Vector3<f64>| p - Vector3::y() * lower;
        scene.body.as_ref().map(|b| Body::new(b.vertices.iter().map(down).collect(), &b.triangles))
    };
    let (Some(low), Some(middle), Some(body)) = (solid(0.06), solid(0.03), solid(0.0)) else { return Ok(()) };
    let friction = scene.body.as_ref().map_or(0.0, |b| b.friction);
    let settings = StaticEquilibrium { sew_through: true, ..graded };
    let around: [&dyn CollisionSurface; 2] = [&low, &middle];
    let collider = Some(Collider { surface: &body, friction });
    let lifted = settings
        .solve_around(&scene, collider, &around, &Stopper::default(), &mut |_, _| ControlFlow::Continue(()));
    tell("lifted", lifted).map(drop)
}

fn main() -> Result<(), Box<dyn Error>> {
    let wanted = std::env::args().nth(1);
    let is_wanted = |name: &str| wanted.as_deref().is_none_or(|w| w == name);
    let plain = StaticEquilibrium::default();
    let graded = StaticEquilibrium { bending_continuation: true, ..plain };
    let block = |half: [f64; 3], turn, cells| {
        let [x, y, z] = half;
        generate::cover(generate::block([-x, -y, -z], [x, 0.0, z]), cells, turn)
    };
    for (name, settings, scene) in [
        ("hang", plain, generate::hang(16)),
        ("drape", plain, generate::drape(16)),
        ("drape, graded", graded, generate::drape(12)),
        ("table", plain, block([0.3, 0.5, 0.3], 0.5, 16)),
        ("blade", plain, block([0.001, 0.3, 0.6], 0.4, 16)),
        ("tube, graded", graded, generate::tube(12, 10)),
        ("stack", plain, generate::stack(3, 8)),
        ("one by one", plain, generate::stack(7, 5)),
        ("pleat", plain, generate::pleat(16, 10, 3)),
        ("gathered", plain, generate::gathered(16, 8, 1.6)),
        ("layered", plain, generate::layered(10, 10)),
    ] {
        if is_wanted(name) {
            tell(name, solve(settings, &scene))?;
        }
    }
    if is_wanted("skirt") {
        skirt(plain)?;
    }
    if is_wanted("lifted") {
        lifted(graded)?;
    }
    Ok(())
}

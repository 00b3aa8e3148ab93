//! Brings a scene file to rest and writes the result:
//! `scene SCENE.json RESULT.obj [--continuation] [--trace] [--jitter SEED]`; prints one line of
//! JSON.
#![allow(clippy::print_stdout, clippy::print_stderr)]
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use toile_cloth::scene;
use toile_cloth::statics::drive::solve::{Equilibrium, StaticEquilibrium, StaticsError};
use toile_cloth::statics::report::not_at_rest::unrest;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (Some(file), Some(out)) = (args.first(), args.get(1)) else {
        return Err("usage: scene SCENE.json RESULT.obj [--continuation] [--trace] [--jitter SEED]".into());
    };
    let trace = args.iter().any(|a| a == "--trace");
    let mut scene = scene::read(Path::new(file), &scene::Options::default())?.scene;
    if let Some(seed) = args.iter().position(|a| a == "--jitter").and_then(|k| args.get(k + 1)) {
        scene::generate::jitter(&mut scene, 1e-3, seed.parse()?);
    }
    let clock = Instant::now();
    let mut steps = 0;
    let solved = StaticEquilibrium {
        bending_continuation: args.iter().any(|a| a == "--continuation"),
        ..StaticEquilibrium::default()
    }
    .solve(&scene, &mut |level, _| {
        steps += 1;
        if trace {
            let o = &level.outcome;
            eprintln!(
                "{:6} {:3} dt {:.3} speed {:.2e} residual {:.2e} share {:.3}",
                level.nodes, o.steps, o.dt, o.speed, o.residual, o.share
            );
        }
        ControlFlow::Continue(())
    });
    let wall = clock.elapsed().as_secs_f64();
    let (state, error): (Equilibrium, Option<String>) = match solved {
        Ok(state) => (state, None),
        Err(StaticsError::NotAtRest { wanted, panel, state }) => {
            let why = unrest(&state, &panel, wanted);
            (*state, Some(why))
        }
        Err(error) => return Err(error.into()),
    };
    let levels: Vec<_> = state
        .levels
        .iter()
        .map(|l| serde_json::json!({"nodes": l.nodes, "sewing": l.sewing, "steps": l.outcome.steps, "s": (l.seconds * 1e4).round() / 1e4}))
        .collect();
    let line = serde_json::json!({
        "scene": scene.name, "wall_s": (wall * 1e4).round() / 1e4, "steps": steps, "speed_m_s": state.outcome.speed,
        "residual_n": state.residual, "joined_at_m": state.joined_at, "error": error, "levels": levels,
    });
    println!("{line}");
    Ok(toile_geometry::obj::write(Path::new(out), &state.positions, &scene.triangles)?)
}

//! Lets a stack of sheets come to rest on a ball and says where the time goes.
//!
//!     cargo run --release -p toile-cloth --example stack -- SHEETS CELLS SECONDS [STATE.obj] [--trace]

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use toile_cloth::scene::generate;
use toile_cloth::statics::drive::solve::{Equilibrium, LevelReport, StaticEquilibrium, StaticsError};

const USAGE: &str = "stack SHEETS CELLS SECONDS [STATE.obj] [--trace]";

fn main() -> Result<(), Box<dyn Error>> {
    let (options, words): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|a| a.starts_with("--"));
    let [sheets, cells, seconds, file @ ..] = &words[..] else { return Err(USAGE.into()) };
    let scene = generate::stack(sheets.parse()?, cells.parse()?);
    let settings =
        StaticEquilibrium { budget: Duration::from_secs(seconds.parse()?), ..StaticEquilibrium::default() };
    let (clock, trace, mut steps) = (Instant::now(), options.iter().any(|o| o == "--trace"), 0);
    let solved = settings.solve(&scene, &mut |level, _| {
        steps += 1;
        if trace {
            tell(clock, level);
        }
        ControlFlow::Continue(())
    });
    println!("{} vertices, {steps} steps, {:.2} s", scene.rest.len(), clock.elapsed().as_secs_f64());
    let state = found(solved)?;
    println!("residual {:.1e} N", state.residual);
    for level in &state.levels {
        println!("{level:?}");
    }
    if let Some(file) = file.first() {
        toile_geometry::obj::write(Path::new(file), &state.positions, &scene.triangles)?;
    }
    Ok(())
}

fn tell(clock: Instant, level: &LevelReport) {
    let o = &level.outcome;
    eprintln!(
        "{:8.2} s {:6} nodes, step {:3} of {:.3} s: {:.2e} m/s {:.2e} N share {:.3}",
        clock.elapsed().as_secs_f64(),
        level.nodes,
        o.steps,
        o.dt,
        o.speed,
        o.residual,
        o.share
    );
}

/// The state, at rest or not: then it says why.
fn found(solved: Result<Equilibrium, StaticsError>) -> Result<Equilibrium, StaticsError> {
    match solved {
        Err(error @ (StaticsError::NotAtRest { .. } | StaticsError::Crossing { .. })) => {
            println!("{error}");
            match error {
                StaticsError::NotAtRest { state, .. } | StaticsError::Crossing { state, .. } => Ok(*state),
                other => Err(other),
            }
        }
        Ok(_) => {
            println!("at rest");
            solved
        }
        Err(_) => solved,
    }
}

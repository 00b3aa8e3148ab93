//! Slides the fabric of a garment at rest and measures how many states a second follow:
//! `live [SCENE.json] [STATES]`. One core: `RAYON_NUM_THREADS=1`. Prints one line of JSON.
#![allow(clippy::print_stdout)]
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use toile_cloth::contact::body::Body;
use toile_cloth::fabric::{Curve, Fabric};
use toile_cloth::scene::{self, Scene};
use toile_cloth::statics::drive::live::Live;
use toile_cloth::statics::drive::solve::{Collider, StaticEquilibrium};

/// Newton's steps for each state.
const STEPS: usize = 2;

/// The fabric of a state: all values oscillate by half, each with its own period.
fn swung(cloth: &Fabric, t: f64) -> Fabric {
    let by = |pace: f64| 1.0 + 0.5 * (pace * t).sin();
    let stretch = cloth.stretch() * by(1.0);
    Fabric {
        density: cloth.density * by(1.3),
        warp: Curve::linear(stretch),
        weft: Curve::linear(stretch),
        shear: Curve::linear(0.1 * cloth.stretch() * by(0.7)),
        bending_warp: cloth.bending_warp * by(1.7),
        bending_weft: cloth.bending_weft * by(1.7),
        ..cloth.clone()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene: Scene = match args.first() {
        Some(file) => scene::read(Path::new(file), &scene::Options::default())?.scene,
        None => scene::generate::tube(22, 25),
    };
    let states: usize = args.get(1).map_or(Ok(120), |n| n.parse())?;
    let body = scene.body.as_ref().map(|b| (Body::new(b.vertices.clone(), &b.triangles), b.friction));
    let collider = body.as_ref().map(|(surface, friction)| Collider { surface, friction: *friction });
    let state = StaticEquilibrium::default().solve(&scene, &mut |_, _| ControlFlow::Continue(()))?;
    let (cloth, rub) = (scene.material.clone(), collider.map_or(0.0, |w| w.friction));
    let mut live = Live::new(StaticEquilibrium::default(), scene.clone(), collider, &state)?;
    let (mut slowest, mut residual, mut speed) = (0.0f64, 0.0f64, 0.0f64);
    let mut change = 0.0;
    let clock = Instant::now();
    for k in 0..states {
        let (frame, t) = (Instant::now(), k as f64 / 30.0);
        live.change(|s| {
            s.material = swung(&cloth, t);
            s.body.iter_mut().for_each(|b| b.friction = rub * (1.0 + 0.3 * t.sin()));
        })?;
        change += frame.elapsed().as_secs_f64();
        let outcome = live.follow(STEPS)?;
        (residual, speed) = (residual.max(outcome.residual), speed.max(outcome.speed));
        slowest = slowest.max(frame.elapsed().as_secs_f64());
    }
    let seconds = clock.elapsed().as_secs_f64();
    let settled = live.settle(&mut |_, _| ControlFlow::Continue(()))?;
    let report = &settled.levels[0];
    println!(
        "{}",
        serde_json::json!({
            "triangles": scene.triangles.len(), "states": states, "states_per_s": states as f64 / seconds, "slowest_s": slowest,
            "change_s": change / states as f64, "greatest_residual_n": residual, "greatest_speed_m_s": speed,
            "settled_in_steps": report.outcome.steps, "settled_in_s": report.seconds, "residual_n": settled.residual,
            "speed_m_s": settled.outcome.speed,
        })
    );
    Ok(())
}

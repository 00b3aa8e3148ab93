//! scratch
#![allow(clippy::print_stdout, clippy::print_stderr)]
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use toile_cloth::rest::solve::{Rest, RestError};
use toile_cloth::scene::{self, generate};

fn main() -> Result<(), Box<dyn Error>> {
    let a: Vec<String> = std::env::args().skip(1).collect();
    let (layers, cells): (usize, u32) = (a[0].parse()?, a[1].parse()?);
    let seconds: u64 = a[2].parse()?;
    let scene = generate::stack(layers, cells);
    let clock = Instant::now();
    let mut last = 0;
    let budget = std::time::Duration::from_secs(seconds);
    let solved = Rest {
        budget,
        coarsest: std::env::var("COARSEST").map_or(200, |v| v.parse().unwrap_or(200)),
        ..Rest::default()
    }
    .solve(&scene, &mut |l| {
        let o = &l.outcome;
        last += 1;
        if a.iter().any(|a| a == "--trace") {
            eprintln!(
                "{:7.2} {:6} {:3} dt {:.3} speed {:.2e} residual {:.2e} share {:.3}",
                std::fs::read_to_string("/proc/self/stat").map_or(0.0, |t| t
                    .split(' ')
                    .nth(13)
                    .map_or(0.0, |v| v.parse::<f64>().unwrap_or(0.0) * 0.01)),
                l.nodes,
                o.steps,
                o.dt,
                o.speed,
                o.residual,
                o.share
            );
        }
        ControlFlow::Continue(())
    });
    let wall = clock.elapsed().as_secs_f64();
    let (text, x) = match solved {
        Ok(s) => {
            for l in &s.levels {
                println!("  {:?}", l);
            }
            ("at rest".to_string(), Some(s.positions))
        }
        Err(RestError::NotAtRest { wanted, state }) => {
            (format!("{}", RestError::NotAtRest { wanted, state: state.clone() }), Some(state.positions))
        }
        Err(RestError::Crossing { pairs, state }) => (format!("{pairs} crossings"), Some(state.positions)),
        Err(RestError::Timeout { seconds, level, levels, positions }) => {
            (format!("timeout {seconds} level {level}/{levels}"), Some(positions))
        }
        Err(e) => (e.to_string(), None),
    };
    println!(
        "{layers} layers {cells} cells, {} vertices: {text}, {last} steps, {wall:.2} s",
        scene.rest.len()
    );
    if let (Some(x), Some(f)) = (x, a.get(3).filter(|f| !f.starts_with("--"))) {
        scene::write_obj(Path::new(f), &x, &scene.triangles)?;
    }
    Ok(())
}

//! Solves a scene file and writes the result: `scene SCENE.json RESULT.obj`.
#![allow(clippy::print_stdout)]
use std::error::Error;
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().collect();
    let [_, scene, out] = &args[..] else { return Err("usage: scene SCENE.json RESULT.obj".into()) };
    let scene = toile_cloth::scene::read(Path::new(scene))?;
    let clock = Instant::now();
    let rested = toile_cloth::rest::solve::solve(&scene)?;
    println!("{:.3} s {:?} {:?}", clock.elapsed().as_secs_f64(), rested.outcome, rested.levels);
    toile_cloth::scene::write_obj(Path::new(out), &rested.positions, &scene.triangles)?;
    Ok(())
}

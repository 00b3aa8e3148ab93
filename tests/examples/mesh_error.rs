//! What a mesh costs, and the error that is its own.
//!
//!     cargo run --release -p toile-tests --example mesh_error -- pipelines/vest.ron StaticEquilibrium "8 mm" [KEY=VALUE ...]
//!
//! Runs the pipeline up to the stage named second; then lays a grid of that fine edge over the same
//! outlines, carries the drape over, lets it settle straight, and prints how far the settled
//! garment is from the one it was carried from (mean, 95 %, worst, mm): the same state of rest on a
//! mesh without, or nearly without, error. Beside it: processor seconds up to that stage and of
//! that stage, triangles, and the outline's own errors.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toile_core::artifact::Garment;
use toile_core::{Cancel, Listener};
use toile_pipeline::{Override, Pipeline, load};
use toile_trade::measure::Bench;
use toile_trade::surface::{DrapedSurface, Spread, displacement, distance};

fn main() {
    let mut args = std::env::args().skip(1);
    let (file, until, fine) = (args.next().unwrap(), args.next().unwrap(), args.next().unwrap());
    let set: Vec<Override> = args.map(|s| s.parse().unwrap()).collect();
    let text = std::fs::read_to_string(&file).unwrap();
    let text = format!("{}{}", kept(&text), branch(&until, &fine));
    let pipeline = read(&file, &text, &set);
    let (own, cpu_s) = run(&pipeline, &until);
    let (settled, _) = run(&pipeline, "Settled");
    let area: f64 = own.panels.iter().map(|p| flat_area(&own, p.triangles.clone())).sum();
    println!("{:6} triangles, {cpu_s:6.2} s up to {until}, {:.2} cm2", own.triangles.len(), area * 1e4);
    let (own, settled) = (DrapedSurface::new(&own).unwrap(), DrapedSurface::new(&settled).unwrap());
    println!("distance     {}", mm(distance(&own, &settled)));
    println!("displacement {}", mm(displacement(&own, &settled)));
}

fn mm(s: Spread) -> String {
    format!("{:.2} / {:.2} / {:.2} mm", s.mean * 1e3, s.p95 * 1e3, s.max * 1e3)
}

fn flat_area(g: &Garment, triangles: std::ops::Range<usize>) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| g.rest[v as usize]);
        (b - a).perp(&(c - a)) / 2.0
    };
    g.triangles[triangles].iter().map(area).sum()
}

/// The pipeline's text up to its texturer.
fn kept(text: &str) -> &str {
    &text[..text.find("PhotoTexturer").unwrap()]
}

/// The same garment on a fine mesh, from where `until` left it.
fn branch(until: &str, fine: &str) -> String {
    format!(
        "GridMesher(id: \"Fine\", edge: \"{fine}\"), Transfer(id: \"Carried\", from: [\"Fine\", \"{until}\"]), \
         StaticEquilibrium(id: \"Settled\", from: \"Carried\", coarsest: 100000, steps: 2000)])"
    )
}

fn read(file: &str, text: &str, set: &[Override]) -> Pipeline {
    let registry = toile::registry();
    load(text, file, Path::new(file).parent().unwrap(), &registry, set).unwrap()
}

/// The garment that a stage gives, and the processor seconds up to it.
fn run(pipeline: &Pipeline, until: &str) -> (Garment, f64) {
    let listener: Arc<dyn Listener> = Arc::new(());
    let bench = Bench { until: Some(until.to_owned()), cancel: Cancel::new(), listener, apart: None };
    let ran = bench.run(pipeline, Some(Duration::from_secs(900)), None).unwrap();
    (ran.garment, ran.cpu_s)
}

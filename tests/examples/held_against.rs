//! How far garments of several pipelines lie from that of the first, and what each costs.
//!
//!     cargo run --release -p toile-tests --example held_against -- \
//!         pipelines/vest.ron Settle stages.Subdivide.parts=6 -- pipelines/vest.ron Settle -- my.ron Settle KEY=VALUE ...
//!
//! Each group between `--` is a pipeline's file, the stage up to which it runs, and changed values.
//! For every group after the first: triangles, processor seconds of the run, then distance and
//! displacement from the first's garment (mean, 95 %, worst, mm).
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toile_core::artifact::Garment;
use toile_core::{Cancel, Listener};
use toile_pipeline::{Override, load};
use toile_trade::measure::Bench;
use toile_trade::surface::{DrapedSurface, Spread, displacement, distance};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut groups = args.split(|a| a == "--");
    let (reference, cpu_s) = solve(groups.next().unwrap());
    println!("{:7} triangles, {cpu_s:6.2} s: the reference", reference.triangles.len());
    let reference = DrapedSurface::new(&reference).unwrap();
    for group in groups {
        let (garment, cpu_s) = solve(group);
        let own = DrapedSurface::new(&garment).unwrap();
        println!(
            "{:7} triangles, {cpu_s:6.2} s: distance {}, displacement {} mm: {}",
            garment.triangles.len(),
            mm(distance(&own, &reference)),
            mm(displacement(&own, &reference)),
            group.join(" ")
        );
    }
}

fn mm(s: Spread) -> String {
    format!("{:.2} / {:.2} / {:.2}", s.mean * 1e3, s.p95 * 1e3, s.max * 1e3)
}

/// The garment that a group's stage gives, and the processor seconds up to it.
fn solve(group: &[String]) -> (Garment, f64) {
    let (file, until) = (&group[0], &group[1]);
    let set: Vec<Override> = group[2..].iter().map(|s| s.parse().unwrap()).collect();
    let text = std::fs::read_to_string(file).unwrap();
    let pipeline = load(&text, file, Path::new(file).parent().unwrap(), &toile::registry(), &set).unwrap();
    let listener: Arc<dyn Listener> = Arc::new(());
    let bench = Bench { until: Some(until.clone()), cancel: Cancel::new(), listener, apart: None };
    let ran = bench.run(&pipeline, Some(Duration::from_secs(900)), None).unwrap();
    (ran.garment, ran.cpu_s)
}

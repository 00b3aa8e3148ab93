//! How far apart a garment comes to rest from starts that were moved by a hair.
//!
//!     cargo run --release -p toile-tests --example spread -- pipelines/vest.ron StaticEquilibrium 4 0.001,0.1,1 [KEY=VALUE ...]
//!
//! Solves up to the stage named second, from the pipeline's own start and from so many starts moved
//! by each of the amounts (mm, root mean square of a smooth field), and prints for each the
//! distance between the two garments (mean, 95 %, worst, mm) and the displacement of the same
//! points of cloth.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toile_core::artifact::Garment;
use toile_core::{Cancel, Length, Listener};
use toile_pipeline::{Override, Pipeline, load};
use toile_trade::measure::Bench;
use toile_trade::measure::jitter;
use toile_trade::surface::{DrapedSurface, displacement, distance};

fn main() {
    let mut args = std::env::args().skip(1);
    let (file, until) = (args.next().unwrap(), args.next().unwrap());
    let starts: u64 = args.next().unwrap().parse().unwrap();
    let amounts = args.next().unwrap();
    let set: Vec<Override> = args.map(|s| s.parse().unwrap()).collect();
    let solve = |moved: Option<(f64, u64)>| solve(&file, &set, &until, moved);
    let own = solve(None);
    for amount in amounts.split(',').map(|a| a.parse::<f64>().unwrap()) {
        for seed in 1..=starts {
            let moved = solve(Some((amount, seed)));
            tell(amount, seed, &moved, &own);
        }
    }
}

fn tell(amount: f64, seed: u64, moved: &Garment, own: &Garment) {
    let (moved, own) = (DrapedSurface::new(moved).unwrap(), DrapedSurface::new(own).unwrap());
    let mm = |s: toile_trade::surface::Spread| {
        format!("{:.2} / {:.2} / {:.2}", s.mean * 1e3, s.p95 * 1e3, s.max * 1e3)
    };
    let (apart, slid) = (mm(distance(&moved, &own)), mm(displacement(&moved, &own)));
    println!("moved by {amount} mm, start {seed}: distance {apart} mm, displacement {slid} mm");
}

fn solve(file: &str, set: &[Override], until: &str, moved: Option<(f64, u64)>) -> Garment {
    let registry = toile::registry();
    let base = Path::new(file).parent().unwrap();
    let text = std::fs::read_to_string(file).unwrap();
    let mut pipeline: Pipeline = load(&text, file, base, &registry, set).unwrap();
    if let Some((mm, seed)) = moved {
        jitter::insert(&mut pipeline, Length::mm(mm), seed).unwrap();
    }
    let listener: Arc<dyn Listener> = Arc::new(());
    let bench = Bench { until: Some(until.to_owned()), cancel: Cancel::new(), listener, apart: None };
    let ran = bench.run(&pipeline, Some(Duration::from_secs(600)), None).unwrap();
    println!("{:.2} s of processor time", ran.cpu_s);
    ran.garment
}

//! How far a garment moves as its mesh is refined, and where.
//!
//!     cargo run --release -p toile-tests --example meshes -- pipelines/vest.ron StaticEquilibrium stages.GridMesher.edge '"16 mm","11.3 mm","8 mm"' [KEY=VALUE ...]
//!
//! Solves up to the stage named second with each of the values, and prints for each and the one
//! before the distance and displacement (mean, 95 %, worst, mm), then by squares of the flat
//! panels, 5 cm wide, the mean displacement (x, y, z, mm).
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toile_core::artifact::Garment;
use toile_core::{Cancel, Listener};
use toile_pipeline::{Override, Pipeline, load};
use toile_trade::measure::Bench;
use toile_trade::surface::{DrapedSurface, Spread, displacement, distance, pairs};

fn main() {
    let mut args = std::env::args().skip(1);
    let (file, until, key) = (args.next().unwrap(), args.next().unwrap(), args.next().unwrap());
    let values = args.next().unwrap();
    let set: Vec<String> = args.collect();
    let mut last: Option<(String, Garment)> = None;
    for value in values.split(',') {
        let all = set.iter().cloned().chain([format!("{key}={value}")]).map(|s| s.parse().unwrap()).collect();
        let now = solve(&file, all, &until);
        if let Some((name, was)) = &last {
            println!("{name} to {value}");
            tell(&DrapedSurface::new(was).unwrap(), &DrapedSurface::new(&now).unwrap());
        }
        last = Some((value.to_owned(), now));
    }
}

fn tell(was: &DrapedSurface<'_>, now: &DrapedSurface<'_>) {
    let mm = |s: Spread| format!("{:.2} / {:.2} / {:.2}", s.mean * 1e3, s.p95 * 1e3, s.max * 1e3);
    println!("distance {} mm, displacement {} mm", mm(distance(was, now)), mm(displacement(was, now)));
    let mut squares: BTreeMap<(usize, i64, i64), (f64, [f64; 3])> = BTreeMap::new();
    for (of_was, of_now) in pairs(was, now) {
        let Some((panel, at)) = was.flat_place(&of_was) else { continue };
        let square =
            squares.entry((panel, (at.y / 0.05).floor() as i64, (at.x / 0.05).floor() as i64)).or_default();
        let moved = now.place(&of_now) - was.place(&of_was);
        square.0 += 1.0;
        (0..3).for_each(|k| square.1[k] += moved[k] * 1e3);
    }
    for ((panel, row, column), (count, sum)) in squares {
        let mean = sum.map(|s| format!("{:6.1}", s / count)).join(" ");
        println!("panel {panel}, y {:4} cm, x {:4} cm: {mean}", row * 5, column * 5);
    }
}

fn solve(file: &str, set: Vec<Override>, until: &str) -> Garment {
    let text = std::fs::read_to_string(file).unwrap();
    let base = Path::new(file).parent().unwrap();
    let pipeline: Pipeline = load(&text, file, base, &toile::registry(), &set).unwrap();
    let listener: Arc<dyn Listener> = Arc::new(());
    let bench = Bench { until: Some(until.to_owned()), cancel: Cancel::new(), listener, apart: None };
    let ran = bench.run(&pipeline, Some(Duration::from_secs(600)), None).unwrap();
    println!("{:.2} s of processor time", ran.cpu_s);
    ran.garment
}

//! What a loaded collider costs in the solver's inner loop, by pairs: the vest sewn and draped on
//! `SdfCollider`, in turn linked in and loaded, processor seconds of one thread. Linux.
//!
//!     RAYON_NUM_THREADS=1 cargo run --release -p toile-tests --example border -- 20
//!
//! Counted in instructions, which no other job on the machine can change:
//!
//!     perf stat -e instructions:u target/release/examples/border linked     (and: loaded)
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use toile_core::Registry;
use toile_pipeline::plugin::load_plugin;
use toile_tests::plugins::{library, vest_on_sdf};

/// Clock ticks a second in `/proc/self/stat`.
const TICKS: f64 = 100.0;

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    match asked.as_str() {
        "linked" => println!("{:.2} s", solve(&linked())),
        "loaded" => println!("{:.2} s", solve(&loaded())),
        pairs => by_pairs(pairs.parse().unwrap_or(10)),
    }
}

/// Prints every pair and the quartiles of their ratios.
fn by_pairs(pairs: usize) {
    let (linked, loaded) = (linked(), loaded());
    let pair = |i: usize| {
        // Each goes first every other time.
        let (a, b) = if i.is_multiple_of(2) {
            let a = solve(&linked);
            (a, solve(&loaded))
        } else {
            let b = solve(&loaded);
            (solve(&linked), b)
        };
        println!("linked {a:.2} s, loaded {b:.2} s: {:+.1} %", (b / a - 1.0) * 100.0);
        b / a - 1.0
    };
    let mut ratios: Vec<f64> = (0..pairs.max(1)).map(pair).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |q: f64| ratios[((ratios.len() - 1) as f64 * q).round() as usize] * 100.0;
    println!("loaded costs {:+.2} % more, quartiles {:+.2} % to {:+.2} %", at(0.5), at(0.25), at(0.75));
}

fn linked() -> Registry {
    let mut registry = toile::registry();
    toile_sdf::register(&mut registry);
    registry
}

fn loaded() -> Registry {
    let mut registry = toile::registry();
    load_plugin(&mut registry, &library("toile_sdf"), None).unwrap();
    registry
}

/// Processor seconds of the vest up to rest, with everything before it.
fn solve(registry: &Registry) -> f64 {
    let before = processor_s();
    vest_on_sdf(registry).unwrap();
    processor_s() - before
}

/// Processor seconds of this process so far.
fn processor_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let after_name = stat.rsplit(") ").next().unwrap();
    let ticks = |k: usize| after_name.split(' ').nth(k).unwrap().parse::<f64>().unwrap();
    (ticks(11) + ticks(12)) / TICKS
}

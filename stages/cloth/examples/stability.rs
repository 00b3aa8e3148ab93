//! Prints the extremes: `cargo run --release -p toile-cloth --example stability -- [axis ..] [--pairs] [--large] [--json]`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::ops::ControlFlow;

use toile_cloth::bench::stability::{Options, stability};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let has = |flag: &str| args.iter().any(|a| a == flag);
    let axes = args.iter().filter(|a| !a.starts_with("--")).cloned().collect();
    let options = Options { axes, pairs: has("--pairs"), large: has("--large") };
    let report = stability(&options, &mut |share, what| {
        eprintln!("{:3.0} % {what}", 100.0 * share);
        ControlFlow::Continue(())
    });
    if has("--json") { println!("{}", report.to_json()) } else { println!("{report}") }
}

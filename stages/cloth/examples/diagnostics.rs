//! Prints the solvers side by side, or the diagnostics: `cargo run --release -p toile-cloth --example diagnostics -- [--solvers] [--json]`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::ops::ControlFlow;

use toile_cloth::bench::{diagnostics, solvers, solvers::Way};

fn main() -> Result<(), toile_cloth::error::ClothError> {
    let has = |flag: &str| std::env::args().any(|a| a == flag);
    let mut tell = |share: f64, what: &str| {
        eprintln!("{:3.0} % {what}", 100.0 * share);
        ControlFlow::Continue(())
    };
    let (text, json) = if has("--solvers") {
        let report = solvers(&Way::ALL, &mut tell)?;
        (report.to_string(), report.to_json())
    } else {
        let report = diagnostics(&mut tell);
        (report.to_string(), report.to_json())
    };
    println!("{}", if has("--json") { json } else { text });
    Ok(())
}

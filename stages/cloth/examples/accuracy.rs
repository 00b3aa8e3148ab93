//! Prints the scoreboard: `cargo run --release -p toile-cloth --example accuracy [E1 ..]`.
#![allow(clippy::print_stdout)]

use toile_cloth::bench::{Layout, Models, Test, run};

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!("| test | models | mesh | along | error | worst part | s |");
    println!("|---|---|---|---|---|---|---|");
    for test in Test::ALL
        .into_iter()
        .filter(|t| wanted.is_empty() || wanted.iter().any(|w| t.label().starts_with(w.as_str())))
    {
        for models in &Models::ALL[..if std::env::var("ONE").is_ok() { 1 } else { 4 }] {
            for layout in Layout::ALL {
                for along in test.resolutions() {
                    print_row(test, *models, layout, along);
                }
            }
        }
    }
}

fn print_row(test: Test, models: Models, layout: Layout, along: usize) {
    let head = format!("| {} | {} | {} | {along}", test.label(), models.name(), layout.name());
    match run(test, models, layout, along) {
        Ok(score) => {
            let worst = score.parts.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let part = worst.map_or(String::new(), |p| format!("{} {:+.1e}", p.0, p.1));
            println!("{head} | {:.5} | {part} | {:.2} |", score.error(), score.seconds);
        }
        Err(e) => println!("{head} | - | {e} | |"),
    }
}

//! `toile` with one more stage.

use std::io::{stderr, stdout};
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut registry = toile::registry();
    toile_guided::register(&mut registry);
    ExitCode::from(toile::command_with(&registry, std::env::args_os(), &mut stdout(), &mut stderr()))
}

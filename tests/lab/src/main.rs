//! `toile-lab`. It holds no algorithm: see the library beside it.

use std::io::{stderr, stdout};
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(toile_lab::command(std::env::args_os(), &mut stdout(), &mut stderr()))
}

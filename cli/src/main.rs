//! `toile`, the command. It holds no algorithm: see the library beside it.

use std::io::{stderr, stdout};
use std::process::ExitCode;

/// Counts the memory that the program holds, for what stages take (docs/reference/costs.md).
#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

fn main() -> ExitCode {
    ExitCode::from(toile::program(&toile::registry(), std::env::args_os(), &mut stdout(), &mut stderr()))
}

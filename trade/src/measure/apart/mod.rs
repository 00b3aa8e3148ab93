//! Runs in processes of their own: memory is each run's own, and a run that the system ends takes
//! nothing else with it.
//!
//! The program starts itself once per run ([`Apart`]). The run's task goes in as one line of JSON;
//! what it made comes out as one line of JSON, followed by the artifacts as the cache stores them,
//! bit by bit. Clocks stand in the child, around the run alone, so that starting a program and
//! handing results over cost no run time. The child ends as soon as its input is closed, so that
//! none is left behind by a parent that is gone.
//!
//! - `wire`: task and answer; `parent`: starts, waits, ends; `child`: runs.
//!
//! Limit: a run may not be cut short by a stage's own clock better than by the end of its process;
//! nothing of it is kept then.

mod child;
mod parent;
#[cfg(test)]
mod tests;
mod wire;

pub use child::answer;
pub use parent::{ProcessEnd, end_in_words};
pub(crate) use wire::Task;

use std::ffi::OsString;
use std::path::PathBuf;

/// How the program starts itself for one run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Apart {
    /// The program.
    pub program: PathBuf,
    /// What stands before its arguments where another program runs it, like `-m toile`.
    pub launch: Vec<OsString>,
    /// Its arguments.
    pub arguments: Vec<OsString>,
}

impl Apart {
    /// This very program with arguments; none where the system does not say what it is.
    ///
    /// On Linux it is the file that runs, though another may have taken its name since.
    pub fn this_program(arguments: Vec<OsString>) -> Option<Self> {
        let own = PathBuf::from("/proc/self/exe");
        let program = if own.exists() { Some(own) } else { std::env::current_exe().ok() };
        program.map(|program| Apart { program, launch: Vec::new(), arguments })
    }
}

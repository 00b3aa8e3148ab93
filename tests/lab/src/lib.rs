//! How right the models are: six tests against exact references, on several meshes.
//!
//! The references are ordinary differential equations and series solved here, to far more digits
//! than any mesh reaches ([`mod@reference`]); nothing in them knows the engine. Each test gives one
//! error, so that models can be compared; see [`Score`].
//!
//! [`accuracy()`], [`solvers()`], [`diagnostics()`] and [`stability()`] run it all and give reports
//! that print as tables and turn into JSON.

pub mod accuracy;
mod cantilever;
mod catenary;
mod command;
pub mod diagnostics;
pub mod drivers;
mod dynamics;
pub mod factors;
mod friction;
pub mod libraries;
pub mod map;
mod plate;
pub mod reference;
mod score;
pub mod solvers;
pub mod stability;
mod stretch;
mod table;

#[cfg(test)]
mod stability_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod truth_tests;

use std::ops::ControlFlow;

pub use accuracy::accuracy;
pub use command::command;
pub use diagnostics::diagnostics;
pub use score::{Score, Test, run};
pub use solvers::solvers;
pub use stability::stability;
pub use toile_cloth::energy::{Bending, Membrane, Models};
pub use toile_cloth::solver::layout::Layout;

/// Called with how far a run is (0 to 1) and what comes next; may stop it there.
pub type Progress<'p> = dyn FnMut(f64, &str) -> ControlFlow<()> + 'p;

/// Exit codes of the program.
pub mod exit {
    /// Done.
    pub const DONE: u8 = 0;
    /// The arguments are wrong.
    pub const USAGE: u8 = 2;
    /// A run could not be made, or its files not be written.
    pub const INVALID: u8 = 3;
    /// A limit that binds is missed.
    pub const QUALITY: u8 = 4;
    /// Stopped.
    pub const STOPPED: u8 = 5;
}

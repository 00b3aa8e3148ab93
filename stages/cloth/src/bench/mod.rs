//! How right the models are: six tests against exact references, on several meshes.
//!
//! The references are ordinary differential equations and series solved here, to far more digits than any mesh reaches
//! ([`mod@reference`]); nothing in them knows the engine. Each test gives one error, so that models can be compared; see [`Score`].
//!
//! [`accuracy()`], [`solvers()`], [`diagnostics()`] and [`stability()`] run it all and give reports that print as tables and turn into JSON.

pub mod accuracy;
mod cantilever;
mod catenary;
pub mod diagnostics;
pub mod drivers;
mod dynamics;
mod friction;
pub mod layout;
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

use std::ops::ControlFlow;

pub use crate::energy::{Bending, Membrane, Models};
pub use accuracy::accuracy;
pub use diagnostics::diagnostics;
pub use layout::Layout;
pub use score::{Score, Test, run};
pub use solvers::solvers;
pub use stability::stability;

/// Hears how far a run is (0 to 1) and what comes next; may stop it there.
pub type Progress<'p> = dyn FnMut(f64, &str) -> ControlFlow<()> + 'p;

//! How right the models are: six tests against exact references, on several meshes.
//!
//! The references are ordinary differential equations and series solved here, to far more digits than any mesh reaches
//! ([`mod@reference`]); nothing in them knows the engine. Each test gives one error, so that models can be compared; see [`Score`].

mod cantilever;
mod catenary;
mod dynamics;
mod friction;
pub mod layout;
mod plate;
pub mod reference;
mod score;
pub mod stability;
mod stretch;

#[cfg(test)]
mod stability_tests;
#[cfg(test)]
mod tests;

pub use layout::Layout;
pub use score::{Bending, Membrane, Models, Score, Test, all, run};

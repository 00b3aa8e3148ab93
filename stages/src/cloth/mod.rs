//! The cloth engine that stitchers and drapers share.
//!
//! A garment becomes [`Cloth`]: nodes with lumped masses, and elements that pull on them. A
//! [`Simulation`] holds cloth, state, contacts and seams and advances them step by step with a
//! [`Solver`]; [`CentralDifferences`] is the one built in. Stages are thin wrappers that choose
//! settings and stop rules.
//!
//! ```text
//! check      law ── membrane ─┐
//!            hinge ───────────┼── cloth ── solver ────────┐
//!            frequency ───────┘                           ├── simulation ── rest ── stitch, drape
//!            seams, contact, pair, overstretch, skin ─────┘
//! ```

mod check;
mod contact;
mod frequency;
mod hinge;
mod law;
mod membrane;
mod model;
mod overstretch;
mod pair;
mod rest;
mod seams;
mod simulation;
mod skin;
mod solver;

#[cfg(test)]
pub(crate) mod fixtures;
#[cfg(test)]
mod tests;

pub use check::check_garment;
pub use contact::Contacts;
pub use hinge::Hinge;
pub use law::Law;
pub use membrane::{Material, Membrane};
pub use model::{Cloth, Edge, Softening, State};
pub use overstretch::limit_stretch;
pub use pair::SelfPairs;
pub use rest::Rest;
pub use seams::{SeamPull, Seams};
pub use simulation::{Settings, Simulation};
pub use solver::{CentralDifferences, Forces, Solver};

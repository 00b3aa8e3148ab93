//! Reports of the static solver: the equilibrium, or why there is none.
//!
//! Depends on all folders but `drive`.

pub(crate) mod equilibrium;
pub(crate) mod error;
pub(crate) mod intersecting;
pub(crate) mod load;
pub(crate) mod non_manifold;
pub mod not_at_rest;
pub mod start;
pub mod unbalanced;
pub(crate) mod words;

//! Newton's method on one level: linear problem, line search, active subset, and proof of rest.
//!
//! Depends on `forces`, `factor` and `levels`.

pub(crate) mod active_subset;
pub(crate) mod line_search;
pub(crate) mod linear;
pub(crate) mod nearby;
pub(crate) mod patience;
pub(crate) mod sequential_start;
pub(crate) mod settings;
pub(crate) mod state;
pub(crate) mod subdomain;
pub mod to_rest;

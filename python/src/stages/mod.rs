//! Functions of Python as stages.
//!
//! - `define`: a function with its card, made from its signature; `registry`: the built-in stages
//!   and those of Python; `python_stage`: a function behind the trait `Stage`; `parameter`: its
//!   parameters between RON and Python.

pub(crate) mod define;
mod parameter;
mod python_stage;
pub(crate) mod registry;

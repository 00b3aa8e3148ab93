//! The cloth engine: what a sheet of cloth resists (membranes, bending), what it touches (body,
//! itself), what sews it together (seams), and the solvers that bring it to rest.
//!
//! It knows neither stages nor pipelines: `toile-drape` wraps it. Everything is f64, in metres,
//! kilograms and seconds.

pub mod constraint;
pub mod contact;
pub mod energy;
pub mod error;
pub mod fabric;
pub mod linear;
pub mod mesh;
pub mod motion;
pub mod scene;
pub mod solver;
pub mod statics;
pub mod stopper;

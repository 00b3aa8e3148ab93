//! Artifacts as Python objects.
//!
//! - `artifact`: what all of them have; `garment`, `shapes`, `pictures`: kinds with arrays.
//! - `numbers`: arrays of Python as lists of Rust, checked; `show`: an artifact as the object of
//!   its kind; `take`: an object as an artifact.

pub(crate) mod artifact;
pub(crate) mod garment;
pub(crate) mod numbers;
pub(crate) mod pictures;
pub(crate) mod shapes;
pub(crate) mod show;
pub(crate) mod take;

//! Sparse Cholesky factorization of a symmetric matrix of 3 x 3 blocks: order of elimination,
//! fronts and dense products.
//!
//! Depends on no other folder.

pub(crate) mod dense;
pub(crate) mod front;
pub(crate) mod mixed;
pub mod multifrontal;
pub mod nested_dissection;
mod probe;
pub mod scalar;

pub use probe::probe;

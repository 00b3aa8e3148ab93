//! Sparse Cholesky factors of a symmetric matrix of 3 x 3 blocks: order, fronts, dense products.
//!
//! Depends on no other room.

pub(crate) mod dense;
pub(crate) mod front;
pub(crate) mod mixed;
pub mod multifrontal;
pub mod nested_dissection;
mod probe;
pub mod scalar;

pub use probe::probe;

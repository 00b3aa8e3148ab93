//! Sparse symmetric systems on the graph of a mesh: order of elimination, symbolic factor, factor,
//! solution.

mod cholesky;
mod dissection;
mod graph;
#[cfg(test)]
mod tests;
mod vectors;

pub(crate) use cholesky::{CholeskyFactor, block_slots, slot};
pub(crate) use dissection::elimination_order;
pub(crate) use graph::Graph;

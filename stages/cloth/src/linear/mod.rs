//! Linear algebra of the implicit solvers: a symmetric matrix of 3 x 3 blocks, its sparse Cholesky
//! factor, and preconditioned conjugate gradients.

mod block;
mod cholesky;
mod pattern;
mod pcg;
mod vectors;

#[cfg(test)]
mod tests;

pub use block::BlockMatrix;
pub use cholesky::Cholesky;
pub use pattern::{Pattern, Slot, add_at};
pub use pcg::{PcgReport, conjugate_gradients};
pub(crate) use vectors::leave_vectors;

pub use toile_geometry::Vec3;

//! Linear algebra of the implicit solvers: a symmetric matrix of 3 x 3 blocks, its sparse Cholesky factor, and preconditioned
//! conjugate gradients.

mod block;

#[cfg(test)]
mod tests;

pub use block::BlockMatrix;

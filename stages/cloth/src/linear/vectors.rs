//! Clears the state of wide vector registers.

use faer::ColRef;
use std::hint::black_box;

/// Clears the upper halves of the vector registers: call it after products and factors of `faer`.
///
/// The kernels of its products (`private-gemm-x86`, in assembler) leave them full. Until they are
/// clear each instruction on the lower halves waits for the one before, so that all that the thread
/// does next takes up to two and a half times as long. A sum of `faer`'s own clears them: the
/// compiler ends each function that has used wide registers so (`vzeroupper`).
pub(crate) fn leave_vectors() {
    black_box(ColRef::from_slice(black_box(&[0.0f64; 32])).sum());
}

//! What stands for the arithmetic of this machine.

use toile_core::artifact::Digester;

/// A word that two machines share where the solver's products and the C library's functions give
/// the same bits on both.
///
/// Equal code gives equal bits on machines of equal arithmetic, for any number of threads.
pub fn arithmetic() -> String {
    Digester::new().text("arithmetic").floats(toile_cloth::statics::factor::probe()).finish().short()
}

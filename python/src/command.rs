//! The command `toile`, as the package installs it.

use crate::stages::registry::registry;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::io::{stderr, stdout};

/// Runs the command with its arguments, the program's name first; `start` is how Python starts it
/// once more. Gives the exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>, start: Vec<OsString>) -> PyResult<u8> {
    let registry = registry(py)?;
    Ok(py.detach(|| toile::program_run_by(&start, &registry, arguments, &mut stdout(), &mut stderr())))
}

/// The version of the package.
#[pyfunction]
pub(crate) fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

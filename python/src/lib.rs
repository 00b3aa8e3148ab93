//! The compiled half of the Python package `toile`: runs, single stages, artifacts as arrays, and
//! stages in Python. The other half, in `package/toile`, gives it its Python face.
//!
//! - `run`: a pipeline; `alone`: one stage; `attend`: both on a thread of their own, so that the
//!   interpreter is free and Ctrl-C is heard.
//! - `artifacts/`: artifacts as Python objects, and back; `view` shows their memory.
//! - `given`: artifacts of Python in the place of a pipeline's readers.
//! - `settings`: values of settings and parameters; `stages/`: functions of Python as stages.
//! - `command`: the command `toile`; `error`: errors as exceptions.
//!
//! Everything runs behind the panic guard of the thread that it runs on: a panic becomes
//! `toile.InternalError`.

mod alone;
mod artifacts;
mod attend;
mod command;
mod error;
mod given;
mod run;
mod settings;
mod stages;
#[allow(unsafe_code)]
mod view;

/// Counts the memory that runs of the command hold, for what stages take.
#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

/// The compiled half of the package.
#[pyo3::pymodule]
mod _toile {
    #[pymodule_export]
    use crate::alone::{StageAlone, stage_names};
    #[pymodule_export]
    use crate::artifacts::artifact::PyArtifact;
    #[pymodule_export]
    use crate::artifacts::garment::{PyGarment, PyGarmentPanel};
    #[pymodule_export]
    use crate::artifacts::pictures::{PyMask, PyPhoto};
    #[pymodule_export]
    use crate::artifacts::shapes::{PyBody, PyOutline, PyPanel};
    #[pymodule_export]
    use crate::command::{command, version};
    #[pymodule_export]
    use crate::run::{RunParts, run, write};
    #[pymodule_export]
    use crate::settings::setting_words;
    #[pymodule_export]
    use crate::stages::define::define;

    #[pymodule_init]
    fn init() {
        toile_core::panics::quiet();
    }
}

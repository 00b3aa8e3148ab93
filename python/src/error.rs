//! Errors as exceptions: the classes are those of `package/toile/_errors.py`.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use toile::called::FailedCall;
use toile_core::{ErrorCode, StageError};
use toile_pipeline::{FaultRecord, Faults, RunError};

/// The word of an error in how a function was called; its exit code is that of wrong usage.
const USAGE: &str = "usage";

/// What an exception tells.
#[derive(Debug, Default)]
pub(crate) struct Told {
    pub(crate) code: String,
    pub(crate) exit_code: u8,
    pub(crate) message: String,
    pub(crate) help: Option<String>,
    pub(crate) place: Option<String>,
    pub(crate) stage: String,
    pub(crate) panel: String,
    pub(crate) detail: Option<String>,
    /// All faults of a file.
    pub(crate) faults: Vec<FaultRecord>,
}

impl Told {
    /// Of a stage's error.
    pub(crate) fn of(e: &StageError) -> Self {
        Told {
            code: e.code.as_str().to_owned(),
            exit_code: e.code.exit_code(),
            message: e.message.clone(),
            help: e.hint.clone(),
            detail: e.detail.clone(),
            ..Told::default()
        }
    }

    fn of_run(e: &RunError, faults: &Faults) -> Self {
        let records = faults.records();
        let place = records.first().filter(|_| !e.span.is_empty()).map(place);
        Told {
            place,
            stage: e.stage.clone(),
            panel: e.entry.clone(),
            message: e.to_string(),
            faults: records,
            ..Told::of(&e.error)
        }
    }

    fn of_file(faults: &Faults) -> Self {
        let records = faults.records();
        let first = records.first();
        Told {
            code: first.map_or_else(String::new, |f| f.code.to_owned()),
            exit_code: toile::exit::INVALID,
            message: first.map_or_else(String::new, |f| f.message.clone()),
            help: first.and_then(|f| f.hint.clone()),
            place: first.map(place),
            faults: records,
            ..Told::default()
        }
    }

    /// Of a call that failed.
    pub(crate) fn of_call(failed: &FailedCall) -> Self {
        match failed {
            FailedCall::File(faults) => Told::of_file(faults),
            FailedCall::Run(e, faults) => Told::of_run(e, faults),
            FailedCall::Given(e) => Told::of(e),
        }
    }

    /// As an exception.
    pub(crate) fn raised(self, py: Python<'_>) -> PyErr {
        self.exception(py).map_or_else(|e| e, PyErr::from_value)
    }

    fn exception<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let fields = PyDict::new(py);
        fields.set_item("code", &self.code)?;
        fields.set_item("exit_code", self.exit_code)?;
        fields.set_item("message", &self.message)?;
        fields.set_item("help", self.help.as_deref())?;
        fields.set_item("place", self.place.as_deref())?;
        fields.set_item("stage", &self.stage)?;
        fields.set_item("panel", &self.panel)?;
        fields.set_item("detail", self.detail.as_deref())?;
        fields.set_item("faults", serde_json::to_string(&self.faults).unwrap_or_default())?;
        py.import("toile._errors")?.getattr("raised")?.call((), Some(&fields))
    }
}

/// Where a fault is: `vest.ron:12:5`; of a setting, that setting.
fn place(fault: &FaultRecord) -> String {
    match fault.file.starts_with("--set ") {
        true => fault.file.clone(),
        false => format!("{}:{}:{}", fault.file, fault.line, fault.column),
    }
}

/// An exception that says how a function must be called.
pub(crate) fn misused(py: Python<'_>, message: impl Into<String>, help: Option<String>) -> PyErr {
    let (code, exit_code) = (USAGE.to_owned(), toile::exit::USAGE);
    Told { code, exit_code, message: message.into(), help, ..Told::default() }.raised(py)
}

/// A panic as an exception.
pub(crate) fn panicked(py: Python<'_>, words: &str) -> PyErr {
    let error =
        StageError::internal(format!("the program panicked: {words}")).hint(toile_core::panics::REPORT);
    Told::of(&error).raised(py)
}

/// A Python exception as a stage's error. One of `toile` keeps what it tells; of any other, the
/// traceback is the detail.
pub(crate) fn of_exception(py: Python<'_>, e: &PyErr) -> StageError {
    let value = e.value(py);
    let text = |name: &str| value.getattr(name).ok().and_then(|v| v.extract::<String>().ok());
    let known = text("code").and_then(|code| ErrorCode::named(&code));
    let error = match known {
        Some(code) => StageError::new(code, text("message").unwrap_or_default()),
        None => StageError::internal(format!("it raised {e}")),
    };
    let error = text("help").filter(|h| !h.is_empty()).into_iter().fold(error, StageError::hint);
    let trace = e.traceback(py).and_then(|t| t.format().ok());
    trace.into_iter().fold(error, StageError::detail)
}

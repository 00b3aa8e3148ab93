//! Why a request is refused.

use serde::Serialize;
use toile_pipeline::{Fault, Faults};

/// A fault of the project's text with its place, for programs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FaultPlace {
    /// The stable word: `unknown_stage`.
    pub code: String,
    /// One sentence.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Its first byte in the text.
    pub start: usize,
    /// The byte behind its last.
    pub end: usize,
}

impl FaultPlace {
    /// All of a load.
    pub(crate) fn all(faults: &Faults) -> Vec<FaultPlace> {
        let place = |(record, fault): (toile_pipeline::FaultRecord, &Fault)| {
            // What lies in an option has no place in the text.
            let span = fault.labels.first().filter(|_| fault.option.is_none()).map(|l| l.span.clone());
            let (line, column) = if fault.option.is_none() { (record.line, record.column) } else { (1, 1) };
            let span = span.unwrap_or(0..0);
            FaultPlace {
                code: record.code.to_owned(),
                message: record.message,
                hint: record.hint,
                line,
                column,
                start: span.start,
                end: span.end,
            }
        };
        faults.records().into_iter().zip(&faults.faults).map(place).collect()
    }
}

/// Why something was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StudioFault {
    /// The stable word: `stale`, `too_large`, `not_found`, ...
    pub code: &'static str,
    /// One sentence in lower case, without a full stop.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Faults that the text would have.
    pub faults: Vec<FaultPlace>,
}

impl StudioFault {
    pub(crate) fn new(code: &'static str, message: impl Into<String>) -> Self {
        StudioFault { code, message: message.into(), hint: None, faults: Vec::new() }
    }

    pub(crate) fn hint(self, hint: impl Into<String>) -> Self {
        StudioFault { hint: Some(hint.into()), ..self }
    }

    /// A request that is not what is asked for.
    pub(crate) fn malformed(message: impl Into<String>) -> Self {
        StudioFault::new("malformed", message)
    }

    /// Something that there is not.
    pub(crate) fn not_found(message: impl Into<String>) -> Self {
        StudioFault::new("not_found", message)
    }

    /// What the system says of a file.
    pub(crate) fn file(what: &str, path: &std::path::Path, e: &std::io::Error) -> Self {
        StudioFault::new("file", format!("cannot {what} \"{}\": {e}", path.display()))
    }

    /// The number of the answer over HTTP.
    pub(crate) fn status(&self) -> u16 {
        match self.code {
            "malformed" | "bad_name" => 400,
            "forbidden" => 403,
            "not_found" => 404,
            "no_method" => 405,
            "stale" | "exists" | "changed" => 409,
            "too_large" => 413,
            "file" | "internal" => 500,
            _ => 422,
        }
    }
}

impl std::fmt::Display for StudioFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for StudioFault {}

impl From<Box<Fault>> for StudioFault {
    fn from(fault: Box<Fault>) -> Self {
        StudioFault { hint: fault.hint, ..StudioFault::new(fault.code, fault.message) }
    }
}

impl From<Faults> for StudioFault {
    fn from(faults: Faults) -> Self {
        let places = FaultPlace::all(&faults);
        let first = places.first();
        StudioFault {
            code: "faults",
            message: first.map_or_else(String::new, |f| f.message.clone()),
            hint: first.and_then(|f| f.hint.clone()),
            faults: places,
        }
    }
}

//! Parameters of stages in Python, between RON and Python.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use toile_core::param::{Check, ron_options};
use toile_core::text::intern;
use toile_core::{ParamDoc, ParamType};

/// What a parameter may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ParameterKind {
    Number,
    WholeNumber,
    Truth,
    Text,
}

impl ParameterKind {
    /// The kind of a Python annotation.
    pub(super) fn of(annotation: &str) -> Option<Self> {
        match annotation {
            "float" => Some(ParameterKind::Number),
            "int" => Some(ParameterKind::WholeNumber),
            "bool" => Some(ParameterKind::Truth),
            "str" => Some(ParameterKind::Text),
            _ => None,
        }
    }

    /// Its table for cards and checks; `default` is RON.
    pub(super) fn doc(self, name: &str, default: String) -> ParamDoc {
        let (kind, check) = match self {
            ParameterKind::Number => (f64::describe(), Check::of::<f64>()),
            ParameterKind::WholeNumber => (i64::describe(), Check::of::<i64>()),
            ParameterKind::Truth => (bool::describe(), Check::of::<bool>()),
            ParameterKind::Text => (String::describe(), Check::of::<String>()),
        };
        ParamDoc {
            name: intern(name),
            doc: "",
            kind,
            unit: "",
            min: None,
            max: None,
            default,
            trades: false,
            finer: None,
            way: false,
            check,
        }
    }

    /// A RON value as Python's; none where it is none of this kind.
    pub(super) fn value(self, py: Python<'_>, ron: &str) -> Option<Py<PyAny>> {
        match self {
            ParameterKind::Number => read::<f64>(ron)?.into_py_any(py).ok(),
            ParameterKind::WholeNumber => read::<i64>(ron)?.into_py_any(py).ok(),
            ParameterKind::Truth => read::<bool>(ron)?.into_py_any(py).ok(),
            ParameterKind::Text => read::<String>(ron)?.into_py_any(py).ok(),
        }
    }

    /// A RON value in one form, so that equal values have equal text; none where it is none.
    pub(super) fn canonical(self, ron: &str) -> Option<String> {
        match self {
            ParameterKind::Number => read::<f64>(ron).map(|v| format!("{v:?}")),
            ParameterKind::WholeNumber => read::<i64>(ron).map(|v| v.to_string()),
            ParameterKind::Truth => read::<bool>(ron).map(|v| v.to_string()),
            ParameterKind::Text => read::<String>(ron).map(|v| format!("{v:?}")),
        }
    }
}

fn read<T: serde::de::DeserializeOwned>(ron: &str) -> Option<T> {
    ron_options().from_str(ron).ok()
}

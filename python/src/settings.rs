//! Values of Python as settings of a pipeline and parameters of stages.

use crate::error::misused;
use pyo3::prelude::*;
use toile::called::setting;
use toile_pipeline::Override;

/// Settings of Python: each a path and a value as JSON.
///
/// Errors: a value that no setting can have.
pub(crate) fn settings(py: Python<'_>, set: Vec<(String, String)>) -> PyResult<Vec<Override>> {
    let of = |(path, json): (String, String)| {
        let value = serde_json::from_str(&json).map_err(|e| e.to_string());
        value.and_then(|value| setting(&path, &value)).map_err(|why| misused(py, why, None))
    };
    set.into_iter().map(of).collect()
}

/// Settings as `--set` takes them: `stages.GridMesher.edge="6 mm"`.
#[pyfunction]
pub(crate) fn setting_words(py: Python<'_>, set: Vec<(String, String)>) -> PyResult<Vec<String>> {
    Ok(settings(py, set)?.into_iter().map(|o| format!("{}={}", o.path, o.value)).collect())
}

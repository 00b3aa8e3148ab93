//! The stages that runs of this process know: those that are built in, and those of Python.

use super::python_stage::PythonStageType;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use toile_core::Registry;
use toile_core::plugin::{Make, Plugin};

/// Stages of Python by name. A second of the same name takes the place of the first, as a cell of a
/// notebook that is run again.
static OF_PYTHON: Mutex<BTreeMap<&'static str, Arc<PythonStageType>>> = Mutex::new(BTreeMap::new());

/// The built-in stages.
pub(super) fn built_in() -> &'static Registry {
    static BUILT_IN: OnceLock<Registry> = OnceLock::new();
    BUILT_IN.get_or_init(toile::registry)
}

/// Adds a stage of Python.
pub(super) fn add(stage: PythonStageType) {
    let name = stage.card.name;
    OF_PYTHON.lock().unwrap_or_else(PoisonError::into_inner).insert(name, Arc::new(stage));
}

/// All stages.
pub(crate) fn registry(py: Python<'_>) -> PyResult<Registry> {
    let of_python: Vec<Arc<PythonStageType>> =
        py.detach(|| OF_PYTHON.lock().unwrap_or_else(PoisonError::into_inner).values().cloned().collect());
    let mut registry = built_in().clone();
    for stage in of_python {
        let Some(id) = stage.card.plugin else { continue };
        let file = PathBuf::from(id.name);
        let cards = vec![stage.card.clone()];
        let maker: Arc<dyn Make> = stage;
        let plugin = Plugin { id, file: file.clone(), abi: (0, 0), cards, makers: vec![maker] };
        let added = registry.add_plugin(&file, Ok(plugin));
        added.map_err(|refused| crate::error::misused(py, refused.reason, refused.hint))?;
    }
    Ok(registry)
}

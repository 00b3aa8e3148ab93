//! A pipeline, run for Python.

use crate::artifacts::show;
use crate::attend::attended;
use crate::error::{Told, misused};
use crate::given::Given;
use crate::settings::settings;
use crate::stages::registry::registry;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;
use toile::called::{CalledCache, CalledRun, RunCall};
use toile_core::artifact::{ArtifactType, Garment, Model, OutputFile};
use toile_core::{Artifact, PortValue};
use toile_pipeline::write_files;

/// What a run gives, as the class `Run` shows it.
#[pyclass(module = "toile", frozen)]
pub(crate) struct RunParts {
    called: CalledRun,
}

#[pymethods]
impl RunParts {
    /// The content of `metrics.json`.
    #[getter]
    fn metrics(&self) -> String {
        self.called.result.metrics.to_json()
    }

    /// Warnings about the pipeline, the threads and the cache.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.called.warnings.clone()
    }

    /// The files of the writers: paths and bytes.
    #[getter]
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for file in &self.called.result.files {
            dict.set_item(&file.path, PyBytes::new(py, &file.bytes))?;
        }
        Ok(dict)
    }

    /// What each stage made, by its id: of several outputs a tuple.
    #[getter]
    fn artifacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for record in &self.called.result.log.stages {
            let shown: Vec<_> = record.outputs.iter().map(|v| show::port(py, v)).collect::<PyResult<_>>()?;
            match shown.as_slice() {
                [] => {}
                [one] => dict.set_item(&record.id, one)?,
                _ => dict.set_item(&record.id, PyTuple::new(py, &shown)?)?,
            }
        }
        Ok(dict)
    }

    /// The last garment.
    #[getter]
    fn garment<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.last::<Garment>().map(|garment| show::shown(py, garment)).transpose()
    }

    /// The last textured model.
    #[getter]
    fn model<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.last::<Model>().map(|model| show::shown(py, model)).transpose()
    }
}

impl RunParts {
    /// The last artifact of a kind.
    fn last<T: ArtifactType>(&self) -> Option<&Arc<dyn Artifact>> {
        let outputs = self.called.result.log.stages.iter().rev().flat_map(|r| &r.outputs);
        outputs.filter(|v| v.kind() == T::KIND).find_map(|v| match v {
            PortValue::One(artifact) => Some(artifact),
            PortValue::Set(..) => None,
        })
    }
}

/// Runs a pipeline. `set` holds paths with values as JSON, `progress` takes stage, entry, share and
/// text.
#[pyfunction]
#[pyo3(signature = (pipeline, *, quality, set, until, also, keep, threads, cache, cache_dir, out, plugins, photos, body, progress))]
// Each is an argument of Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn run(
    py: Python<'_>,
    pipeline: PathBuf,
    quality: Option<String>,
    set: Vec<(String, String)>,
    until: Option<String>,
    also: Vec<String>,
    keep: bool,
    threads: Option<u16>,
    cache: bool,
    cache_dir: Option<PathBuf>,
    out: Option<PathBuf>,
    plugins: Vec<PathBuf>,
    photos: Option<Bound<'_, PyDict>>,
    body: Option<Bound<'_, PyAny>>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<RunParts> {
    if threads == Some(0) {
        return Err(misused(py, "`threads` must be at least 1", None));
    }
    let given = Given::of(photos.as_ref(), body.as_ref())?;
    let cache = match (cache, cache_dir) {
        (false, _) => CalledCache::Off,
        (true, Some(folder)) => CalledCache::At(folder),
        (true, None) => CalledCache::Usual,
    };
    let load = vec![Garment::KIND, Model::KIND];
    let set = settings(py, set)?;
    let call = RunCall { pipeline, quality, set, until, also, keep, threads, cache, out, load, plugins };
    let registry = registry(py)?;
    let work = move |cancel, listener| {
        toile::called::run(&call, &registry, |pipeline| given.put_into(pipeline), &cancel, &listener)
    };
    let called = attended(py, progress.as_ref(), work)?;
    called.map(|called| RunParts { called }).map_err(|failed| Told::of_call(&failed).raised(py))
}

/// Writes files below a folder, all or none.
#[pyfunction]
pub(crate) fn write(
    py: Python<'_>,
    folder: PathBuf,
    files: Vec<(String, Vec<u8>)>,
) -> PyResult<Vec<PathBuf>> {
    let files: Vec<OutputFile> = files.into_iter().map(|(path, bytes)| OutputFile { path, bytes }).collect();
    py.detach(|| write_files(&folder, &files)).map_err(|e| Told::of(&e).raised(py))
}

//! What every artifact has.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::any::Any;
use std::sync::Arc;
use toile_core::artifact::{Artifact, ArtifactType, Digester};

/// A value that one stage makes and others read. It does not change.
#[pyclass(name = "Artifact", module = "toile", frozen, subclass)]
pub(crate) struct PyArtifact {
    pub(crate) value: Arc<dyn Artifact>,
}

#[pymethods]
impl PyArtifact {
    /// Its kind: `garment`, `photo`, `mask`, ...
    #[getter]
    fn kind(&self) -> &'static str {
        self.value.kind().0
    }

    /// The BLAKE3 digest of its content, in hexadecimal: equal for equal bits.
    #[getter]
    fn digest(&self, py: Python<'_>) -> String {
        py.detach(|| {
            let mut d = Digester::new();
            self.value.digest(&mut d);
            d.finish().hex()
        })
    }

    /// Its figures by name, each a number with its unit.
    #[getter]
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let measures = py.detach(|| self.value.measures());
        let dict = PyDict::new(py);
        for m in &measures.0 {
            dict.set_item(&m.name, (m.value, m.unit))?;
        }
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        format!("<toile {}>", self.value.kind())
    }
}

/// An artifact as its own type.
pub(crate) fn typed<T: ArtifactType>(value: &Arc<dyn Artifact>) -> Option<Arc<T>> {
    let any: Arc<dyn Any + Send + Sync> = value.clone();
    any.downcast().ok()
}

/// What makes an object of a kind's class: the artifact, and the same by its type.
pub(crate) fn initial<C>(value: Arc<dyn Artifact>, own: C) -> PyClassInitializer<C>
where
    C: PyClass<BaseType = PyArtifact>,
{
    PyClassInitializer::from(PyArtifact { value }).add_subclass(own)
}

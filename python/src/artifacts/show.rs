//! Artifacts as the Python objects of their kinds.

use super::artifact::{PyArtifact, initial, typed};
use super::garment::PyGarment;
use super::pictures::{PyMask, PyPhoto};
use super::shapes::{PyBody, PyOutline, PyPanel};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::Arc;
use toile_core::PortValue;
use toile_core::artifact::{Artifact, OutputFiles};

/// An artifact as an object of its kind's class; of one without a class of its own, as an
/// `Artifact`, and files as a dictionary of paths and bytes.
pub(crate) fn shown<'py>(py: Python<'py>, value: &Arc<dyn Artifact>) -> PyResult<Bound<'py, PyAny>> {
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyGarment { of }))?.into_any());
    }
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyPhoto { of }))?.into_any());
    }
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyMask { of }))?.into_any());
    }
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyBody { of }))?.into_any());
    }
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyOutline { of }))?.into_any());
    }
    if let Some(of) = typed(value) {
        return Ok(Bound::new(py, initial(value.clone(), PyPanel { of }))?.into_any());
    }
    if let Some(files) = typed::<OutputFiles>(value) {
        let dict = PyDict::new(py);
        for file in &files.0 {
            dict.set_item(&file.path, PyBytes::new(py, &file.bytes))?;
        }
        return Ok(dict.into_any());
    }
    Ok(Bound::new(py, PyArtifact { value: value.clone() })?.into_any())
}

/// The value of a port: one object, or a dictionary of names and objects.
pub(crate) fn port<'py>(py: Python<'py>, value: &PortValue) -> PyResult<Bound<'py, PyAny>> {
    match value {
        PortValue::One(artifact) => shown(py, artifact),
        PortValue::Set(_, set) => {
            let dict = PyDict::new(py);
            for (name, artifact) in set {
                dict.set_item(name, shown(py, artifact)?)?;
            }
            Ok(dict.into_any())
        }
    }
}

//! Python objects as artifacts.

use super::artifact::PyArtifact;
use super::pictures::{mask_of, photo_of};
use super::shapes::mesh;
use crate::error::misused;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{Artifact, ArtifactType, Body, Kind, Mask, Photo};
use toile_core::{Arity, InPort, PortValue};

/// An object as an artifact of a kind: an artifact, or an array where the kind is made of one.
pub(crate) fn artifact(value: &Bound<'_, PyAny>, kind: Kind, name: &str) -> PyResult<Arc<dyn Artifact>> {
    let py = value.py();
    if let Ok(given) = value.cast::<PyArtifact>() {
        let given = given.get().value.clone();
        return match given.kind() == kind {
            true => Ok(given),
            false => Err(misused(py, format!("`{name}` takes a {kind}, found a {}", given.kind()), None)),
        };
    }
    let made: Arc<dyn Artifact> = match kind {
        Photo::KIND => Arc::new(photo_of(value, name)?),
        Mask::KIND => Arc::new(mask_of(value, name)?),
        Body::KIND => match value.cast::<PyTuple>() {
            Ok(pair) if pair.len() == 2 => Arc::new(mesh(&pair.get_item(0)?, &pair.get_item(1)?)?),
            _ => {
                return Err(misused(
                    py,
                    format!("`{name}` takes a body, or its (vertices, triangles)"),
                    None,
                ));
            }
        },
        _ => {
            let found = value.get_type().name()?.to_string();
            let help = format!(
                "a {kind} is what a stage gives: take it from a run's `artifacts`, or run that stage"
            );
            return Err(misused(py, format!("`{name}` takes a {kind}, found {found}"), Some(help)));
        }
    };
    made.check().map_err(|why| misused(py, format!("`{name}`: {why}"), None))?;
    Ok(made)
}

/// What feeds a port: a set of names where a dictionary is given.
pub(crate) fn port(value: &Bound<'_, PyAny>, port: &InPort) -> PyResult<PortValue> {
    let py = value.py();
    match (value.cast::<PyDict>(), port.arity) {
        (Ok(_), Arity::One) => {
            Err(misused(py, format!("`{}` takes one {}, found a dictionary", port.name, port.kind), None))
        }
        (Ok(set), _) => {
            let mut values: BTreeMap<String, Arc<dyn Artifact>> = BTreeMap::new();
            for (name, value) in set {
                values.insert(name.extract()?, artifact(&value, port.kind, port.name)?);
            }
            Ok(PortValue::Set(port.kind, values))
        }
        (Err(_), Arity::All) => {
            let message = format!("`{}` takes a dictionary of names and {}s", port.name, port.kind);
            Err(misused(py, message, None))
        }
        (Err(_), _) => Ok(PortValue::One(artifact(value, port.kind, port.name)?)),
    }
}

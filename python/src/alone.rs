//! One stage without a pipeline.

use crate::artifacts::{show, take};
use crate::attend::attended;
use crate::error::{Told, misused};
use crate::settings::settings;
use crate::stages::registry::registry;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toile_core::{Cancel, Card, Context, Inputs, Kind, Listener, PortValue, Registry, Stage, StageError};

/// A stage with its parameters, to be called with what its ports take.
#[pyclass(name = "StageAlone", module = "toile", frozen)]
pub(crate) struct StageAlone {
    card: Card,
    stage: Arc<dyn Stage>,
}

#[pymethods]
impl StageAlone {
    /// The stage of that name; parameters are names and values as JSON.
    #[new]
    fn new(py: Python<'_>, name: &str, parameters: Vec<(String, String)>) -> PyResult<Self> {
        let registry = registry(py)?;
        let card = card(&registry, name).map_err(|(message, help)| misused(py, message, help))?;
        let mut arguments = Vec::new();
        let texts: Vec<Option<String>> =
            parameters.iter().map(|(_, json)| serde_json::from_str(json).ok()).collect();
        for (mut given, text) in settings(py, parameters)?.into_iter().zip(texts) {
            let param = card.params.iter().find(|p| p.name == given.path);
            let Some(param) = param else {
                let names: Vec<&str> = card.params.iter().map(|p| p.name).collect();
                let help = toile_core::hint(&given.path, &format!("`{name}` has"), &names);
                return Err(misused(py, format!("unknown parameter `{}`", given.path), help));
            };
            let checked = param.check.run(&given.value, param);
            // Where a text is wanted, one that would be a name or a number in RON is a text.
            if let (true, Some(text)) = (checked.is_err(), text) {
                given.value = format!("{text:?}");
            }
            param
                .check
                .run(&given.value, param)
                .or(checked)
                .map_err(|fault| misused(py, fault.message, fault.hint))?;
            arguments.push(format!("{}: {}", given.path, given.value));
        }
        let made = registry.make(&card, &format!("({})", arguments.join(", ")));
        let stage = made.map_err(|why| misused(py, format!("`{name}` cannot be made: {why}"), None))?;
        Ok(StageAlone { card, stage: Arc::from(stage) })
    }

    /// Its parameters, as a pipeline file writes them.
    #[getter]
    fn parameters(&self) -> String {
        self.stage.params()
    }

    /// The names of its ports with their kinds, in the order in which they are called with.
    #[getter]
    fn ports(&self) -> Vec<(&'static str, &'static str)> {
        self.card.inputs.iter().map(|p| (p.name, p.kind.0)).collect()
    }

    /// Runs it: what its ports take in their order, or by name.
    #[pyo3(signature = (*inputs, **named))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        inputs: &Bound<'py, PyTuple>,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let fed = self.fed(inputs, named)?;
        let jobs = match self.card.is_mapped() {
            true => jobs(fed).map_err(|why| misused(py, why, None))?,
            false => Jobs::Once(Inputs(fed)),
        };
        let (stage, name) = (self.stage.clone(), self.card.name);
        let work = move |cancel: Cancel, listener: Arc<dyn Listener>| {
            let cx = Context::new(name, Path::new("."), cancel, listener);
            let made = made(stage.as_ref(), &jobs, &cx);
            (made, cx.take_remarks().warnings)
        };
        let (made, warnings) = attended(py, None, work)?;
        for warning in warnings {
            py.import("warnings")?.call_method1("warn", (format!("{name}: {warning}"),))?;
        }
        let made = made.map_err(|e| Told::of(&e).raised(py))?;
        let shown = made.iter().map(|v| show::port(py, v)).collect::<PyResult<Vec<_>>>()?;
        match <[_; 1]>::try_from(shown) {
            Ok([one]) => Ok(one),
            Err(several) => Ok(PyTuple::new(py, several)?.into_any()),
        }
    }

    fn __repr__(&self) -> String {
        format!("<toile stage {}{}>", self.card.name, self.stage.params())
    }
}

impl StageAlone {
    fn fed(
        &self,
        inputs: &Bound<'_, PyTuple>,
        named: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Vec<Option<PortValue>>> {
        let (py, name, ports) = (inputs.py(), self.card.name, &self.card.inputs);
        if inputs.len() > ports.len() {
            let message = format!("`{name}` takes {} inputs, found {}", ports.len(), inputs.len());
            return Err(misused(py, message, None));
        }
        let mut fed: Vec<Option<PortValue>> = Vec::new();
        for (i, port) in ports.iter().enumerate() {
            let by_name = named.map(|n| n.get_item(port.name)).transpose()?.flatten();
            let value = inputs.get_item(i).ok().or(by_name).filter(|v| !v.is_none());
            if value.is_none() && !port.optional {
                return Err(misused(py, format!("`{name}` needs a {}: `{}`", port.kind, port.name), None));
            }
            fed.push(value.map(|v| take::port(&v, port)).transpose()?);
        }
        for key in named.into_iter().flat_map(|n| n.keys()) {
            let key: String = key.extract()?;
            if ports.iter().all(|p| p.name != key) {
                let names: Vec<&str> = ports.iter().map(|p| p.name).collect();
                let help = toile_core::hint(&key, &format!("`{name}` takes"), &names);
                return Err(misused(py, format!("unknown input `{key}`"), help));
            }
        }
        Ok(fed)
    }
}

/// The names of all stages.
#[pyfunction]
pub(crate) fn stage_names(py: Python<'_>) -> PyResult<Vec<&'static str>> {
    Ok(registry(py)?.cards().map(|card| card.name).collect())
}

/// The card of that name, or what is wrong with the name and what may help.
fn card(registry: &Registry, name: &str) -> Result<Card, (String, Option<String>)> {
    registry.card(name).cloned().ok_or_else(|| {
        let names: Vec<&str> = registry.cards().map(|c| c.name).collect();
        let near = toile_core::nearest(name, names);
        let help =
            near.map_or_else(|| "`toile stages` lists them".to_owned(), |n| format!("did you mean `{n}`?"));
        (format!("there is no stage `{name}`"), Some(help))
    })
}

/// What one run of the stage is given: once, or once for each name of the sets.
enum Jobs {
    Once(Inputs),
    Each(Vec<(String, Inputs)>),
}

fn jobs(fed: Vec<Option<PortValue>>) -> Result<Jobs, String> {
    let names = |v: &Option<PortValue>| match v {
        Some(PortValue::Set(_, set)) => Some(set.keys().cloned().collect::<Vec<_>>()),
        _ => None,
    };
    let Some(first) = fed.iter().find_map(names) else { return Ok(Jobs::Once(Inputs(fed))) };
    if let Some(other) = fed.iter().filter_map(names).find(|other| *other != first) {
        return Err(format!("one dictionary has {}, another {}", first.join(", "), other.join(", ")));
    }
    let entry = |v: &Option<PortValue>, name: &str| match v {
        Some(PortValue::Set(_, set)) => set.get(name).cloned().map(PortValue::One),
        other => other.clone(),
    };
    let job = |name: String| {
        let inputs = Inputs(fed.iter().map(|v| entry(v, &name)).collect());
        (name, inputs)
    };
    Ok(Jobs::Each(first.into_iter().map(job).collect()))
}

/// Runs the stage; what it gives is sound.
fn made(stage: &dyn Stage, jobs: &Jobs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
    match jobs {
        Jobs::Once(inputs) => sound(stage.run_ports(inputs, cx)?),
        Jobs::Each(entries) => {
            let run = |(name, inputs): &(String, Inputs)| {
                let own = cx.for_entry(name);
                let made = stage.run_ports(inputs, &own).and_then(sound);
                cx.absorb(name, own.take_figures(), own.take_remarks());
                made.map_err(|e| StageError { message: format!("{name}: {}", e.message), ..e })
            };
            let made = entries.par_iter().map(run).collect::<Result<Vec<_>, _>>()?;
            let names: Vec<&String> = entries.iter().map(|(name, _)| name).collect();
            Ok(joined(&names, &made))
        }
    }
}

/// The outputs of all entries, a set for each port.
fn joined(names: &[&String], made: &[Vec<PortValue>]) -> Vec<PortValue> {
    let ports = made.first().map_or(0, Vec::len);
    let port = |port: usize| {
        let kind = made.first().and_then(|m| m.get(port)).map_or(Kind("nothing"), PortValue::kind);
        let mut set = BTreeMap::new();
        for (name, outputs) in names.iter().zip(made) {
            if let Some(PortValue::One(artifact)) = outputs.get(port) {
                set.insert((*name).clone(), artifact.clone());
            }
        }
        PortValue::Set(kind, set)
    };
    (0..ports).map(port).collect()
}

fn sound(made: Vec<PortValue>) -> Result<Vec<PortValue>, StageError> {
    for (_, artifact) in made.iter().flat_map(PortValue::entries) {
        artifact
            .check()
            .map_err(|why| StageError::internal(format!("its {} cannot be used: {why}", artifact.kind())))?;
    }
    Ok(made)
}

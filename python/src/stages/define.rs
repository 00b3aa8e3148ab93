//! A function of Python as a stage: its card.

use super::parameter::ParameterKind;
use super::python_stage::PythonStageType;
use super::registry::{add, built_in};
use crate::error::misused;
use crate::settings::settings;
use pyo3::prelude::*;
use toile_core::artifact::{ArtifactType, Body, Digest, Garment, Kind, Mask, OutputFiles, Panel, Photo};
use toile_core::text::intern;
use toile_core::{Arity, Card, Contract, InPort, OutPort, PluginId, Role};

/// Kinds that a function may take, each by the name of its argument.
const KINDS: [Kind; 5] = [Photo::KIND, Mask::KIND, Panel::KIND, Garment::KIND, Body::KIND];

/// What the decorator knows of a function.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct FunctionSpec {
    name: String,
    role: String,
    doc: String,
    source: String,
    module: String,
    /// What makes the function what it is: its source and its version.
    content: String,
    inputs: Vec<String>,
    /// Names, annotations, and defaults as JSON.
    parameters: Vec<(String, String, String)>,
    contracts: Vec<String>,
}

/// Makes a stage of a function.
///
/// Errors: a name that is taken, a role, an argument or a contract that a function cannot have.
#[pyfunction]
pub(crate) fn define(py: Python<'_>, spec: &Bound<'_, PyAny>, function: Py<PyAny>) -> PyResult<()> {
    let spec: FunctionSpec = spec.extract()?;
    let card = card(py, &spec)?;
    let kinds =
        spec.parameters.iter().filter_map(|(_, annotation, _)| ParameterKind::of(annotation)).collect();
    add(PythonStageType { card, kinds, function });
    Ok(())
}

fn card(py: Python<'_>, spec: &FunctionSpec) -> PyResult<Card> {
    let name = intern(&spec.name);
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_name {
        return Err(misused(
            py,
            format!("`{name}` is no name of a stage"),
            Some("write it of letters, digits and `_`".into()),
        ));
    }
    if built_in().card(name).is_some() {
        return Err(misused(
            py,
            format!("the stage name `{name}` is taken by a stage of this program"),
            None,
        ));
    }
    let (role, gives) = role(py, &spec.role)?;
    let inputs = spec.inputs.iter().map(|input| in_port(py, input)).collect::<PyResult<Vec<_>>>()?;
    if role == Role::Writer && inputs.iter().any(|p| p.arity == Arity::Each) {
        return Err(misused(py, "a writer takes `garment` and `body`", None));
    }
    let contracts = spec.contracts.iter().map(|word| contract(py, word)).collect::<PyResult<Vec<_>>>()?;
    let mut params = Vec::new();
    for (param, annotation, default) in &spec.parameters {
        let Some(kind) = ParameterKind::of(annotation) else {
            let message = format!("the parameter `{param}` of `{name}` is annotated `{annotation}`");
            return Err(misused(py, message, Some("annotate it with float, int, bool or str".into())));
        };
        params.push(kind.doc(param, ron_default(py, kind, param, default)?));
    }
    let example: Vec<String> = params.iter().map(|p| format!("{}: {}", p.name, p.default)).collect();
    Ok(Card {
        name,
        role,
        doc: intern(&spec.doc),
        source: intern(&spec.source),
        version: 1,
        example: intern(&format!("{name}({})", example.join(", "))),
        contracts,
        params,
        inputs,
        outputs: vec![OutPort { kind: gives, arity: Arity::One }],
        package: intern(&spec.module),
        plugin: Some(PluginId {
            name: intern(&format!("{}.{name}", spec.module)),
            version: "python",
            digest: Digest::of(spec.content.as_bytes()),
        }),
    })
}

/// A default as RON, from JSON. A text keeps its letters, though they are a name or a number in
/// RON.
fn ron_default(py: Python<'_>, kind: ParameterKind, param: &str, json: &str) -> PyResult<String> {
    if kind == ParameterKind::Text {
        let text: Option<String> = serde_json::from_str(json).ok();
        let wrong = || misused(py, format!("the default of `{param}` is no text"), None);
        return text.map(|text| format!("{text:?}")).ok_or_else(wrong);
    }
    let set = settings(py, vec![(param.to_owned(), json.to_owned())])?;
    let ron = set.into_iter().next().and_then(|s| kind.canonical(&s.value));
    ron.ok_or_else(|| {
        misused(py, format!("the default of `{param}` is not of the type that it is annotated with"), None)
    })
}

/// A role by its word, `EdgeDetector` or `edge detector`, and what its stages give.
fn role(py: Python<'_>, word: &str) -> PyResult<(Role, Kind)> {
    let plain = |text: &str| text.replace([' ', '_'], "").to_lowercase();
    let found = Role::ALL.into_iter().find(|role| plain(role.as_str()) == plain(word));
    let gives = found.and_then(|role| Some((role, gives(role)?)));
    gives.ok_or_else(|| {
        let known: Vec<&str> = Role::ALL.into_iter().filter(|r| gives_some(*r)).map(Role::as_str).collect();
        let help = format!("a function may be a {}", known.join(", "));
        misused(py, format!("a function cannot be a stage of the role `{word}`"), Some(help))
    })
}

fn gives_some(role: Role) -> bool {
    gives(role).is_some()
}

fn gives(role: Role) -> Option<Kind> {
    match role {
        Role::Denoiser => Some(Photo::KIND),
        Role::Binariser => Some(Mask::KIND),
        Role::Smoother => Some(Panel::KIND),
        Role::Body => Some(Body::KIND),
        Role::Draper => Some(Garment::KIND),
        Role::Writer => Some(OutputFiles::KIND),
        _ => None,
    }
}

fn in_port(py: Python<'_>, name: &str) -> PyResult<InPort> {
    let Some(kind) = KINDS.into_iter().find(|kind| kind.0 == name) else {
        let known: Vec<&str> = KINDS.iter().map(|k| k.0).collect();
        let help = format!(
            "arguments without a default are what a stage takes, one of {}; parameters have a default",
            known.join(", ")
        );
        return Err(misused(py, format!("a stage takes no `{name}`"), Some(help)));
    };
    let is_each = [Photo::KIND, Mask::KIND, Panel::KIND].contains(&kind);
    let arity = if is_each { Arity::Each } else { Arity::One };
    Ok(InPort { name: kind.0, kind, arity, optional: false, original: false, sewn: false })
}

fn contract(py: Python<'_>, word: &str) -> PyResult<Contract> {
    Contract::named(word).ok_or_else(|| {
        let known: Vec<&str> = Contract::ALL.into_iter().map(Contract::as_str).collect();
        misused(py, format!("there is no contract `{word}`"), Some(format!("there is {}", known.join(", "))))
    })
}

//! A function of Python behind the trait `Stage`.
//!
//! It is called with arrays that show the artifacts' memory, on the thread that runs the stage,
//! attached to the interpreter for as long as the function runs.

use super::parameter::ParameterKind;
use crate::artifacts::garment::moved;
use crate::artifacts::pictures::{mask_of, photo_of};
use crate::artifacts::{numbers, show, take};
use crate::error::of_exception;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{
    Artifact, ArtifactType, Garment, Kind, Mask, OutputFile, OutputFiles, Panel, Photo,
};
use toile_core::plugin::Make;
use toile_core::{Card, Context, Inputs, PortValue, Stage, StageError, typetag};

/// A function with its card.
pub(super) struct PythonStageType {
    pub(super) card: Card,
    /// Of each of the card's parameters.
    pub(super) kinds: Vec<ParameterKind>,
    pub(super) function: Py<PyAny>,
}

impl std::fmt::Debug for PythonStageType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of Python", self.card.name)
    }
}

impl Make for PythonStageType {
    fn make(&self, card: &Card, arguments: &str) -> Result<Box<dyn Stage>, String> {
        let given = toile_pipeline::fields_of(arguments);
        let mut values = Vec::new();
        for (param, kind) in card.params.iter().zip(&self.kinds) {
            let ron = given.get(param.name).unwrap_or(&param.default);
            let value =
                kind.canonical(ron).ok_or_else(|| format!("`{}` is no {}", param.name, param.kind))?;
            values.push((param.name, *kind, value));
        }
        if let Some(unknown) = given.keys().find(|name| card.params.iter().all(|p| p.name != *name)) {
            return Err(format!("unknown field `{unknown}`"));
        }
        let function = Python::attach(|py| self.function.clone_ref(py));
        Ok(Box::new(PythonStage { card: card.clone(), values, function: Arc::new(function) }))
    }
}

/// A function with its parameters set.
struct PythonStage {
    card: Card,
    /// Names, kinds and values as RON.
    values: Vec<(&'static str, ParameterKind, String)>,
    function: Arc<Py<PyAny>>,
}

impl std::fmt::Debug for PythonStage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.card.name, self.params())
    }
}

#[typetag::serde(name = "a function of Python")]
impl Stage for PythonStage {
    fn card(&self) -> Card {
        self.card.clone()
    }

    fn params(&self) -> String {
        let values: Vec<String> = self.values.iter().map(|(name, _, ron)| format!("{name}: {ron}")).collect();
        format!("({})", values.join(", "))
    }

    fn run_ports(&self, inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
        cx.check()?;
        let made = Python::try_attach(|py| self.called(py, inputs).map_err(|e| of_exception(py, &e)));
        let made = made.unwrap_or_else(|| Err(StageError::internal("Python has ended")))?;
        cx.check()?;
        Ok(vec![PortValue::One(made)])
    }
}

impl PythonStage {
    fn called(&self, py: Python<'_>, inputs: &Inputs) -> PyResult<Arc<dyn Artifact>> {
        let given: Vec<Arc<dyn Artifact>> = inputs.0.iter().flatten().filter_map(one).collect();
        let shown = given.iter().map(|artifact| argument(py, artifact)).collect::<PyResult<Vec<_>>>()?;
        let named = PyDict::new(py);
        for (name, kind, ron) in &self.values {
            named.set_item(name, kind.value(py, ron))?;
        }
        let answer = self.function.bind(py).call(PyTuple::new(py, shown)?, Some(&named))?;
        let gives = self.card.outputs.first().map_or(Kind("nothing"), |port| port.kind);
        made(&answer, gives, &given)
    }
}

fn one(value: &PortValue) -> Option<Arc<dyn Artifact>> {
    match value {
        PortValue::One(artifact) => Some(artifact.clone()),
        PortValue::Set(..) => None,
    }
}

/// What a function is called with: arrays of photos and masks, other artifacts as they are.
fn argument<'py>(py: Python<'py>, artifact: &Arc<dyn Artifact>) -> PyResult<Bound<'py, PyAny>> {
    let shown = show::shown(py, artifact)?;
    match artifact.kind() {
        Photo::KIND | Mask::KIND => shown.getattr("pixels"),
        _ => Ok(shown),
    }
}

/// What a function gave, as the artifact that its role gives.
fn made(answer: &Bound<'_, PyAny>, kind: Kind, given: &[Arc<dyn Artifact>]) -> PyResult<Arc<dyn Artifact>> {
    match kind {
        Photo::KIND => {
            let photo = first::<Photo>(given, kind)?;
            let new = photo_of(answer, "the photo that it returned")?;
            let pixels = new.pixels.as_ref().clone();
            same_size(photo.pixels.dimensions(), pixels.dimensions(), "photo")?;
            Ok(Arc::new(photo.with_pixels(pixels)))
        }
        Mask::KIND => {
            let mask = mask_of(answer, "the mask that it returned")?;
            if let Ok(photo) = first::<Photo>(given, Photo::KIND) {
                same_size(photo.pixels.dimensions(), mask.pixels.dimensions(), "mask")?;
            }
            Ok(Arc::new(mask))
        }
        Panel::KIND => {
            let panel = first::<Panel>(given, kind)?;
            let positions = numbers::points_2d(answer, "the positions that it returned")?;
            let (new, own) = (positions.len(), panel.positions.len());
            if new != own {
                let message = format!("it returned {new} positions, the panel has {own} vertices");
                return Err(PyValueError::new_err(message));
            }
            Ok(Arc::new(Panel { positions, ..panel.as_ref().clone() }))
        }
        Garment::KIND => {
            let garment = first::<Garment>(given, kind)?;
            let positions = numbers::points(answer, "the positions that it returned")?;
            Ok(Arc::new(moved(&garment, positions).map_err(PyValueError::new_err)?))
        }
        OutputFiles::KIND => {
            let files: BTreeMap<String, Vec<u8>> = answer
                .extract()
                .map_err(|_| PyTypeError::new_err("a writer returns a dictionary of paths and bytes"))?;
            let file = |(path, bytes): (String, Vec<u8>)| OutputFile::new(path, bytes);
            Ok(Arc::new(OutputFiles(files.into_iter().map(file).collect())))
        }
        _ => take::artifact(answer, kind, "what it returned"),
    }
}

/// The artifact of a kind that the function was given.
fn first<T: ArtifactType>(given: &[Arc<dyn Artifact>], kind: Kind) -> PyResult<Arc<T>> {
    let found = given.iter().find_map(crate::artifacts::artifact::typed::<T>);
    found.ok_or_else(|| {
        PyTypeError::new_err(format!("a stage that gives a {kind} takes one: name an argument `{kind}`"))
    })
}

fn same_size(of: (u32, u32), given: (u32, u32), what: &str) -> PyResult<()> {
    let [(w, h), (own_w, own_h)] = [given, of];
    match given == of {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "the {what} that it returned is {w} x {h} px, the photo {own_w} x {own_h}"
        ))),
    }
}

impl Serialize for PythonStage {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&format!("{self:?}"))
    }
}

impl<'de> Deserialize<'de> for PythonStage {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom("a function of Python is made a stage by Python"))
    }
}

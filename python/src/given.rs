//! Artifacts of Python in the place of a pipeline's readers.
//!
//! The stage keeps its name and its parameters, by which others know what it reads; its card names
//! a plugin whose digest is that of what is given, so that the cache knows one content from
//! another.

use crate::artifacts::pictures::photo_of;
use crate::artifacts::take;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{Artifact, ArtifactType, Body, Digest, Digester};
use toile_core::{
    Card, Context, Inputs, Node, PluginId, PortValue, Role, Stage, StageError, StageMeta, typetag,
};
use toile_pipeline::Pipeline;
use toile_stages::body::body_of_mesh;
use toile_stages::photo::{Decoded, Photos, given_photos};

/// What a caller gives.
#[derive(Default)]
pub(crate) struct Given {
    photos: BTreeMap<String, Decoded>,
    photos_digest: Option<Digest>,
    body: Option<Arc<dyn Artifact>>,
}

impl Given {
    /// Of the arguments of a run: photos by side, each a photo or an array; a body, or its
    /// vertices and triangles.
    pub(crate) fn of(photos: Option<&Bound<'_, PyDict>>, body: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let mut given = Given::default();
        let mut d = Digester::new();
        for (side, value) in photos.into_iter().flatten() {
            let side: String = side.extract()?;
            let photo = match value.cast::<crate::artifacts::pictures::PyPhoto>() {
                Ok(photo) => photo.get().of.as_ref().clone(),
                Err(_) => photo_of(&value, &format!("photos[\"{side}\"]"))?,
            };
            d.text(&side);
            photo.digest(&mut d);
            let alpha = photo.alpha.as_ref().map(|a| a.as_ref().clone());
            given.photos.insert(side, Decoded { pixels: photo.pixels.as_ref().clone(), alpha });
        }
        given.photos_digest = photos.map(|_| d.finish());
        given.body = body.map(|body| take::artifact(body, Body::KIND, "body")).transpose()?;
        Ok(given)
    }

    /// Puts what is given into the pipeline.
    ///
    /// Errors: the pipeline has no reader in whose place it could stand.
    pub(crate) fn put_into(self, pipeline: &mut Pipeline) -> Result<(), StageError> {
        if let Some(digest) = self.photos_digest {
            let is_reader = |n: &Node| n.card.name == Photos::NAME && n.card.role == Role::Reader;
            let node = pipeline.nodes.iter_mut().find(|n| is_reader(n)).ok_or_else(|| {
                StageError::invalid("photos are given, and the pipeline reads none")
                    .hint("use a pipeline with `photos`, such as pipelines/photo.ron")
            })?;
            replace(node, digest, GivenContent::Photos(Arc::new(self.photos)));
        }
        if let Some(body) = self.body {
            let takes_none = |n: &Node| n.card.inputs.iter().all(|p| p.kind != Body::KIND);
            let is_body = |n: &Node| n.card.role == Role::Body && takes_none(n);
            let node = pipeline.nodes.iter_mut().find(|n| is_body(n)).ok_or_else(|| {
                StageError::invalid(
                    "a body is given, and the pipeline has none in whose place it could stand",
                )
                .hint("use a pipeline with `body`, such as pipelines/pattern.ron")
            })?;
            let mut d = Digester::new();
            body.digest(&mut d);
            replace(node, d.finish(), GivenContent::Body(body));
        }
        Ok(())
    }
}

/// Puts content into the place of a stage.
fn replace(node: &mut Node, digest: Digest, content: GivenContent) {
    let id = PluginId { name: "python", version: env!("CARGO_PKG_VERSION"), digest };
    let card = Card { inputs: Vec::new(), plugin: Some(id), ..node.card.clone() };
    let params = node.stage.params();
    node.inputs.clear();
    node.card = card.clone();
    node.stage = Box::new(GivenStage { card, params, content });
}

/// What stands in the place of a reader.
#[derive(Clone)]
enum GivenContent {
    Photos(Arc<BTreeMap<String, Decoded>>),
    Body(Arc<dyn Artifact>),
}

/// A reader's place with what is given.
struct GivenStage {
    card: Card,
    /// Those of the stage in whose place it stands.
    params: String,
    content: GivenContent,
}

impl std::fmt::Debug for GivenStage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} (given)", self.card.name)
    }
}

#[typetag::serde(name = "an artifact of Python")]
impl Stage for GivenStage {
    fn card(&self) -> Card {
        self.card.clone()
    }

    fn params(&self) -> String {
        self.params.clone()
    }

    fn run_ports(&self, _inputs: &Inputs, cx: &Context) -> Result<Vec<PortValue>, StageError> {
        match &self.content {
            GivenContent::Photos(photos) => {
                let set = given_photos(&self.params, photos, cx)?;
                Ok(toile_core::Output::pack(set))
            }
            GivenContent::Body(body) => Ok(vec![PortValue::One(with_landmarks(body)?)]),
        }
    }
}

/// A body whose landmarks are found from its shape where it has none.
fn with_landmarks(body: &Arc<dyn Artifact>) -> Result<Arc<dyn Artifact>, StageError> {
    let any: &dyn Any = body.as_ref();
    match any.downcast_ref::<Body>() {
        Some(mesh) if mesh.landmarks.is_empty() => {
            let (found, missing) = body_of_mesh(mesh.positions.clone(), mesh.triangles.clone())?;
            match missing {
                None => Ok(Arc::new(found)),
                Some(part) => Err(StageError::invalid(format!("the body's {part} cannot be found from its shape"))
                    .hint("it must stand upright along y, in metres, and face +z, arms away from the trunk, feet apart")),
            }
        }
        _ => Ok(body.clone()),
    }
}

impl Serialize for GivenStage {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&format!("{self:?}"))
    }
}

impl<'de> Deserialize<'de> for GivenStage {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom("an artifact of Python is given by Python"))
    }
}

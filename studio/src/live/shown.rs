//! What runs have made so far, for a page to show.

use super::read::ReadPattern;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::artifact::{
    Artifact, Body, Collider, Figures, Garment, Kind, Mask, Model, Outline, Pattern, Photo, SewingPlan,
};
use toile_core::{ArtifactType, PortValue};

/// The kinds that are shown.
pub(crate) const KINDS: [Kind; 10] = [
    Photo::KIND,
    Mask::KIND,
    Outline::KIND,
    SewingPlan::KIND,
    Pattern::KIND,
    Garment::KIND,
    Model::KIND,
    Body::KIND,
    Collider::KIND,
    Figures::KIND,
];

type NamedSet<T> = BTreeMap<String, Arc<T>>;

/// The latest of each kind.
#[derive(Debug, Clone, Default)]
pub(crate) struct ShownArtifacts {
    /// As the photos were read.
    pub(crate) photos: NamedSet<Photo>,
    pub(crate) masks: NamedSet<Mask>,
    pub(crate) outlines: NamedSet<Outline>,
    pub(crate) plan: Option<Arc<SewingPlan>>,
    /// As it was read.
    pub(crate) read: Option<Arc<ReadPattern>>,
    /// As the last stage left it.
    pub(crate) pattern: Option<Arc<Pattern>>,
    /// The number of the text that it comes from.
    pub(crate) pattern_edit: u64,
    /// Its pieces around the body, before they are sewn.
    pub(crate) start: Option<Arc<Garment>>,
    /// The number of the text that they come from.
    pub(crate) start_edit: u64,
    pub(crate) garment: Option<Arc<Garment>>,
    /// The number of the text that it comes from.
    pub(crate) garment_edit: u64,
    /// The garment's textures; none before it has any.
    pub(crate) model: Option<Arc<Model>>,
    pub(crate) body: Option<Arc<Body>>,
    /// What the garment lies on.
    pub(crate) collider: Option<Arc<Collider>>,
    pub(crate) figures: Option<Arc<Figures>>,
}

impl ShownArtifacts {
    /// Takes what a stage made of the text of that number; whether it is shown.
    pub(crate) fn take(&mut self, outputs: &[PortValue], edit: u64) -> bool {
        outputs.iter().filter(|value| self.take_port(value, edit)).count() > 0
    }

    fn take_port(&mut self, value: &PortValue, edit: u64) -> bool {
        let kind = value.kind();
        // Photos that stages change are not those that a user took.
        if kind == Photo::KIND && self.photos.is_empty() {
            self.photos = set(value);
        } else if kind == Mask::KIND {
            self.masks = set(value);
        } else if kind == Outline::KIND {
            self.outlines = set(value);
        } else if kind == SewingPlan::KIND {
            self.plan = one(value);
        } else if kind == Pattern::KIND {
            self.pattern = one(value);
            self.pattern_edit = edit;
            if self.read.is_none() {
                self.read = self.pattern.clone().map(|pattern| Arc::new(ReadPattern::new(pattern)));
            }
        } else if kind == Garment::KIND {
            self.garment = one(value);
            self.garment_edit = edit;
            self.model = None;
            if self.start.is_none() {
                self.start = self.garment.clone();
                self.start_edit = edit;
            }
        } else if kind == Model::KIND {
            self.model = one(value);
        } else if kind == Body::KIND {
            self.body = one(value);
        } else if kind == Collider::KIND {
            self.collider = one(value);
        } else if kind == Figures::KIND {
            self.figures = one(value);
        } else {
            return false;
        }
        true
    }

    /// This, and what it lacks of an earlier one.
    pub(crate) fn over(&self, before: &ShownArtifacts) -> ShownArtifacts {
        fn either<T>(new: &NamedSet<T>, old: &NamedSet<T>) -> NamedSet<T> {
            if new.is_empty() { old.clone() } else { new.clone() }
        }
        let (garment, garment_edit, model) = match &self.garment {
            None => (before.garment.clone(), before.garment_edit, before.model.clone()),
            new => (new.clone(), self.garment_edit, self.model.clone()),
        };
        let (pattern, pattern_edit) = match &self.pattern {
            None => (before.pattern.clone(), before.pattern_edit),
            new => (new.clone(), self.pattern_edit),
        };
        let (start, start_edit) = match &self.start {
            None => (before.start.clone(), before.start_edit),
            new => (new.clone(), self.start_edit),
        };
        ShownArtifacts {
            photos: either(&self.photos, &before.photos),
            masks: either(&self.masks, &before.masks),
            outlines: either(&self.outlines, &before.outlines),
            plan: self.plan.clone().or_else(|| before.plan.clone()),
            read: self.read.clone().or_else(|| before.read.clone()),
            pattern,
            pattern_edit,
            start,
            start_edit,
            garment,
            garment_edit,
            model,
            body: self.body.clone().or_else(|| before.body.clone()),
            collider: self.collider.clone().or_else(|| before.collider.clone()),
            figures: self.figures.clone().or_else(|| before.figures.clone()),
        }
    }
}

fn cast<T: ArtifactType>(artifact: &Arc<dyn Artifact>) -> Option<Arc<T>> {
    let any: Arc<dyn Any + Send + Sync> = artifact.clone();
    any.downcast().ok()
}

fn one<T: ArtifactType>(value: &PortValue) -> Option<Arc<T>> {
    value.entries().first().and_then(|(_, artifact)| cast(artifact))
}

fn set<T: ArtifactType>(value: &PortValue) -> NamedSet<T> {
    let named = |(name, artifact): (&str, &Arc<dyn Artifact>)| Some((name.to_owned(), cast(artifact)?));
    value.entries().into_iter().filter_map(named).collect()
}

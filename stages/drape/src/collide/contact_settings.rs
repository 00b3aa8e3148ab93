//! Settings that the built-in colliders share, and what they do with a body before they take it.

use super::asked_distances::{self, Distances};
use super::body_check::check_body;
use super::scheme::KernelScheme;
use super::search::{BodySkin, ClothSearch};
use std::sync::Arc;
use toile_body::bridged;
use toile_core::decide::Decision;
use toile_core::prelude::*;
use toile_core::{ByPlace, Known, Node};

/// How cloth and body meet.
#[params]
#[derive(Copy)]
pub(crate) struct ContactSettings {
    /// Distance at which cloth is held off the body and off itself.
    #[param(default = Length::mm(1.5), min = 1e-5, max = 0.05, trades)]
    pub(crate) thickness: Length,
    /// Coulomb friction coefficient.
    #[param(default = 0.3, min = 0, max = 2)]
    pub(crate) friction: f64,
    /// Share of the speed that is thrown back, 0 for cloth that stays where it lands: for springs
    /// alone.
    #[param(default = 0.0, min = 0, max = 1)]
    pub(crate) restitution: f64,
    /// True where cloth is kept out of itself.
    #[param(default = true, trades)]
    pub(crate) self_collision: bool,
    /// A force that pushes cloth off the body, for solvers that step in time; without it contacts
    /// are resolved by impulses. `Linear(c)`: c (thickness - distance) within the thickness, c in
    /// N/m per vertex. `Exponential(c)`: c exp(-distance / thickness), c in N per vertex.
    #[param(default = None, min = 0, max = 1e6)]
    pub(crate) penalty: Option<Penalty>,
    /// Gaps between arm and trunk narrower than this are bridged for the cloth, which cannot rest
    /// in them; none at 0.
    #[param(default = Length::mm(0.0), min = 0.0, max = 0.3)]
    pub(crate) bridge: Length,
    /// When distances to the body are worked out; the results are the same.
    #[param(default = Distances::Asked)]
    pub(crate) distances: Distances,
}

/// Share of the stage's time that distances where they are requested save, on the vest.
const SHARE: f64 = 0.7;

impl ContactSettings {
    /// Refuses a body that is none, warns of a collider that keeps nothing apart, and gives the
    /// body as the cloth meets it, where that is another one.
    pub(crate) fn prepared(&self, body: Option<&Body>, cx: &Context) -> Result<Option<Body>, StageError> {
        body.map(check_body).transpose()?;
        if body.is_none() && !self.self_collision {
            cx.warn("there is no body and self-collision is off: nothing is kept apart");
        }
        let width = self.bridge.metres();
        if width == 0.0 {
            return Ok(None);
        }
        let found = body.map(|b| bridged(b, width, cx)).transpose()?.flatten();
        if found.is_none() {
            cx.note("`bridge` has nothing to bridge: there is no body with landmarks of its armpits");
        }
        Ok(found)
    }

    /// The service of a skin and a search with these settings, for a body that has passed its
    /// checks.
    pub(crate) fn scheme<S, C>(
        &self,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Arc<dyn Collide>, StageError>
    where
        S: BodySkin + 'static,
        C: ClothSearch + 'static,
    {
        let card = ColliderCard {
            thickness: self.thickness.metres(),
            friction: self.friction,
            restitution: self.restitution,
            self_collision: self.self_collision,
            penalty: self.penalty,
        };
        Ok(Arc::new(KernelScheme::<S, C>::new(card, body, self.distances, cx)?))
    }

    /// What is left out for the scene.
    pub(crate) fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        let body = known.is_wired("body");
        let rule = || asked_distances::rule(self.distances, known.given, SHARE);
        body.then(rule).flatten().into_iter().collect()
    }
}

/// A collider behind another of its kind takes that one's parameters where it is given none.
pub(crate) fn like_the_one_before(nodes: &[Node], index: usize) -> ByPlace {
    let own = nodes.get(index).map(|n| n.card.name);
    let like = nodes.iter().take(index).rposition(|n| Some(n.card.name) == own);
    ByPlace { like, set: Vec::new() }
}

/// Names scheme, settings and body, so that colliders with different answers differ in it.
pub(crate) fn signature(name: &str, settings: &str, body: Option<&Body>) -> String {
    let digest = |b: &Body| {
        let mut d = toile_core::artifact::Digester::new();
        b.digest(&mut d);
        d.finish().short()
    };
    format!("{name}{settings} body {}", body.map_or_else(|| "none".into(), digest))
}

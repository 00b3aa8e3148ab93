//! `BvhCollider`: body and cloth in hierarchies of bounding volumes.

use super::asked_distances::{self, Distances};
use super::body_check::check_body;
use super::scheme::BvhScheme;
use std::sync::Arc;
use toile_body::bridged;
use toile_core::Known;
use toile_core::decide::Decision;
use toile_core::param::ron_text;
use toile_core::prelude::*;
use toile_core::{ByPlace, Node};
use toile_geometry::volume::{Aabb, BoundingSphere, BoundingVolume, KDop, Obb};

/// The bounding volume of the hierarchies.
#[choice]
#[derive(Copy)]
pub enum Volume {
    /// Box along the axes: cheap to refit, the best for cloth.
    Aabb,
    /// Ball: cheapest to test, loosest.
    Sphere,
    /// Box along the axes of what it holds: tightest, dearest.
    Obb,
    /// Polytope of k faces: 6 (the same as `Aabb`), 14, 18 or 26.
    KDop(u32),
}

/// Keeps cloth out of the body and out of itself, with a hierarchy of bounding volumes.
///
/// The body must be a closed mesh that faces outwards. Without a body only cloth against itself is
/// looked for. Every volume gives the same contacts; they differ in time alone.
///
/// Friction and restitution are applied by the solver when it resolves a contact: the speed along
/// the skin falls by `friction` times the speed into it, the speed into it is thrown back
/// `restitution` times. With `penalty`, cloth nearer than `thickness` is pushed off by a spring of
/// that stiffness instead. Both are what `SpringStitcher` and `SpringDraper` do; the other drapers
/// refuse them.
///
/// Behind another `BvhCollider`, such as one of the same body in another pose, it takes that one's
/// parameters where it is given none.
#[stage(
    role = Collider,
    source = "Gottschalk et al. 1996; Klosowski et al. 1998; Baerentzen & Aanaes 2005",
    example = "BvhCollider(volume: Aabb, thickness: \"1.5 mm\", friction: 0.3)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct BvhCollider {
    /// What the hierarchies are made of.
    #[param(default = Volume::Aabb, trades)]
    volume: Volume,
    /// Distance at which cloth is held off the body and off itself.
    #[param(default = Length::mm(1.5), min = 1e-5, max = 0.05, trades)]
    thickness: Length,
    /// Coulomb friction coefficient.
    #[param(default = 0.3, min = 0, max = 2)]
    friction: f64,
    /// Share of the speed that is thrown back, 0 for cloth that stays where it lands: for springs
    /// alone.
    #[param(default = 0.0, min = 0, max = 1)]
    restitution: f64,
    /// True where cloth is kept out of itself.
    #[param(default = true, trades)]
    self_collision: bool,
    /// Stiffness of the penalty response, for springs alone; without it contacts are resolved by
    /// impulses.
    #[param(default = None, min = 0, max = 1e6, unit = "N/m")]
    penalty: Option<f64>,
    /// Gaps between arm and trunk narrower than this are bridged for the cloth, which cannot rest
    /// in them; none at 0.
    #[param(default = Length::mm(0.0), min = 0.0, max = 0.3)]
    bridge: Length,
    /// When distances to the body are worked out; the results are the same.
    #[param(default = Distances::Asked)]
    distances: Distances,
}

/// Share of the stage's time that distances where they are asked for save, on the vest.
const SHARE: f64 = 0.7;

#[stage]
impl BvhCollider {
    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        let own = nodes.get(index).map(|n| n.card.name);
        let like = nodes.iter().take(index).rposition(|n| Some(n.card.name) == own);
        ByPlace { like, set: Vec::new() }
    }

    fn run(&self, body: Option<&Body>, cx: &Context) -> Result<Collider, StageError> {
        body.map(check_body).transpose()?;
        if body.is_none() && !self.self_collision {
            cx.warn("there is no body and self-collision is off: nothing is kept apart");
        }
        let bridged = self.bridged(body, cx)?;
        let signature = self.signature(body);
        let body = bridged.as_ref().or(body);
        let scheme = match self.volume {
            Volume::Aabb => self.scheme::<Aabb>(body, cx),
            Volume::Sphere => self.scheme::<BoundingSphere>(body, cx),
            Volume::Obb => self.scheme::<Obb>(body, cx),
            Volume::KDop(6) => self.scheme::<KDop<3>>(body, cx),
            Volume::KDop(14) => self.scheme::<KDop<7>>(body, cx),
            Volume::KDop(18) => self.scheme::<KDop<9>>(body, cx),
            Volume::KDop(26) => self.scheme::<KDop<13>>(body, cx),
            Volume::KDop(k) => Err(no_such_kdop(k)),
        }?;
        Ok(Collider { scheme, signature })
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        match self.volume {
            Volume::KDop(k) if ![6, 14, 18, 26].contains(&k) => vec![no_such_kdop(k)],
            _ => Vec::new(),
        }
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        let body = known.is_wired("body");
        body.then(|| asked_distances::rule(self.distances, known.given, SHARE))
            .flatten()
            .into_iter()
            .collect()
    }

    /// The body as the cloth meets it, where that is another one.
    fn bridged(&self, body: Option<&Body>, cx: &Context) -> Result<Option<Body>, StageError> {
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

    fn scheme<V: BoundingVolume>(
        &self,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Arc<dyn Collide>, StageError> {
        let card = ColliderCard {
            thickness: self.thickness.metres(),
            friction: self.friction,
            restitution: self.restitution,
            self_collision: self.self_collision,
            penalty: self.penalty,
        };
        Ok(Arc::new(BvhScheme::<V>::new(card, body, self.distances, cx)?))
    }

    /// Names scheme, settings and body, so that colliders with different answers differ in it.
    fn signature(&self, body: Option<&Body>) -> String {
        let digest = |b: &Body| {
            let mut d = toile_core::artifact::Digester::new();
            b.digest(&mut d);
            d.finish().short()
        };
        format!("BvhCollider{} body {}", ron_text(self), body.map_or_else(|| "none".into(), digest))
    }
}

fn no_such_kdop(k: u32) -> StageError {
    StageError::new(
        ErrorCode::InvalidParameter,
        format!("`volume` is KDop({k}), and there is no such polytope"),
    )
    .hint("k is 6, 14, 18 or 26")
    .at("volume")
}

#[cfg(test)]
mod tests;

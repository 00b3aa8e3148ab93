//! `BvhCollider`: body and cloth in hierarchies of bounding volumes.

use super::contact_settings::{self, ContactSettings};
use std::sync::Arc;
use toile_core::Known;
use toile_core::decide::Decision;
use toile_core::param::ron_text;
use toile_core::prelude::*;
use toile_core::{ByPlace, Node};
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::signed_distance::SignedDistance;
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
/// `restitution` times. With `penalty`, the body pushes cloth off by a force instead: in proportion
/// to how much nearer than `thickness` it is (Fan et al. 1999), or falling exponentially with its
/// distance (2003). All solvers that step in time do both; `StaticEquilibrium` refuses them.
///
/// `ParryCollider` gives the same contacts by another library. Behind another `BvhCollider`, such
/// as one of the same body in another pose, it takes that one's parameters where it is given none.
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
    #[param(flatten)]
    contact: ContactSettings,
}

#[stage]
impl BvhCollider {
    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        contact_settings::like_the_one_before(nodes, index)
    }

    pub(super) fn run(&self, body: Option<&Body>, cx: &Context) -> Result<Collider, StageError> {
        let prepared = self.contact.prepared(body, cx)?;
        let signature = contact_settings::signature("BvhCollider", &ron_text(self), body);
        let body = prepared.as_ref().or(body);
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
        self.contact.decisions(known)
    }

    fn scheme<V: BoundingVolume>(
        &self,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Arc<dyn Collide>, StageError> {
        self.contact.scheme::<SignedDistance<V>, ClothTree<V>>(body, cx)
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

//! `ParryCollider`: body and cloth on parry3d.

use super::contact_settings::{self, ContactSettings};
use super::parry::{ParryCloth, ParrySkin};
use toile_core::Known;
use toile_core::decide::Decision;
use toile_core::param::ron_text;
use toile_core::prelude::*;
use toile_core::{ByPlace, Node};

/// Keeps cloth out of the body and out of itself, with the trees of the library parry3d.
///
/// The same contacts as those of `BvhCollider`, to the last digits: the distance to the body comes
/// from parry3d's triangle mesh, pairs of cloth from its tree of boxes. It is there to hold the two
/// against each other; `BvhCollider` takes less time. The body must be a closed mesh that faces
/// outwards. Without a body only cloth against itself is looked for.
///
/// Friction, restitution and penalty are applied by the solver, as with `BvhCollider`. Behind
/// another `ParryCollider` it takes that one's parameters where it is given none.
#[stage(
    role = Collider,
    source = "parry3d 0.31 (Dimforge); Baerentzen & Aanaes 2005",
    example = "ParryCollider(thickness: \"1.5 mm\", friction: 0.3)",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct ParryCollider {
    #[param(flatten)]
    contact: ContactSettings,
}

#[stage]
impl ParryCollider {
    fn by_place(&self, nodes: &[Node], index: usize) -> ByPlace {
        contact_settings::like_the_one_before(nodes, index)
    }

    fn run(&self, body: Option<&Body>, cx: &Context) -> Result<Collider, StageError> {
        let prepared = self.contact.prepared(body, cx)?;
        let signature = contact_settings::signature("ParryCollider", &ron_text(self), body);
        let scheme = self.contact.scheme::<ParrySkin, ParryCloth>(prepared.as_ref().or(body), cx)?;
        Ok(Collider { scheme, signature })
    }

    fn decisions(&self, known: &Known<'_>) -> Vec<Decision> {
        self.contact.decisions(known)
    }
}

#[cfg(test)]
mod tests;

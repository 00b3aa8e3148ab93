//! Colliders: body to collision service.
//!
//! - [`bvh_collider`]: the stage.
//! - [`scheme`]: the service that solvers call.
//! - [`volume`], [`bvh`]: bounding volumes and the tree over them, the same for body and cloth.
//! - [`body_check`], [`body_index`]: the body, with its sign and its paths; a lattice of distances
//!   sorts most queries out.
//! - [`closest`], [`proximity`], [`crossing`], [`ccd`]: tests of a few points, free functions that
//!   solvers may call on their own.

pub(crate) mod asked_distances;
pub mod body_check;
pub mod body_index;
pub mod bvh;
mod bvh_collider;
pub mod ccd;
pub mod closest;
mod cloth_tree;
pub mod crossing;
mod lattice;
pub mod proximity;
pub mod scheme;
mod self_collision;
pub mod volume;

pub use asked_distances::Distances;
pub use body_check::check_body;
pub use body_index::{BodyIndex, OnSkin};
pub use bvh_collider::{BvhCollider, Volume};
pub use scheme::BvhScheme;
pub use volume::Aabb;

use toile_core::Registry;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<BvhCollider>();
}

#[cfg(test)]
mod testing;

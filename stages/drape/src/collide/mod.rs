//! Colliders: body to collision service.
//!
//! - [`bvh_collider`], [`parry_collider`]: the stages; `contact_settings` is what they share.
//! - [`scheme`]: the service that solvers call; [`search`]: what it asks of a kernel.
//! - [`parry`]: parry3d as that kernel.
//! - [`body_check`], [`body_index`]: the body, with its sign and its paths.
//! - [`self_collision`], [`proximity`]: cloth against itself.

pub(crate) mod asked_distances;
pub mod body_check;
pub mod body_index;
mod bvh_collider;
mod contact_settings;
pub mod parry;
mod parry_collider;
pub(crate) mod points;
pub mod proximity;
pub mod scheme;
pub mod search;
mod self_collision;

pub use asked_distances::Distances;
pub use body_check::check_body;
pub use body_index::BodyIndex;
pub use bvh_collider::{BvhCollider, Volume};
pub use parry_collider::ParryCollider;
pub use scheme::{BvhScheme, KernelScheme};

use toile_core::Registry;
use toile_core::artifact::{Body, Point3};
use toile_geometry::crossing::between_meshes;

/// How many pairs of a triangle of the cloth and one of the body cross.
pub(crate) fn body_crossings(positions: &[Point3], triangles: &[[u32; 3]], body: &Body) -> usize {
    between_meshes((points::coords(positions), triangles), (points::coords(&body.positions), &body.triangles))
        .len()
}

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<BvhCollider>();
    registry.add::<ParryCollider>();
}

#[cfg(test)]
mod testing;

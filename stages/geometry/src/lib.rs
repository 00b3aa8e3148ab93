//! Geometry of triangle meshes in space, in metres and `f64`: what the cloth engine, colliders and
//! readers of meshes share.
//!
//! - [`closest`], [`pair`]: closest points of a triangle and of two segments; two pieces of cloth
//!   near each other.
//! - [`ccd`]: when two moving pieces first come near each other.
//! - [`crossing`]: whether triangles cross, by exact signs.
//! - [`volume`], [`tree`]: bounding volumes and the one tree over them.
//! - [`cloth_tree`]: which parts of a moving sheet may meet.
//! - [`signed_distance`]: distance to a closed mesh, negative inside; [`lattice`] bounds it
//!   cheaply.
//! - [`sharp`], [`facets`]: sharp edges of a body, and where triangles pass through it.
//! - [`components`]: connected components.
//! - [`obj`]: Wavefront OBJ.
//! - [`shapes`]: simple meshes for tests.

pub mod ccd;
pub mod closest;
pub mod cloth_tree;
pub mod components;
pub mod crossing;
pub mod facets;
pub mod lattice;
pub mod obj;
pub mod pair;
pub mod shapes;
pub mod sharp;
pub mod signed_distance;
pub mod tree;
pub mod volume;

/// A place or a direction.
pub type Vec3 = nalgebra::Vector3<f64>;

/// The corners of a triangle.
pub type Corners = [Vec3; 3];

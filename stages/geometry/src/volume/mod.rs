//! Bounding volumes: what a hierarchy may wrap its triangles in.
//!
//! From loosest and cheapest to tightest and dearest: sphere, axis-aligned box, discrete
//! orientation polytope (k-DOP), oriented box. A tighter volume makes fewer pair tests, each of
//! which costs more; for cloth, whose volumes change at every step, the cheap ones mostly win.
//!
//! Every volume keeps one promise: what it holds is never farther out than the volume says,
//! rounding included. So the hierarchy may skip a pair, never wrongly, and all volumes give the
//! same contacts.
//!
//! Source: Gottschalk, Lin, Manocha 1996 (OBB); Klosowski et al. 1998 (k-DOP).

mod aabb;
mod kdop;
mod obb;
mod sphere;

pub use aabb::Aabb;
pub use kdop::KDop;
pub use obb::Obb;
pub use sphere::BoundingSphere;

use crate::Vec3;

/// How much wider than computed a volume is made, relative to the size of its coordinates.
///
/// It trades a few needless pair tests for safety against rounding: projections onto slanted axes
/// are off by some 1e-16 of the coordinates.
pub(super) const PAD: f64 = 1e-13;

/// A convex volume around a piece of a mesh.
pub trait BoundingVolume: Copy + Send + Sync + std::fmt::Debug + 'static {
    /// The smallest volume around the points that is found at moderate cost; at least one point.
    fn fit(points: &[Vec3]) -> Self;

    /// A volume around two volumes, cheap enough to be made anew at every step.
    fn merge(&self, other: &Self) -> Self;

    /// False only where the two are farther apart than `reach`.
    fn near(&self, other: &Self, reach: f64) -> bool;

    /// A lower bound of the squared distance from a point to what the volume holds.
    fn distance_squared(&self, p: &Vec3) -> f64;

    /// A length that grows with the volume, to choose which of two to open first.
    fn size(&self) -> f64;
}

#[cfg(test)]
mod tests;

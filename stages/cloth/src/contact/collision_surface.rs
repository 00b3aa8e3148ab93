//! The interface between solvers and a collider: distance queries and step limits for many points
//! at once.
//!
//! [`Body`](super::body::Body) implements it with a tree of its triangles; other collision schemes
//! implement [`CollisionSurface`], too.

use super::body::Body;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::sharp::Sharp;
use toile_geometry::signed_distance::Nearest;
use toile_geometry::{Vec3, facets::Facets};

/// Points per parallel task.
const CHUNK: usize = 64;

/// A solid that cloth stays outside of. The results must not depend on the number of threads.
pub trait CollisionSurface: Send + Sync + std::fmt::Debug {
    /// The nearest place of the surface for each point, inside or outside, where it is nearer than
    /// the point's `within`, m.
    fn nearest(&self, points: &[Vec3], within: &[f64]) -> Vec<Option<Nearest>>;

    /// Shortens each move that would lead into the solid, so that it ends its `gap` (m) outside.
    /// Points inside the solid move freely.
    fn guard(&self, points: &[Vec3], moves: &mut [Vec3], gaps: &[f64]);

    /// The support function: the greatest product of its points with a unit direction, m. `None`
    /// where it is empty.
    fn reach(&self, direction: &Vec3) -> Option<f64>;

    /// Its sharp edges and corners, if it has any.
    fn sharp(&self) -> Option<Arc<Sharp>> {
        None
    }

    /// Its triangles, if it is a mesh.
    fn facets(&self) -> Option<&Facets> {
        None
    }
}

impl CollisionSurface for Body {
    fn nearest(&self, points: &[Vec3], within: &[f64]) -> Vec<Option<Nearest>> {
        let near = |(p, w): (&Vec3, &f64)| Body::nearest(self, p, *w);
        points.par_iter().zip(within).with_min_len(CHUNK).map(near).collect()
    }

    fn guard(&self, points: &[Vec3], moves: &mut [Vec3], gaps: &[f64]) {
        let guard = |((m, p), gap): ((&mut Vec3, &Vec3), &f64)| *m = Body::guard(self, p, m, *gap);
        moves.par_iter_mut().zip(points).zip(gaps).with_min_len(CHUNK).for_each(guard);
    }

    fn reach(&self, direction: &Vec3) -> Option<f64> {
        let corners = self.triangles().iter().flatten().map(|&v| self.vertices()[v as usize]);
        corners.map(|p| p.dot(direction)).reduce(f64::max)
    }

    fn sharp(&self) -> Option<Arc<Sharp>> {
        Body::sharp(self)
    }

    fn facets(&self) -> Option<&Facets> {
        Body::facets(self)
    }
}

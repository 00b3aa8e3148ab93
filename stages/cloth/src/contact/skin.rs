//! The body as a solver sees it: two questions, asked for many points at once.
//!
//! [`Body`](super::body::Body) answers from its own tree; another collision scheme takes its place
//! behind [`CollisionSurface`].

use super::body::Body;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::facets::Facets;
use toile_geometry::sharp::Sharp;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Points that one task looks after.
const CHUNK: usize = 64;

/// A solid that cloth stays outside of. The answers must not depend on the number of threads.
pub trait CollisionSurface: Send + Sync + std::fmt::Debug {
    /// For each point the surface nearest to it, where it is nearer than the point's `within` (m),
    /// inside or outside.
    fn nearest(&self, points: &[Vec3], within: &[f64]) -> Vec<Option<Nearest>>;

    /// Ends each move that would lead into the solid its `gap` (m) outside it. A point inside may
    /// move as it likes.
    fn guard(&self, points: &[Vec3], moves: &mut [Vec3], gaps: &[f64]);

    /// How far the solid reaches along a unit direction: the greatest product of its points with
    /// it, m. Nothing where there is none.
    fn reach(&self, direction: &Vec3) -> Option<f64>;

    /// Its sharp edges and corners, if it has any and knows of them.
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

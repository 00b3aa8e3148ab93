//! The body: a closed, static triangle mesh that cloth stays outside of.

use std::sync::{Arc, OnceLock};
use toile_geometry::sharp::Sharp;
use toile_geometry::signed_distance::{Nearest, SignedDistance};
use toile_geometry::{Vec3, facets::Facets};

/// A closed, static triangle mesh whose triangles face outwards.
#[derive(Debug, Clone)]
pub struct Body {
    surface: SignedDistance,
    sharp: Option<Arc<Sharp>>,
    /// Made on first use.
    facets: OnceLock<Option<Facets>>,
}

impl Body {
    /// Builds the tree. Triangles must refer to existing vertices. An empty body is far from
    /// everything.
    #[must_use]
    pub fn new(vertices: Vec<Vec3>, triangles: &[[u32; 3]]) -> Self {
        let sharp = Sharp::of(&vertices, triangles).map(Arc::new);
        Self { surface: SignedDistance::new(vertices, triangles.to_vec()), sharp, facets: OnceLock::new() }
    }

    /// Its vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3] {
        self.surface.vertices()
    }

    /// Its triangles.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.surface.triangles()
    }

    /// Its sharp edges and corners, if it has any.
    #[must_use]
    pub fn sharp(&self) -> Option<Arc<Sharp>> {
        self.sharp.clone()
    }

    /// Its triangles, for crossings with cloth; `None` for an empty body.
    #[must_use]
    pub fn facets(&self) -> Option<&Facets> {
        self.facets.get_or_init(|| Facets::of(self.vertices(), self.triangles())).as_ref()
    }

    /// The nearest place of the surface to `p`, if it is no farther than `within`.
    #[must_use]
    pub fn nearest(&self, p: &Vec3, within: f64) -> Option<Nearest> {
        self.surface.nearest(p, within)
    }

    /// The move `by` from `p`, shortened so that it ends `gap` outside the surface where it would
    /// enter the body.
    ///
    /// Method: sphere tracing, in steps no longer than the distance from the surface, so that
    /// nothing is jumped over. A point that starts inside moves freely.
    #[must_use]
    pub fn guard(&self, p: &Vec3, by: &Vec3, gap: f64) -> Vec3 {
        let length = by.norm();
        let start = self.nearest(p, length + gap);
        if start.is_none_or(|n| n.distance < 0.0) {
            return *by;
        }
        let mut t = start.map_or(0.0, |n| n.distance.max(gap)) / length;
        while t < 1.0 {
            let at = p + by * t;
            match self.nearest(&at, length + gap) {
                None => break,
                Some(n) if n.distance < 0.0 => return n.point + n.normal * gap - p,
                Some(n) => t += n.distance.max(gap) / length,
            }
        }
        match self.nearest(&(p + by), length + gap) {
            Some(n) if n.distance < 0.0 => n.point + n.normal * gap - p,
            _ => *by,
        }
    }
}

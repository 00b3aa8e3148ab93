//! A pipeline's collision scheme as a collision surface of the engine.

use nalgebra::Vector3;
use std::sync::{Arc, OnceLock};
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_core::artifact::{BodyContact, Collide, Point3};
use toile_geometry::facets::Facets;
use toile_geometry::sharp::Sharp;
use toile_geometry::signed_distance::Nearest;

/// Vertices, m, and triangles of a collider's mesh.
type ColliderMesh<'a> = (Vec<Vector3<f64>>, &'a [[u32; 3]]);

/// The body of a collision scheme: one call a question, whatever the number of points.
#[derive(Debug, Clone)]
pub struct SchemeSurface<'a> {
    scheme: &'a dyn Collide,
    /// Found when a solver first asks.
    sharp: OnceLock<Option<Arc<Sharp>>>,
    facets: OnceLock<Option<Facets>>,
}

impl<'a> SchemeSurface<'a> {
    /// The body that `scheme` keeps cloth out of. Its sharp edges and its triangles are known where
    /// the scheme shows a mesh.
    #[must_use]
    pub fn new(scheme: &'a dyn Collide) -> Self {
        Self { scheme, sharp: OnceLock::new(), facets: OnceLock::new() }
    }
}

impl SchemeSurface<'_> {
    /// Vertices and triangles of the body, where the scheme shows them.
    fn mesh(&self) -> Option<ColliderMesh<'_>> {
        let surface = self.scheme.surface()?;
        Some((surface.positions.iter().map(|p| p.coords).collect(), surface.triangles))
    }
}

/// From so far away along a direction the nearest point of a body is the one that reaches farthest
/// along it, metres: for a body 1 m wide it is off by half a micrometre.
const FAR: f64 = 1e6;

/// Looks from far away, each from above what the last one found: a body may stand far from the
/// origin.
const LOOKS: usize = 3;

/// No garment is farther from its body, metres: stands for a reach without limit.
const ANYWHERE: f64 = 100.0;

impl CollisionSurface for SchemeSurface<'_> {
    fn nearest(&self, points: &[Vector3<f64>], within: &[f64]) -> Vec<Option<Nearest>> {
        let reach = within.iter().fold(0.0, |a: f64, b| a.max(*b)).min(ANYWHERE);
        let mut contacts = Vec::new();
        self.scheme.body_contacts(&points_of(points), reach, &mut contacts);
        let mut near = vec![None; points.len()];
        for c in contacts {
            let i = c.vertex as usize;
            if c.distance.abs() < within[i] {
                near[i] = Some(nearest(&c));
            }
        }
        near
    }

    fn guard(&self, points: &[Vector3<f64>], moves: &mut [Vector3<f64>], gaps: &[f64]) {
        let from = points_of(points);
        let to: Vec<Point3> = from.iter().zip(moves.iter()).map(|(p, m)| p + m).collect();
        let mut hits = Vec::new();
        self.scheme.body_hits(&from, &to, &mut hits);
        for h in hits {
            let i = h.vertex as usize;
            moves[i] = h.point.coords + h.normal * gaps[i] - points[i];
        }
    }

    fn reach(&self, direction: &Vector3<f64>) -> Option<f64> {
        let mut at = Point3::origin();
        for _ in 0..LOOKS {
            let mut found = Vec::new();
            self.scheme.body_contacts(&[at + direction * FAR], f64::MAX.sqrt(), &mut found);
            at = found.first()?.point;
        }
        Some(at.coords.dot(direction))
    }

    fn sharp(&self) -> Option<Arc<Sharp>> {
        let find = || self.mesh().and_then(|(x, triangles)| Sharp::of(&x, triangles)).map(Arc::new);
        self.sharp.get_or_init(find).clone()
    }

    fn facets(&self) -> Option<&Facets> {
        let find = || self.mesh().and_then(|(x, triangles)| Facets::of(&x, triangles));
        self.facets.get_or_init(find).as_ref()
    }
}

fn nearest(c: &BodyContact) -> Nearest {
    Nearest { distance: c.distance, normal: c.normal, point: c.point.coords }
}

fn points_of(points: &[Vector3<f64>]) -> Vec<Point3> {
    points.iter().map(|p| Point3::from(*p)).collect()
}

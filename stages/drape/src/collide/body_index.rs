//! The body's skin as a collider answers for it: contacts of many vertices, and paths that enter.
//!
//! Distances and paths are those of a [`BodySkin`]; most vertices never reach its tree: a
//! lattice of distances sorts them out. O(log n) a query. The mesh must have passed
//! [`check_body`](super::check_body).

use super::asked_distances::Distances;
use super::points::{self, coords};
use super::search::BodySkin;
use rayon::prelude::*;
use toile_core::artifact::{Body, BodyContact, Point3, Surface};
use toile_core::{Context, StageError};
use toile_geometry::Vec3;
use toile_geometry::lattice::DistanceLattice;

/// Vertices that one parallel task takes at least.
const CHUNK: usize = 128;

/// The skin of a body.
#[derive(Debug)]
pub struct BodyIndex<S> {
    skin: S,
    lattice: DistanceLattice,
}

impl<S: BodySkin> BodyIndex<S> {
    /// The index of a body that has passed its checks.
    pub fn new(body: &Body, distances: Distances, cx: &Context) -> Result<Self, StageError> {
        let vertices = coords(&body.positions);
        let lattice = DistanceLattice::around(vertices);
        let skin = S::over(vertices.to_vec(), body.triangles.clone());
        cx.check()?;
        let index = BodyIndex { skin, lattice };
        if distances == Distances::Ahead {
            index.lattice.fill(|| cx.check(), |p, bound| index.distance_within(p, bound))?;
        }
        Ok(index)
    }

    /// The mesh that it was made of.
    pub fn surface(&self) -> Surface<'_> {
        Surface { positions: points::of(self.skin.vertices()), triangles: self.skin.triangles() }
    }

    fn distance_within(&self, p: &Vec3, bound: f64) -> Option<f64> {
        self.skin.nearest(p, bound).map(|s| s.distance)
    }

    fn bounds(&self, p: &Vec3) -> Option<(f64, f64)> {
        self.lattice.bounds(p, |p, bound| self.distance_within(p, bound))
    }

    /// Signed distance of a point, metres; infinite where it is no finite number.
    pub fn signed_distance(&self, p: &Point3) -> f64 {
        self.skin.distance(&p.coords)
    }

    /// The vertices within `reach` of the skin or inside, ascending.
    pub fn contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        let contact = |(i, p): (usize, &Vec3)| {
            let (least, most) = self.bounds(p)?;
            if least > reach {
                return None;
            }
            // The skin is no farther than the lattice says; outside, no farther than it matters.
            let bound = if least > 0.0 { most.min(reach) } else { most.max(-least).max(reach) };
            let on = self.skin.nearest(p, bound).filter(|s| s.distance <= reach)?;
            let point = Point3::from(on.point);
            Some(BodyContact { vertex: i as u32, point, normal: on.normal, distance: on.distance })
        };
        out.extend(collect(coords(positions).par_iter().enumerate().with_min_len(CHUNK).map(contact)));
    }

    /// The first places where paths enter the body, ascending.
    pub fn hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        let hit = |(i, (p, q)): (usize, (&Vec3, &Vec3))| {
            let (least, _) = self.bounds(p)?;
            if least > (q - p).norm() {
                return None;
            }
            let entry = self.skin.entry(p, q)?;
            let point = Point3::from(p + (q - p) * entry.share);
            let distance = self.skin.distance(q);
            Some(BodyContact { vertex: i as u32, point, normal: entry.normal, distance })
        };
        let paths = coords(from).par_iter().zip(coords(to));
        out.extend(collect(paths.enumerate().with_min_len(CHUNK).map(hit)));
    }
}

/// Gathers what was found in the order of the vertices.
fn collect<I: ParallelIterator<Item = Option<BodyContact>>>(found: I) -> Vec<BodyContact> {
    found.flatten_iter().collect()
}

#[cfg(test)]
mod tests;

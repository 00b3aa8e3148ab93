//! The collision service: a body's skin, the search of cloth near itself, and the settings.

use super::asked_distances::Distances;
use super::body_index::BodyIndex;
use super::points::coords;
use super::search::{BodySkin, ClothSearch};
use super::self_collision::{SearchedCloth, search, usable};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use toile_core::artifact::{Body, BodyContact, Collide, ColliderCard, Point3, SelfContact, Surface};
use toile_core::{Context, StageError};
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::signed_distance::SignedDistance;

/// Searches kept for the next query: one per garment is enough, a few let garments run side by
/// side.
const POOL: usize = 4;

/// Collisions by hierarchies of one kind of volume.
pub type BvhScheme<V> = KernelScheme<SignedDistance<V>, ClothTree<V>>;

/// Collisions by one kind of skin and one kind of search.
#[derive(Debug)]
pub struct KernelScheme<S, C> {
    card: ColliderCard,
    body: Option<BodyIndex<S>>,
    landmarks: BTreeMap<String, Point3>,
    // A query takes a search out and puts it back, and works on it outside the lock.
    pool: Mutex<Vec<KeptSearch<C>>>,
}

/// A search with the cloth that it was made for.
#[derive(Debug)]
struct KeptSearch<C> {
    vertices: usize,
    triangles: Vec<[u32; 3]>,
    usable: Vec<(u32, [u32; 3])>,
    search: C,
}

impl<S: BodySkin, C: ClothSearch> KernelScheme<S, C> {
    /// The scheme for a body that has passed its checks, or for cloth alone.
    pub fn new(
        card: ColliderCard,
        body: Option<&Body>,
        distances: Distances,
        cx: &Context,
    ) -> Result<Self, StageError> {
        let landmarks = body.map(|b| b.landmarks.clone()).unwrap_or_default();
        let body = body.map(|b| BodyIndex::new(b, distances, cx)).transpose()?;
        Ok(KernelScheme { card, body, landmarks, pool: Mutex::default() })
    }

    /// What `f` makes of the cloth, with a search that was kept for the same triangles or is made
    /// for it.
    fn with_cloth<T>(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        f: impl FnOnce(&SearchedCloth<'_, C>) -> T,
    ) -> T {
        let x = coords(positions);
        let kept = self.lock().pop().filter(|k| k.vertices == x.len() && k.triangles == triangles);
        let kept = kept.unwrap_or_else(|| {
            let usable = usable(triangles, x.len());
            let search = search(x, &usable);
            KeptSearch { vertices: x.len(), triangles: triangles.to_vec(), usable, search }
        });
        let result = f(&SearchedCloth { x, usable: &kept.usable, search: &kept.search });
        let mut pool = self.lock();
        if pool.len() < POOL {
            pool.push(kept);
        }
        result
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<KeptSearch<C>>> {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<S: BodySkin, C: ClothSearch> Collide for KernelScheme<S, C> {
    fn card(&self) -> ColliderCard {
        self.card
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        if let Some(body) = &self.body {
            body.contacts(positions, reach, out);
        }
    }

    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        if let Some(body) = &self.body {
            body.hits(from, to, out);
        }
    }

    fn self_contacts(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        reach: f64,
        out: &mut Vec<SelfContact>,
    ) {
        self.with_cloth(positions, triangles, |cloth| cloth.contacts(reach, out));
    }

    fn conservative_bounds(&self, positions: &[Point3], triangles: &[[u32; 3]], reach: f64) -> Vec<f64> {
        self.with_cloth(positions, triangles, |cloth| cloth.conservative_bounds(reach))
    }

    fn self_crossings(&self, positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        self.with_cloth(positions, triangles, |cloth| cloth.crossings())
    }

    fn surface(&self) -> Option<Surface<'_>> {
        self.body.as_ref().map(BodyIndex::surface)
    }

    fn landmarks(&self) -> Option<&BTreeMap<String, Point3>> {
        Some(&self.landmarks)
    }
}

#[cfg(test)]
mod tests;

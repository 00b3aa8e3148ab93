//! The collision service: a body's skin, the cloth's hierarchy, and the settings.

use super::asked_distances::Distances;
use super::body_index::BodyIndex;
use super::cloth_tree::ClothTree;
use super::volume::BoundingVolume;
use super::{crossing, self_collision};
use std::sync::{Mutex, PoisonError};
use toile_core::artifact::{Body, BodyContact, Collide, ColliderCard, Point3, SelfContact, Surface};
use toile_core::{Context, StageError};

/// Trees kept for the next query: one a garment is enough, a few let garments run side by side.
const POOL: usize = 4;

/// Collisions by hierarchies of one kind of volume.
#[derive(Debug)]
pub struct BvhScheme<V> {
    card: ColliderCard,
    body: Option<BodyIndex<V>>,
    // A query takes a tree out and puts it back, and works on it outside the lock.
    pool: Mutex<Vec<ClothTree<V>>>,
}

impl<V: BoundingVolume> BvhScheme<V> {
    /// The scheme for a body that has passed its checks, or for cloth alone.
    pub fn new(
        card: ColliderCard,
        body: Option<&Body>,
        distances: Distances,
        cx: &Context,
    ) -> Result<Self, StageError> {
        let body = body.map(|b| BodyIndex::new(b, distances, cx)).transpose()?;
        Ok(BvhScheme { card, body, pool: Mutex::default() })
    }

    /// The body's skin.
    pub fn body(&self) -> Option<&BodyIndex<V>> {
        self.body.as_ref()
    }

    /// How many pairs of volumes a search for self-contacts tests, and how many pairs of features it
    /// finds: what the choice of the volume trades.
    pub fn count_tests(&self, positions: &[Point3], triangles: &[[u32; 3]], reach: f64) -> (u64, usize) {
        self.with_tree(positions, triangles, |tree| self_collision::count_tests(tree, positions, reach))
    }

    fn with_tree<T>(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        f: impl FnOnce(&ClothTree<V>) -> T,
    ) -> T {
        let kept = self.lock().pop();
        let tree = match kept {
            Some(tree) => tree.updated(positions, triangles),
            None => ClothTree::build(positions, triangles),
        };
        let result = f(&tree);
        let mut pool = self.lock();
        if pool.len() < POOL {
            pool.push(tree);
        }
        result
    }

    /// As [`Self::with_tree`] for what is asked once: a tree that had to be built for it is not kept.
    fn with_passing_tree<T>(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        f: impl FnOnce(&ClothTree<V>) -> T,
    ) -> T {
        // Not in the scrutinee, whose lock would be held below.
        let none = self.lock().is_empty();
        match none {
            true => f(&ClothTree::build(positions, triangles)),
            false => self.with_tree(positions, triangles, f),
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<ClothTree<V>>> {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<V: BoundingVolume> Collide for BvhScheme<V> {
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
        self.with_tree(positions, triangles, |tree| self_collision::contacts(tree, positions, reach, out));
    }

    fn conservative_bounds(&self, positions: &[Point3], triangles: &[[u32; 3]], reach: f64) -> Vec<f64> {
        self.with_tree(positions, triangles, |tree| {
            self_collision::conservative_bounds(tree, positions, reach)
        })
    }

    fn self_crossings(&self, positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        self.with_passing_tree(positions, triangles, |tree| crossing::crossings(tree, positions))
    }

    fn surface(&self) -> Option<Surface<'_>> {
        self.body.as_ref().map(BodyIndex::surface)
    }
}

#[cfg(test)]
mod tests;

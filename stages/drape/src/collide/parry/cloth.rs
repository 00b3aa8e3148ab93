//! Cloth near itself by parry3d's tree of boxes.
//!
//! The tree is built once, where the cloth first lies; a query copies it, fits the boxes to where
//! the cloth is, and looks from every triangle. O(n log n + pairs). The order in which parry3d
//! finds pairs does not matter: they are sorted.

use super::super::search::ClothSearch;
use super::boxed;
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use rayon::prelude::*;
use toile_geometry::Vec3;
use toile_geometry::cloth_tree::features::Features;
use toile_geometry::pair::Pair;

/// Triangles that one parallel task takes at least.
const CHUNK: usize = 128;

/// A cloth on parry3d's tree.
#[derive(Debug)]
pub struct ParryCloth {
    triangles: Vec<[u32; 3]>,
    features: Features,
    tree: Bvh,
}

impl ParryCloth {
    fn boxes(&self, x: &[Vec3]) -> Vec<Aabb> {
        self.triangles.iter().map(|t| boxed(&t.map(|v| x[v as usize]), 0.0)).collect()
    }

    /// Pairs of triangles whose boxes are within `reach`, lower number first.
    fn met(&self, x: &[Vec3], reach: f64) -> Vec<[u32; 2]> {
        if self.triangles.is_empty() {
            return Vec::new();
        }
        let boxes = self.boxes(x);
        let mut tree = self.tree.clone();
        for (t, frame) in (0..).zip(&boxes) {
            tree.update_partially_if_present(*frame, t, 0.0);
        }
        tree.refit_without_opt();
        let about = |s: usize| {
            let wide = boxes[s].loosened(reach.max(0.0));
            let found: Vec<u32> = tree.intersect_aabb(&wide).filter(|t| *t as usize > s).collect();
            found.into_iter().map(move |t| [s as u32, t])
        };
        (0..boxes.len()).into_par_iter().with_min_len(CHUNK).flat_map_iter(about).collect()
    }
}

impl ClothSearch for ParryCloth {
    fn over(x: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let features = Features::of(triangles.to_vec(), x.len());
        let mut cloth = ParryCloth { triangles: triangles.to_vec(), features, tree: Bvh::new() };
        cloth.tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &cloth.boxes(x));
        cloth
    }

    fn pairs(&self, x: &[Vec3], reach: f64) -> Vec<Pair> {
        self.features.pairs_among(&self.met(x, reach), x, reach)
    }

    fn crossings(&self, x: &[Vec3]) -> Vec<[u32; 2]> {
        let mut found = self.met(x, 0.0);
        found.retain(|[s, t]| self.features.cross(*s as usize, *t as usize, x));
        found.sort_unstable();
        found
    }
}

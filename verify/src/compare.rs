//! Two garments of one pattern side by side.
//!
//! Panels of one name whose triangles name the same corners in the same order are compared vertex
//! by vertex; other panels by the distance of each vertex to the other garment's surface and the
//! other way round. Both garments stand where their files put them; none is moved. Cost:
//! O(n log n).

use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use toile_core::artifact::{Garment, GarmentPanel, Point3, quantile};
use toile_geometry::closest::on_triangle;
use toile_geometry::tree::Bvh;
use toile_geometry::volume::Aabb;
use toile_geometry::{Corners, Vec3};

/// How a panel was compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum ComparedBy {
    /// Vertex by vertex.
    #[serde(rename = "vertices")]
    Vertices,
    /// By the distance of the surfaces.
    #[serde(rename = "surfaces")]
    Surfaces,
}

/// The difference of one panel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PanelDifference {
    /// How it was compared.
    pub by: ComparedBy,
    /// Median, metres.
    pub p50_m: f64,
    /// 99th percentile, metres.
    pub p99_m: f64,
    /// The greatest, metres.
    pub max_m: f64,
    /// Where the greatest is on the first garment, metres.
    pub at: [f64; 3],
}

/// What differs.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct GarmentDifference {
    /// Panels of both, by name.
    pub panels: BTreeMap<String, PanelDifference>,
    /// Panels of the first alone.
    pub only_first: Vec<String>,
    /// Panels of the second alone.
    pub only_second: Vec<String>,
}

impl GarmentDifference {
    /// The panel that differs most.
    #[must_use]
    pub fn worst(&self) -> Option<(&str, &PanelDifference)> {
        let all = self.panels.iter().map(|(n, d)| (n.as_str(), d));
        all.reduce(|a, b| if b.1.max_m > a.1.max_m { b } else { a })
    }
}

/// Compares two garments.
#[must_use]
pub fn compare(one: &Garment, other: &Garment) -> GarmentDifference {
    let named = |g: &Garment, name: &str| g.panels.iter().position(|p| p.name == name);
    let mut difference = GarmentDifference::default();
    let (first, second) = (SurfaceTree::of(one), SurfaceTree::of(other));
    for p in &one.panels {
        match named(other, &p.name) {
            None => difference.only_first.push(p.name.clone()),
            Some(k) => {
                let q = &other.panels[k];
                let (by, far) = match corresponds(one, p, other, q) {
                    true => (ComparedBy::Vertices, vertexwise(one, p, other, q)),
                    false => (ComparedBy::Surfaces, [second.far(one, p), first.far(other, q)].concat()),
                };
                difference.panels.extend(summary(by, far).map(|d| (p.name.clone(), d)));
            }
        }
    }
    let strange = other.panels.iter().filter(|p| named(one, &p.name).is_none());
    difference.only_second = strange.map(|p| p.name.clone()).collect();
    difference
}

/// Whether the triangles of both name the same corners in the same order.
fn corresponds(one: &Garment, p: &GarmentPanel, other: &Garment, q: &GarmentPanel) -> bool {
    let own = |g: &Garment, p: &GarmentPanel| -> Vec<[u32; 3]> {
        let first = p.vertices.start as u32;
        g.triangles[p.triangles.clone()].iter().map(|t| t.map(|v| v - first)).collect()
    };
    p.vertices.len() == q.vertices.len() && own(one, p) == own(other, q)
}

fn vertexwise(one: &Garment, p: &GarmentPanel, other: &Garment, q: &GarmentPanel) -> Vec<(f64, Point3)> {
    let pairs = one.positions[p.vertices.clone()].iter().zip(&other.positions[q.vertices.clone()]);
    pairs.map(|(a, b)| ((a - b).norm(), *a)).collect()
}

fn summary(by: ComparedBy, far: Vec<(f64, Point3)>) -> Option<PanelDifference> {
    let (max_m, at) = far.iter().copied().reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    let mut sorted: Vec<f64> = far.iter().map(|f| f.0).collect();
    sorted.sort_by(f64::total_cmp);
    let [p50_m, p99_m] = [0.5, 0.99].map(|q| quantile(&sorted, q));
    Some(PanelDifference { by, p50_m, p99_m, max_m, at: at.coords.into() })
}

/// A garment's triangles in a tree.
struct SurfaceTree {
    corners: Vec<Corners>,
    tree: Bvh<Aabb>,
}

impl SurfaceTree {
    fn of(garment: &Garment) -> Self {
        let corners: Vec<Corners> =
            garment.triangles.iter().map(|t| t.map(|v| garment.positions[v as usize].coords)).collect();
        Self { tree: Bvh::new(&corners, 4), corners }
    }

    /// The distance of each vertex of a panel.
    fn far(&self, garment: &Garment, panel: &GarmentPanel) -> Vec<(f64, Point3)> {
        let one = |p: &Point3| (self.distance(&p.coords), *p);
        garment.positions[panel.vertices.clone()].par_iter().map(one).collect()
    }

    fn distance(&self, p: &Vec3) -> f64 {
        let mut least = f64::INFINITY;
        self.tree.nearest(p, f64::INFINITY, |t, bound| {
            let far = (on_triangle(p, &self.corners[t as usize]).point - p).norm_squared();
            least = least.min(far);
            bound.min(far)
        });
        least.sqrt()
    }
}

//! How far two drapes of one garment are from each other.
//!
//! Two measures, both over points spread evenly over the cloth:
//!
//! - *distance*: from each point of either surface to the nearest point of the other (both ways,
//!   all points together): what an eye sees; cloth that slides in itself costs nothing;
//! - *displacement*: between the two places of the same point of the flat pattern: what the solver
//!   did.
//!
//! Points are stratified by area (the i-th of n at share (i + 1/2) / n of the area) with a
//! golden-ratio sequence inside the triangles, so the same surface gives the same points on every
//! machine. Closest points come from parry3d.
//!
//! Cost: O(n log t). Limits: a flat point outside the other mesh (its boundary is made of other
//! chords) takes the nearest point of that mesh; shares of the surface are known to 1/n.

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::TriMesh;
use rayon::prelude::*;
use toile_core::StageError;
use toile_core::artifact::{Garment, GarmentPanel, Point2, Point3, quantile};

/// Points on each surface: shares are good to 0.02 %, and the whole takes some tens of
/// milliseconds.
pub const POINTS: usize = 6000;

/// Distances over a surface, metres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// 95 % are not farther.
    pub p95: f64,
    /// Worst.
    pub max: f64,
}

impl Spread {
    /// Of distances in any order; zero of none.
    pub fn of(mut distances: Vec<f64>) -> Self {
        distances.sort_by(f64::total_cmp);
        let mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
        Spread { mean, p95: quantile(&distances, 0.95), max: distances.last().copied().unwrap_or(0.0) }
    }
}

/// A point of the cloth: its triangle and the weights of the triangle's corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothPoint {
    /// Triangle.
    pub triangle: usize,
    /// Weights, sum 1.
    pub weights: [f64; 3],
}

/// A drape prepared for questions.
pub struct DrapedSurface<'a> {
    /// The garment.
    pub garment: &'a Garment,
    space: TriMesh,
    flat: Vec<TriMesh>,
}

impl<'a> DrapedSurface<'a> {
    /// Prepares a garment.
    ///
    /// Errors: a garment or panel without triangles.
    pub fn new(garment: &'a Garment) -> Result<Self, StageError> {
        let space = mesh(garment.positions.iter().map(in_space).collect(), garment.triangles.clone())?;
        let flat = garment.panels.iter().map(|p| flat_mesh(garment, p)).collect::<Result<_, _>>()?;
        Ok(DrapedSurface { garment, space, flat })
    }

    /// Points spread evenly over the flat pattern.
    pub fn spots(&self, count: usize) -> Vec<ClothPoint> {
        let rest = |i: u32| self.garment.rest[i as usize];
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(rest);
            (b - a).perp(&(c - a)).abs() / 2.0
        };
        let mut sum = 0.0;
        let sums: Vec<f64> = self
            .garment
            .triangles
            .iter()
            .map(|t| {
                sum += area(t);
                sum
            })
            .collect();
        let spot = |i: usize| {
            let at = (i as f64 + 0.5) / count as f64 * sum;
            ClothPoint { triangle: sums.partition_point(|s| *s < at).min(sums.len() - 1), weights: inside(i) }
        };
        (0..count).map(spot).collect()
    }

    /// Where a spot is in space.
    pub fn place(&self, spot: &ClothPoint) -> Point3 {
        let corners =
            self.garment.triangles[spot.triangle].map(|i| self.garment.positions[i as usize].coords);
        Point3::from((0..3).map(|k| corners[k] * spot.weights[k]).sum::<toile_core::artifact::Vector3>())
    }

    /// The panel of a spot, and where the spot is in it, flat.
    pub fn flat_place(&self, spot: &ClothPoint) -> Option<(usize, Point2)> {
        let panel = self.garment.panels.iter().position(|p| p.triangles.contains(&spot.triangle))?;
        let corners = self.garment.triangles[spot.triangle].map(|i| self.garment.rest[i as usize].coords);
        let at = (0..3).map(|k| corners[k] * spot.weights[k]).sum::<toile_core::artifact::Vector2>();
        Some((panel, Point2::from(at)))
    }

    /// Distance to the nearest point of the surface, metres.
    pub fn distance(&self, p: &Point3) -> f64 {
        let (near, _) = self.space.project_local_point_and_get_location(in_space(p), true);
        (near.point - in_space(p)).length()
    }

    /// The spot of this cloth at a flat point of the panel with that name.
    pub fn spot_at(&self, panel: &str, at: &Point2) -> Option<ClothPoint> {
        let k = self.garment.panels.iter().position(|p| p.name == panel)?;
        let (_, (triangle, location)) = self.flat[k].project_local_point_and_get_location(flat(at), true);
        let first = self.garment.panels[k].triangles.start;
        Some(ClothPoint { triangle: first + triangle as usize, weights: location.barycentric_coordinates()? })
    }
}

/// Distances between two drapes, both ways.
pub fn distance(a: &DrapedSurface<'_>, b: &DrapedSurface<'_>) -> Spread {
    let one_way = |from: &DrapedSurface<'_>, to: &DrapedSurface<'_>| -> Vec<f64> {
        from.spots(POINTS).par_iter().map(|s| to.distance(&from.place(s))).collect()
    };
    let mut distances = one_way(a, b);
    distances.extend(one_way(b, a));
    Spread::of(distances)
}

/// Spots of `b` with the spots of `a` that are the same points of the pattern.
pub fn pairs(a: &DrapedSurface<'_>, b: &DrapedSurface<'_>) -> Vec<(ClothPoint, ClothPoint)> {
    let pair = |of_b: &ClothPoint| {
        let (panel, at) = b.flat_place(of_b)?;
        Some((a.spot_at(&b.garment.panels[panel].name, &at)?, *of_b))
    };
    b.spots(POINTS).par_iter().filter_map(pair).collect()
}

/// Displacement between the places of the same points of the pattern.
pub fn displacement(a: &DrapedSurface<'_>, b: &DrapedSurface<'_>) -> Spread {
    Spread::of(pairs(a, b).iter().map(|(of_a, of_b)| (a.place(of_a) - b.place(of_b)).norm()).collect())
}

fn flat_mesh(garment: &Garment, panel: &GarmentPanel) -> Result<TriMesh, StageError> {
    let first = panel.vertices.start as u32;
    let triangles = garment.triangles[panel.triangles.clone()].iter().map(|t| t.map(|i| i - first)).collect();
    mesh(garment.rest[panel.vertices.clone()].iter().map(flat).collect(), triangles)
}

fn mesh(points: Vec<Vector>, triangles: Vec<[u32; 3]>) -> Result<TriMesh, StageError> {
    TriMesh::new(points, triangles)
        .map_err(|_| StageError::invalid("there is a garment or panel without triangles"))
}

// parry3d's own vectors: these two functions are the border.
fn in_space(p: &Point3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

fn flat(p: &Point2) -> Vector {
    Vector::new(p.x, p.y, 0.0)
}

/// Weights of the i-th point in its triangle: the golden-ratio sequence of the unit square (Roberts
/// 2018), folded.
fn inside(i: usize) -> [f64; 3] {
    /// Inverse powers of the plastic number.
    const STEP: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let [mut u, mut v] = STEP.map(|s| (0.5 + s * i as f64).fract());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    [1.0 - u - v, u, v]
}

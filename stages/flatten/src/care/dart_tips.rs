//! Where a dart may end: the places of most strain and of most curvature.
//!
//! Strain energy of triangles, and the angle that is missing around each inner vertex (its Gaussian
//! curvature), are gathered at the vertices and spread over a neighbourhood, so that neither a
//! sliver nor the mesh's fineness decides. A dart that was sewn shut is a point of curvature: its
//! tip.

use super::dart_path::Ways;
use crate::distortion::TriangleStrain;
use crate::surface::PieceSurface;
use std::f64::consts::TAU;

/// The neighbourhood's radius as a share of the root of the area.
const RADIUS: f64 = 0.03;

/// Most rounds of spreading.
const MOST_ROUNDS: usize = 400;

/// Values at vertices, with the area that each stands for.
struct VertexValues<'a> {
    ways: &'a Ways<'a>,
    areas: Vec<f64>,
    rounds: usize,
}

/// The inner vertices of most spread strain and of most spread curvature, and the largest spread
/// strain.
pub(super) fn tips(surface: &PieceSurface, ways: &Ways<'_>, strains: &[TriangleStrain]) -> (Vec<u32>, f64) {
    let field = VertexValues::new(surface, ways);
    let energy =
        field.spread(gathered(surface, |t| strains[t].principal.powi(2) * surface.area_vector(t).norm()));
    let curvature = field.spread(missing_angles(surface, ways));
    let largest = energy.iter().fold(0.0, |m: f64, e| m.max(*e)).sqrt();
    let mut tips = vec![highest(ways, &energy), highest(ways, &curvature)];
    tips.dedup();
    (tips.into_iter().flatten().collect(), largest)
}

impl<'a> VertexValues<'a> {
    fn new(surface: &PieceSurface, ways: &'a Ways<'a>) -> Self {
        let areas = gathered(surface, |t| surface.area_vector(t).norm());
        let edge = (surface.area() / surface.triangles().len() as f64).sqrt() * 1.5;
        let radius = RADIUS * surface.area().sqrt();
        let rounds = ((radius / edge).powi(2).ceil() as usize).clamp(1, MOST_ROUNDS);
        Self { ways, areas, rounds }
    }

    /// Spreads sums at vertices over their neighbours; returns them by area, absolute.
    fn spread(&self, mut sums: Vec<f64>) -> Vec<f64> {
        let degree = |v: u32| self.ways.neighbours(v).len() as f64;
        for _ in 0..self.rounds {
            let given = |v: u32| sums[v as usize] / (2.0 * degree(v));
            let next = (0..sums.len() as u32).map(|v| {
                let from: f64 = self.ways.neighbours(v).iter().map(|&u| given(u)).sum();
                sums[v as usize] / 2.0 + from
            });
            sums = next.collect();
        }
        sums.iter().zip(&self.areas).map(|(s, a)| (s / a).abs()).collect()
    }
}

/// A third of each triangle's value at each of its corners.
fn gathered(surface: &PieceSurface, of: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sums = vec![0.0; surface.positions().len()];
    for (t, corners) in surface.triangles().iter().enumerate() {
        corners.iter().for_each(|&v| sums[v as usize] += of(t) / 3.0);
    }
    sums
}

/// A full turn less the angles around each inner vertex; 0 on the boundary.
fn missing_angles(surface: &PieceSurface, ways: &Ways<'_>) -> Vec<f64> {
    let x = surface.positions();
    let mut missing = vec![TAU; x.len()];
    for corners in surface.triangles() {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3] as usize);
            missing[a] -= (x[b] - x[a]).angle(&(x[c] - x[a]));
        }
    }
    (0..x.len() as u32).map(|v| if ways.is_on_boundary(v) { 0.0 } else { missing[v as usize] }).collect()
}

fn highest(ways: &Ways<'_>, values: &[f64]) -> Option<u32> {
    let inner = (0..values.len() as u32).filter(|&v| !ways.is_on_boundary(v));
    inner.max_by(|&a, &b| values[a as usize].total_cmp(&values[b as usize]))
}

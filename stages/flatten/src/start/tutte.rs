//! The barycentric embedding (Tutte 1963) with the weights of Floater (1997) in symmetric form.
//!
//! The outer boundary goes to a circle by its edge lengths; each inner vertex is the weighted mean
//! of its neighbours. A hole gets a vertex of its own, joined to its rim, so the surface is a disk
//! and the theorem holds: with weights above zero no triangle flips. Weights: cotangents as far as
//! they are above zero; if rounding still flips a triangle, all weights 1. Cost: one or two factors
//! of n unknowns.

use crate::error::FlattenError;
use crate::frames::{TriangleFrames, flipped};
use crate::linear::{CholeskyFactor, Graph, elimination_order, slot};
use crate::surface::PieceSurface;
use nalgebra::{Point2, Point3};

/// The least weight of a coupling, against 1 of a right isosceles triangle's leg.
const LEAST_WEIGHT: f64 = 0.05;

/// Flat places with the outer boundary on the unit circle.
///
/// # Errors
/// [`FlattenError::Factorization`] if the system has no factor.
pub(super) fn tutte(
    surface: &PieceSurface,
    frames: &TriangleFrames,
) -> Result<Vec<Point2<f64>>, FlattenError> {
    let disk = Disk::new(surface);
    let mut flat = disk.embed(surface, |t, k| cotangent(frames, t, k))?;
    if !flipped(surface.triangles(), &flat).is_empty() {
        flat = disk.embed(surface, |_, _| 1.0)?;
    }
    Ok(flat)
}

/// The surface with its holes filled.
struct Disk {
    triangles: Vec<[u32; 3]>,
    graph: Graph,
    order: Vec<u32>,
}

impl Disk {
    fn new(surface: &PieceSurface) -> Self {
        let mut places = surface.positions().to_vec();
        let mut triangles = surface.triangles().to_vec();
        for rim in &surface.loops()[1..] {
            let middle = places.len() as u32;
            let sum = rim.iter().fold(nalgebra::Vector3::zeros(), |s, &v| s + places[v as usize].coords);
            places.push(Point3::from(sum / rim.len() as f64));
            let next = rim.iter().cycle().skip(1);
            triangles.extend(rim.iter().zip(next).map(|(&a, &b)| [b, a, middle]));
        }
        let graph = Graph::new(places.len(), &triangles, &[]);
        let order = elimination_order(&graph, &places);
        Self { triangles, graph, order }
    }

    /// Solves for weights by triangle and corner, each that of the edge across from the corner.
    fn embed(
        &self,
        surface: &PieceSurface,
        weight: impl Fn(usize, usize) -> f64,
    ) -> Result<Vec<Point2<f64>>, FlattenError> {
        let n = self.graph.vertices();
        let mut places: Vec<Option<Point2<f64>>> = vec![None; n];
        for (v, p) in circle(surface) {
            places[v as usize] = Some(p);
        }
        let mut values = vec![0.0; n + self.graph.pairs()];
        let mut right = vec![0.0; 2 * n];
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let w = if t < surface.triangles().len() { weight(t, k) } else { 1.0 };
                let pair = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                self.couple(&mut values, &mut right, &places, pair, w);
            }
        }
        for (v, p) in places.iter().enumerate() {
            if let Some(p) = p {
                values[slot(&self.graph, v)] = 1.0;
                (right[v], right[n + v]) = (p.x, p.y);
            }
        }
        let mut factor = CholeskyFactor::analyse(&self.graph, 1, &self.order)?;
        factor.factor(&values)?;
        factor.solve(&mut right)?;
        Ok((0..surface.positions().len()).map(|v| Point2::new(right[v], right[n + v])).collect())
    }

    fn couple(
        &self,
        values: &mut [f64],
        right: &mut [f64],
        places: &[Option<Point2<f64>>],
        [a, b]: [u32; 2],
        w: f64,
    ) {
        let n = self.graph.vertices();
        for (v, other) in [(a, b), (b, a)] {
            let v = v as usize;
            values[slot(&self.graph, v)] += w;
            if let Some(p) = places[other as usize] {
                right[v] += w * p.x;
                right[n + v] += w * p.y;
            }
        }
        if places[a as usize].is_none() && places[b as usize].is_none() {
            let low = a.min(b) as usize;
            let k = self.graph.pair(a, b).map_or(0, |p| p - self.graph.start(low));
            values[slot(&self.graph, low) + 1 + k] -= w;
        }
    }
}

/// The outer boundary on the unit circle, each edge with its share of the length.
fn circle(surface: &PieceSurface) -> Vec<(u32, Point2<f64>)> {
    let outline = &surface.loops()[0];
    let place = |v: u32| surface.positions()[v as usize];
    let next = outline.iter().cycle().skip(1);
    let lengths: Vec<f64> = outline.iter().zip(next).map(|(&a, &b)| (place(b) - place(a)).norm()).collect();
    let whole: f64 = lengths.iter().sum();
    let mut gone = 0.0;
    let mut placed = Vec::with_capacity(outline.len());
    for (&v, length) in outline.iter().zip(&lengths) {
        let angle = std::f64::consts::TAU * gone / whole;
        placed.push((v, Point2::new(angle.cos(), angle.sin())));
        gone += length;
    }
    placed
}

/// The cotangent of the angle at corner `k`, at least [`LEAST_WEIGHT`].
fn cotangent(frames: &TriangleFrames, t: usize, k: usize) -> f64 {
    let g = frames.gradients(t);
    // The gradients are at right angles to the opposite edges: g_i . g_j = -cot / (2 area).
    let cot = -2.0 * frames.share(t) * g[(k + 1) % 3].dot(&g[(k + 2) % 3]);
    cot.max(LEAST_WEIGHT)
}

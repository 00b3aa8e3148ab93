//! Least squares conformal maps (Lévy, Petitjean, Ray, Maillot 2002), as one Hermitian system of
//! one complex number per vertex.
//!
//! With `z = x + i y` and `w_k = g_k.x + i g_k.y` of the hat functions' gradients, a triangle's map
//! is conformal where `sum_k w_k z_k = 0`; minimised is the sum over triangles of area times the
//! square of that. Two far boundary vertices are held. Free boundary, holes allowed. No size of its
//! own, and no promise against flips. Cost: one factor of n complex unknowns.

use crate::error::FlattenError;
use crate::frames::TriangleFrames;
use crate::linear::{CholeskyFactor, slot};
use crate::surface::PieceSurface;
use crate::system::PieceSystem;
use faer::c64;
use nalgebra::{Point2, Point3};

/// Flat places by conformal maps; the size is arbitrary.
///
/// # Errors
/// [`FlattenError::Factorization`] if the system has no factor.
pub(super) fn lscm_map(
    surface: &PieceSurface,
    system: &PieceSystem,
    frames: &TriangleFrames,
) -> Result<Vec<Point2<f64>>, FlattenError> {
    let graph = system.graph();
    let mut values = vec![c64::new(0.0, 0.0); graph.vertices() + graph.pairs()];
    for (t, corners) in system.triangles().iter().enumerate() {
        let w = frames.gradients(t).map(|g| c64::new(g.x, g.y));
        for k in 0..3 {
            let (i, j) = (corners[k], corners[(k + 1) % 3]);
            values[slot(graph, i as usize)] += w[k] * w[k].conj() * frames.share(t);
            // The entry in the row of the higher and the column of the lower vertex.
            let (high, low) = if i > j { (w[k], w[(k + 1) % 3]) } else { (w[(k + 1) % 3], w[k]) };
            let at = slot(graph, i.min(j) as usize) + 1 + place(system, i, j);
            values[at] += high.conj() * low * frames.share(t);
        }
    }
    let held = far_apart(surface);
    let places = [c64::new(0.0, 0.0), c64::new(1.0, 0.0)];
    let mut z = hold(system, &mut values, held, places);
    let mut factor = CholeskyFactor::analyse(graph, 1, system.order())?;
    factor.factor(&values)?;
    factor.solve(&mut z)?;
    Ok(z.iter().map(|z| Point2::new(z.re, z.im)).collect())
}

/// Which of the lower vertex's pairs this is.
fn place(system: &PieceSystem, i: u32, j: u32) -> usize {
    let graph = system.graph();
    graph.pair(i, j).map_or(0, |p| p - graph.start(i.min(j) as usize))
}

/// Replaces the rows and columns of held vertices by the identity; returns the right-hand side.
fn hold(system: &PieceSystem, values: &mut [c64], held: [u32; 2], places: [c64; 2]) -> Vec<c64> {
    let graph = system.graph();
    let mut right = vec![c64::new(0.0, 0.0); graph.vertices()];
    let place_of = |v: u32| held.iter().position(|&h| h == v).map(|k| places[k]);
    for i in 0..graph.vertices() {
        let first = slot(graph, i);
        for (k, &j) in graph.above(i).iter().enumerate() {
            let value = values[first + 1 + k];
            let (low, high) = (place_of(i as u32), place_of(j));
            if let Some(p) = low {
                right[j as usize] -= value * p;
            }
            if let Some(p) = high {
                right[i] -= value.conj() * p;
            }
            if low.or(high).is_some() {
                values[first + 1 + k] = c64::new(0.0, 0.0);
            }
        }
    }
    for (v, p) in held.iter().zip(places) {
        values[slot(graph, *v as usize)] = c64::new(1.0, 0.0);
        right[*v as usize] = p;
    }
    right
}

/// Two vertices of the outer boundary far from each other in space.
fn far_apart(surface: &PieceSurface) -> [u32; 2] {
    let outline = &surface.loops()[0];
    let place = |v: u32| surface.positions()[v as usize];
    let farthest = |from: Point3<f64>| {
        let distance = |v: &&u32| (place(**v) - from).norm_squared();
        outline.iter().max_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(outline[0])
    };
    let first = farthest(place(outline[0]));
    [first, farthest(place(first))]
}

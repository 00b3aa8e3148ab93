//! A coarse lattice of signed distances around the body.
//!
//! Distance changes by no more than one moves, so the distance at a cell's middle bounds that of
//! every point in the cell: most vertices are known to be too far out without a look at the
//! skin, and points deep inside get a bound to search within. The bounds are exact, never a guess.
//!
//! Cost: [`CELLS`] closest-point queries once, some 50 ms for a body of 20,000 triangles; half a
//! megabyte. Outside the lattice the distance to its box is the bound.

use super::volume::{Aabb, BoundingVolume};
use rayon::prelude::*;
use toile_core::artifact::Point3;
use toile_core::{Context, StageError};

/// Cells of the lattice, about: 2 cm for a body. More cells sort out more vertices and take longer
/// to make.
const CELLS: f64 = 65536.0;

/// Cells along one axis at most, for bodies that are long and thin.
const MOST_ALONG_AXIS: usize = 512;

/// Slack on the bounds for their rounding, relative to the size of the body's coordinates.
const SLACK: f64 = 1e-12;

/// The lattice.
#[derive(Debug, Default)]
pub(super) struct Lattice {
    origin: Point3,
    cell: f64,
    counts: [usize; 3],
    distances: Vec<f64>,
    slack: f64,
}

impl Lattice {
    /// The lattice around `points`; `distance` gives the signed distance of a point whose skin is
    /// within a bound.
    pub(super) fn build(
        points: &[Point3],
        cx: &Context,
        distance: impl Fn(&Point3, f64) -> Option<f64> + Sync,
    ) -> Result<Self, StageError> {
        let frame = Aabb::fit(points);
        let extent = frame.extent();
        let cell = (extent.product() / CELLS).cbrt().max(extent.amax() / MOST_ALONG_AXIS as f64);
        let counts = [0, 1, 2].map(|k| (extent[k] / cell).ceil().max(1.0) as usize);
        let slack = SLACK * (frame.min.coords.amax().max(frame.max.coords.amax()) + cell);
        let mut lattice = Lattice { origin: frame.min, cell, counts, distances: Vec::new(), slack };
        for z in 0..counts[2] {
            cx.check()?;
            let row = |y: usize| lattice.row(y, z, &distance);
            let slab: Vec<Vec<f64>> = (0..counts[1]).into_par_iter().map(row).collect();
            lattice.distances.extend(slab.into_iter().flatten());
        }
        Ok(lattice)
    }

    /// A row of cells, each searched within what its neighbour allows.
    fn row(&self, y: usize, z: usize, distance: &(impl Fn(&Point3, f64) -> Option<f64> + Sync)) -> Vec<f64> {
        let mut bound = f64::INFINITY;
        (0..self.counts[0])
            .map(|x| {
                let d = distance(&self.middle([x, y, z]), bound).unwrap_or(f64::NAN);
                bound = if d.is_nan() { f64::INFINITY } else { d.abs() + self.cell + self.slack };
                d
            })
            .collect()
    }

    fn middle(&self, at: [usize; 3]) -> Point3 {
        let along = |k: usize| self.origin[k] + (at[k] as f64 + 0.5) * self.cell;
        Point3::new(along(0), along(1), along(2))
    }

    /// The least and the greatest signed distance that `p` can have; `None` where it is no finite
    /// number.
    pub(super) fn bounds(&self, p: &Point3) -> Option<(f64, f64)> {
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let top = [0, 1, 2].map(|k| self.origin[k] + self.counts[k] as f64 * self.cell);
        let out = |k: usize| (self.origin[k] - p[k]).max(p[k] - top[k]).max(0.0);
        let outside = (0..3).map(|k| out(k) * out(k)).sum::<f64>().sqrt();
        if outside > 0.0 {
            return Some((outside - self.slack, f64::INFINITY));
        }
        let at = [0, 1, 2].map(|k| (((p[k] - self.origin[k]) / self.cell) as usize).min(self.counts[k] - 1));
        let d = self.distances[(at[2] * self.counts[1] + at[1]) * self.counts[0] + at[0]];
        let r = (p - self.middle(at)).norm() + self.slack;
        Some(if d.is_nan() { (f64::NEG_INFINITY, f64::INFINITY) } else { (d - r, d + r) })
    }
}

#[cfg(test)]
mod tests;

//! A coarse lattice of signed distances around the body.
//!
//! Distance changes by no more than one moves, so the distance at a cell's middle bounds that of
//! every point in the cell: most vertices are known to be too far out without a look at the
//! skin, and points deep inside get a bound to search within. The bounds are exact, never a guess.
//!
//! Cells are filled where points ask for them, each once; a body is mostly larger than what cloth
//! comes near. Cost: a closest-point query a cell that is asked for; all [`CELLS`] of them, some 50
//! ms for a body of 20,000 triangles, where they are filled ahead. Half a megabyte. Outside the
//! lattice the distance to its box is the bound.
//!
//! Bounds sort points out and never decide: which cells are filled, and by which thread, changes no
//! answer.

use crate::Vec3;
use crate::volume::{Aabb, BoundingVolume};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Cells of the lattice, about: 2 cm for a body. More cells sort out more vertices and take longer
/// to make.
const CELLS: f64 = 65536.0;

/// Cells along one axis at most, for bodies that are long and thin.
const MOST_ALONG_AXIS: usize = 512;

/// Slack on the bounds for their rounding, relative to the size of the body's coordinates.
const SLACK: f64 = 1e-12;

/// The lattice.
#[derive(Debug, Default)]
pub struct DistanceLattice {
    origin: Vec3,
    cell: f64,
    counts: [usize; 3],
    /// Bits of the distances at the cells' middles; [`UNKNOWN`] where nobody has asked.
    distances: Vec<AtomicU64>,
    slack: f64,
}

/// A cell that is not filled: the bits of no distance, since a missing one is the usual NaN.
const UNKNOWN: u64 = u64::MAX;

impl DistanceLattice {
    /// The empty lattice around `points`.
    pub fn around(points: &[Vec3]) -> Self {
        let frame = Aabb::fit(points);
        let extent = frame.extent();
        let cell = (extent.product() / CELLS).cbrt().max(extent.amax() / MOST_ALONG_AXIS as f64);
        let counts = [0, 1, 2].map(|k| (extent[k] / cell).ceil().max(1.0) as usize);
        let slack = SLACK * (frame.min.amax().max(frame.max.amax()) + cell);
        let distances = (0..counts.iter().product()).map(|_| AtomicU64::new(UNKNOWN)).collect();
        DistanceLattice { origin: frame.min, cell, counts, distances, slack }
    }

    /// Fills every cell; `distance` gives the signed distance of a point whose skin is within a
    /// bound.
    ///
    /// # Errors
    /// That of `check`, which is asked once a layer.
    pub fn fill<E>(
        &self,
        check: impl Fn() -> Result<(), E>,
        distance: impl Fn(&Vec3, f64) -> Option<f64> + Sync,
    ) -> Result<(), E> {
        for z in 0..self.counts[2] {
            check()?;
            (0..self.counts[1]).into_par_iter().for_each(|y| self.fill_row(y, z, &distance));
        }
        Ok(())
    }

    /// Fills a row of cells, each searched within what its neighbour allows.
    fn fill_row(&self, y: usize, z: usize, distance: &(impl Fn(&Vec3, f64) -> Option<f64> + Sync)) {
        let mut bound = f64::INFINITY;
        for x in 0..self.counts[0] {
            let d = self.ask([x, y, z], bound, distance);
            bound = if d.is_nan() { f64::INFINITY } else { d.abs() + self.cell + self.slack };
        }
    }

    /// The distance at a cell's middle, where the skin is within `bound` of it.
    fn ask(&self, at: [usize; 3], bound: f64, distance: &impl Fn(&Vec3, f64) -> Option<f64>) -> f64 {
        if let Some(known) = self.known(at) {
            return known;
        }
        // Two threads that meet here work out the same.
        let d = distance(&self.middle(at), bound).unwrap_or(f64::NAN);
        self.slot(at).store(d.to_bits(), Ordering::Relaxed);
        d
    }

    /// How far the skin can be from a cell's middle, by the neighbours that are filled.
    fn reach(&self, at: [usize; 3]) -> f64 {
        let next = |k: usize, to: Option<usize>| {
            let to = to.filter(|i| *i < self.counts[k])?;
            let mut cell = at;
            cell[k] = to;
            self.known(cell)
        };
        let both = (0..3).flat_map(|k| [next(k, at[k].checked_sub(1)), next(k, Some(at[k] + 1))]);
        let nearest = both.flatten().map(f64::abs).fold(f64::INFINITY, f64::min);
        nearest + self.cell + self.slack
    }

    fn slot(&self, at: [usize; 3]) -> &AtomicU64 {
        &self.distances[(at[2] * self.counts[1] + at[1]) * self.counts[0] + at[0]]
    }

    /// The distance of a cell that is filled; a missing one is NaN.
    fn known(&self, at: [usize; 3]) -> Option<f64> {
        let bits = self.slot(at).load(Ordering::Relaxed);
        (bits != UNKNOWN).then(|| f64::from_bits(bits))
    }

    fn middle(&self, at: [usize; 3]) -> Vec3 {
        let along = |k: usize| self.origin[k] + (at[k] as f64 + 0.5) * self.cell;
        Vec3::new(along(0), along(1), along(2))
    }

    /// The least and the greatest signed distance that `p` can have; `None` where it is no finite
    /// number. `distance` fills the cell where nobody has asked for it yet.
    pub fn bounds(&self, p: &Vec3, distance: impl Fn(&Vec3, f64) -> Option<f64>) -> Option<(f64, f64)> {
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
        let d = self.ask(at, self.reach(at), &distance);
        let r = (p - self.middle(at)).norm() + self.slack;
        Some(if d.is_nan() { (f64::NEG_INFINITY, f64::INFINITY) } else { (d - r, d + r) })
    }
}

#[cfg(test)]
mod tests;

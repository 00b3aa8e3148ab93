//! Near-equilateral triangles by constrained Delaunay triangulation with refinement.
//!
//! Method: the outline is divided first and never touched again; a lattice of equilateral triangles
//! fills the inside; the constrained Delaunay triangulation of both (Chew 1989) is relaxed near the
//! outline and its angles are mended by refinement after Ruppert (1995), without splitting segments
//! (see `refine`). Cost: n log n. Limits: where segments of very different length meet at a sharp
//! corner, the angle asked for cannot be had; the figure `least_angle` shows it.

use super::assemble::{Meshed, mesh_outline};
use super::divide::Division;
use super::lattice::Lattice;
use super::refine::{improve, relax};
use super::triangulate::triangulate;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// A lattice point nearer to a segment than this share of the edge length is left out.
const LEAST_DISTANCE: f64 = 0.6;

/// Vertices within this many edge lengths of a segment are relaxed; farther in the lattice is
/// equilateral already.
const RELAX_REACH: f64 = 2.6;

/// Rounds of relaxation; more change little.
const RELAX_ROUNDS: usize = 6;

/// Fills the panel with near-equilateral triangles.
///
/// The best angles, and no direction that the mesh prefers: choose it where folds should not follow
/// the grid. Named edges are divided as their gauges say, so that two edges that are sewn together
/// get equal counts. Darts, pleats and folds lie on mesh edges.
#[stage(
    role = Mesher,
    source = "Chew, 1989; Ruppert, 1995",
    example = "DelaunayMesher(edge: \"12 mm\", least_angle: 28)",
    contracts(Deterministic, ThreadInvariant, BoundaryPreserving, RefusesEmpty, Cancellable)
)]
pub struct DelaunayMesher {
    /// Target length of the triangles' edges; a smaller one gives finer folds and takes longer.
    #[param(default = Length::mm(12.0), min = 0.0001, max = 1.0, trades, finer = "less")]
    pub(crate) edge: Length,
    /// Triangles with a smaller angle are mended where the outline allows.
    #[param(default = 28.0, min = 0.0, max = 33.0, unit = "deg", trades)]
    pub(crate) least_angle: f64,
}

#[stage]
impl DelaunayMesher {
    pub(crate) fn run(&self, outline: &Outline, cx: &Context) -> Result<Panel, StageError> {
        let h = self.edge.metres();
        mesh_outline(outline, h, cx, |division| {
            delaunay_mesh(outline, division, h, self.least_angle.to_radians(), cx)
        })
    }
}

/// Vertices and triangles of a divided outline with angles of at least `target` (radians) where
/// its segments allow.
pub(crate) fn delaunay_mesh(
    outline: &Outline,
    division: &Division,
    h: f64,
    target: f64,
    cx: &Context,
) -> Result<Meshed, StageError> {
    let (points, free, near) = seeded(outline, division, h);
    cx.check()?;
    let mut mesh = triangulate(points, free, &division.loop_segments(), &division.chain_segments())?;
    cx.check()?;
    relax(&mut mesh, &near, RELAX_ROUNDS, target, cx)?;
    improve(&mut mesh, target, cx)?;
    let triangles = mesh.living().map(|t| mesh.tris[t as usize]).collect();
    Ok(Meshed { points: mesh.points, triangles })
}

/// The division's points and the lattice's; which are free; and which are near a segment.
fn seeded(outline: &Outline, division: &Division, h: f64) -> (Vec<Point2>, Vec<bool>, Vec<u32>) {
    let lattice = equilateral(outline, h);
    let segments = division.segments();
    let mut kept = lattice.inside(&division.points, &division.loop_segments());
    let mut close = vec![false; kept.len()];
    lattice.near(&division.points, &segments, LEAST_DISTANCE * h, |k| kept[k] = false);
    lattice.near(&division.points, &segments, RELAX_REACH * h, |k| close[k] = true);
    let mut points = division.points.clone();
    let mut near = Vec::new();
    for k in (0..kept.len()).filter(|&k| kept[k]) {
        if close[k] {
            near.push(points.len() as u32);
        }
        points.push(lattice.point(k % lattice.columns, k / lattice.columns));
    }
    let free = (0..points.len()).map(|v| v >= division.points.len()).collect();
    (points, free, near)
}

/// A lattice of equilateral triangles over the outline's box, centred on it.
fn equilateral(outline: &Outline, h: f64) -> Lattice {
    let (low, high) = outline.bounds();
    let span = high - low;
    let dy = h * 3f64.sqrt() / 2.0;
    let (columns, rows) = ((span.x / h) as usize + 2, (span.y / dy) as usize + 1);
    let size = Vector2::new((columns - 1) as f64 * h, (rows - 1) as f64 * dy);
    Lattice { low: low + (span - size) / 2.0, dx: h, dy, columns, rows, shift: 0.5 }
}

//! Smoothing by the distance to the mean plane, after a thesis on garment modelling from photos
//! (2012).
//!
//! Method: the mean plane of vertex v with neighbours N(v) passes through their centre O, and its
//! normal n is the eigenvector of the smallest eigenvalue of `C = sum (w - O)(w - O)^T`. With the
//! signed distance `d = (v - O).n` a vertex moves along the normal only,
//!
//! ```text
//! v' = v + lambda n (dbar - d),    dbar = sum d_w / |v - w|  /  sum 1 / |v - w|,
//! ```
//!
//! so that a bump is pulled in and a flat is pushed out, while even curvature (all distances equal)
//! stays: a sphere or a circle does not shrink as it does under the Laplacian. Border vertices use
//! the anisotropic form: their neighbours are the two before and the two behind on the border, the
//! mean plane becomes the mean line, and they move along the border's normal in the surface.
//!
//! In a flat panel all inner vertices lie in their mean planes, so the method moves none of them:
//! what it mends there is the outline's burrs. On a surface in space it smooths folds: see
//! [`smooth_to_planes`](super::smooth_to_planes). Cost: linear in the triangles, a round. Limits:
//! `lambda` above 0.8 may oscillate. Border vertices next to a corner or a pin keep their place,
//! since they lack neighbours on one side.

use super::guard::{Step, smooth};
use super::topology::{Stretch, Topology};
use nalgebra::Matrix2;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// Evens out burrs of the outline along its normal, by each vertex's distance to the mean line of
/// its neighbours; even curves keep their shape.
///
/// Inner vertices of a flat panel lie in their mean plane already and stay. The outline stays
/// within its tolerance, lengths of edges within 0.1 %, corners exactly.
#[stage(
    role = Smoother,
    source = "thesis on 3D garment modelling from photos, 2012",
    example = "PlaneSmoother(lambda: 0.5)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, RotationEquivariant, ScaleEquivariant, Cancellable)
)]
pub struct PlaneSmoother {
    /// Share of the way that a vertex goes in a round.
    #[param(default = 0.5, min = 0.0, max = 0.8)]
    pub(crate) lambda: f64,
    /// Number of rounds.
    #[param(default = 3, min = 0, max = 1000, trades, finer = "more")]
    pub(crate) iterations: u32,
}

#[stage]
impl PlaneSmoother {
    pub(crate) fn run(&self, panel: &Panel, cx: &Context) -> Result<Panel, StageError> {
        super::check(panel)?;
        smooth(panel, self.iterations as usize, &[&MeanLine { lambda: self.lambda }], cx)
    }
}

struct MeanLine {
    lambda: f64,
}

impl Step for MeanLine {
    fn inner(&self, _: &Topology, _: &[Point2], _: usize) -> Vector2 {
        Vector2::zeros()
    }

    fn outline(&self, stretch: &Stretch, points: &[Point2], k: usize) -> f64 {
        let Some(own) = line_distance(stretch, points, k, 0) else { return 0.0 };
        let here = points[stretch.vertices[k] as usize];
        let (mut sum, mut weight) = (0.0, 0.0);
        for step in NEAR {
            let v = stretch.at(k, step).map(|v| points[v as usize]);
            if let (Some(p), Some(d)) = (v, line_distance(stretch, points, k, step)) {
                let w = 1.0 / (p - here).norm().max(f64::MIN_POSITIVE);
                sum += w * d;
                weight += w;
            }
        }
        if weight > 0.0 { self.lambda * (sum / weight - own) } else { 0.0 }
    }
}

/// The neighbours on a border: two on either side, for with one the finest zigzag only changes its
/// sign at lambda 0.5.
const NEAR: [isize; 4] = [-2, -1, 1, 2];

/// Signed distance (outward positive) of the vertex `step` after place `k` to the mean line of its
/// neighbours; `None` where it lacks some.
fn line_distance(stretch: &Stretch, points: &[Point2], k: usize, step: isize) -> Option<f64> {
    let at = |s: isize| stretch.at(k, step + s).map(|v| points[v as usize]);
    let ring: Vec<Point2> = NEAR.into_iter().map(at).collect::<Option<_>>()?;
    let centre = ring.iter().map(|p| p.coords).sum::<Vector2>() / ring.len() as f64;
    let spread: Matrix2<f64> =
        ring.iter().map(|p| p.coords - centre).map(|u| u * u.transpose()).sum::<Matrix2<f64>>();
    let eigen = spread.symmetric_eigen();
    let normal: Vector2 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let along = ring[3] - ring[0];
    let outward = normal * normal.dot(&Vector2::new(along.y, -along.x)).signum();
    Some((at(0)?.coords - centre).dot(&outward))
}

//! Plain Laplacian smoothing.
//!
//! Method: an inner vertex moves a share of the way to the mean of its neighbours (Field 1988).
//! Outline and inner lines stay: the plain form shrinks a curve.
//! Cost: linear in the triangles, a round.
//! Limits: evens out spacing, so a finely divided neck draws its neighbours closer.

use super::guard::{Step, smooth};
use super::topology::{Stretch, Topology};
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// Draws inner vertices towards the middle of their neighbours.
///
/// Outline, corners and inner lines stay where they are; a move that would spoil a triangle is
/// taken back.
#[stage(
    role = Smoother,
    source = "Field, 1988",
    example = "Laplacian(lambda: 0.5, iterations: 5)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, RotationEquivariant, ScaleEquivariant, BoundaryPreserving, Cancellable)
)]
pub struct Laplacian {
    /// Share of the way to the neighbours' mean that a vertex goes in a round.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    pub(crate) lambda: f64,
    /// Number of rounds.
    #[param(default = 5, min = 0, max = 1000, trades, finer = "more")]
    pub(crate) iterations: u32,
}

#[stage]
impl Laplacian {
    pub(crate) fn run(&self, panel: &Panel, cx: &Context) -> Result<Panel, StageError> {
        super::check(panel)?;
        smooth(panel, self.iterations as usize, &[&Umbrella { share: self.lambda, outline: false }], cx)
    }
}

/// The umbrella operator: from a vertex to the mean of its neighbours.
pub(crate) struct Umbrella {
    /// Share of the way.
    pub share: f64,
    /// True where the outline is smoothed as well, along itself.
    pub outline: bool,
}

impl Step for Umbrella {
    fn inner(&self, topology: &Topology, points: &[Point2], v: usize) -> Vector2 {
        let ring = topology.neighbours.of(v);
        let sum: Vector2 = ring.iter().map(|&w| points[w as usize] - points[v]).sum();
        sum * (self.share / ring.len().max(1) as f64)
    }

    fn outline(&self, stretch: &Stretch, points: &[Point2], k: usize) -> f64 {
        let at = |step| stretch.at(k, step).map(|v| points[v as usize]);
        let (true, Some(a), Some(p), Some(b)) = (self.outline, at(-1), at(0), at(1)) else { return 0.0 };
        let along = b - a;
        let outward = Vector2::new(along.y, -along.x).try_normalize(0.0).unwrap_or_else(Vector2::zeros);
        (nalgebra::center(&a, &b) - p).dot(&outward) * self.share
    }
}

//! `SpringFlatten`: the published method.

use super::flattened::{Care, Request};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::springs;
use toile_flatten::newton::StoppingLimits;

/// Lays each piece flat by the distances between neighbours, then lets springs along the edges
/// relax in the plane.
///
/// The relaxation spreads the unavoidable error over the piece, until the energy that one more step
/// would save is below `settled`. Where the layout by distances turns triangles over, the springs
/// start from a map that turns none.
#[stage(
    role = Flattener,
    version = 2,
    source = "Fan, Zhou, Wang, Yuen 1999",
    example = "SpringFlatten(settled: 1e-8)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct SpringFlatten {
    /// Care of the pattern.
    #[param(flatten)]
    pub care: Care,
    /// The energy by area that one more step may still save; 0.0002 is about a strain of one per
    /// cent everywhere.
    #[param(default = 1e-9, min = 1e-14, max = 1e-2, trades)]
    pub settled: f64,
    /// Most steps of Newton's method a piece.
    #[param(default = 100, min = 1, max = 10_000, trades)]
    pub iterations: u32,
}

#[stage]
impl SpringFlatten {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let newton = StoppingLimits { iterations: self.iterations as usize, tolerance: self.settled };
        let request = Request {
            method: &|surface, placement, _| springs(surface, newton, placement),
            care: Some((Objective::Springs, self.care.options(newton))),
            darts: self.care.darts,
            tension: self.care.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.care.darts.checked().err().into_iter().collect()
    }
}

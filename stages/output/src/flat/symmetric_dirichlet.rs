//! `SymmetricDirichlet`: the least of the worst stretches.

use super::flattened::{Care, Request};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::symmetric_dirichlet;
use toile_flatten::newton::StoppingLimits;

/// Lays each piece flat so that stretching and shrinking cost alike and without limit: the worst
/// triangles come out better than with `Arap`.
///
/// A triangle's energy is the sum of the squares of its stretches and of their inverses. No
/// triangle flips, and the scale is true.
#[stage(
    role = Flattener,
    version = 2,
    source = "Smith and Schaefer 2015",
    example = "SymmetricDirichlet(straight: 0.01)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct SymmetricDirichlet {
    /// Care of the pattern.
    #[param(flatten)]
    pub care: Care,
    /// Most steps of Newton's method a piece.
    #[param(default = 100, min = 1, max = 10_000, trades)]
    pub iterations: u32,
}

#[stage]
impl SymmetricDirichlet {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let newton = StoppingLimits { iterations: self.iterations as usize, ..StoppingLimits::default() };
        let request = Request {
            method: &|surface, placement, _| symmetric_dirichlet(surface, newton, placement),
            care: Some((Objective::SymmetricDirichlet, self.care.options(newton))),
            darts: self.care.darts,
            tension: self.care.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.care.darts.checked().err().into_iter().collect()
    }
}

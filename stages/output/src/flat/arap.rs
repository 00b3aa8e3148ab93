//! `Arap`: as rigid as possible.

use super::flattened::{Care, Request};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::arap;
use toile_flatten::newton::StoppingLimits;

/// Lays each piece flat so that every triangle keeps its shape as far as its neighbours let it: the
/// least error of area.
///
/// A triangle's deviation is the squared distance of its map from the nearest rotation. No triangle
/// flips, and the scale is true.
#[stage(
    role = Flattener,
    version = 3,
    source = "Liu, Zhang, Xu, Gotsman, Gortler 2008",
    example = "Arap(darts: Propose)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Arap {
    /// Care of the pattern.
    #[param(flatten)]
    pub care: Care,
    /// Most steps of Newton's method a piece.
    #[param(default = 100, min = 1, max = 10_000, trades)]
    pub iterations: u32,
}

#[stage]
impl Arap {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let newton = StoppingLimits { iterations: self.iterations as usize, ..StoppingLimits::default() };
        let objective = Objective::Arap;
        let options = toile_flatten::flatteners::ArapOptions { newton, ..Default::default() };
        let request = Request {
            method: &|surface, placement, _| arap(surface, options, placement),
            care: Some((objective, self.care.options(newton))),
            darts: self.care.darts,
            tension: self.care.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.care.darts.checked().err().into_iter().collect()
    }
}

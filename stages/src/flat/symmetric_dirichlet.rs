//! `SymmetricDirichlet`: the least of the worst stretches.

use super::dart::Darts;
use super::flattened::{Request, care};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::symmetric_dirichlet;
use toile_flatten::newton::NewtonOptions;

/// Lays each piece flat so that stretching and shrinking cost alike and without limit: the worst triangles come out better than with `Arap`.
///
/// A triangle's energy is the sum of the squares of its stretches and of their inverses. No triangle flips, and the scale is true.
#[stage(
    role = Flattener,
    version = 2,
    source = "Smith and Schaefer 2015",
    example = "SymmetricDirichlet(straight: 0.01)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct SymmetricDirichlet {
    /// Make the two sides of each seam equally long.
    #[param(default = true)]
    pub seams: bool,
    /// Make left and right pieces mirror images, and pieces that are their own mirror image so.
    #[param(default = true)]
    pub mirror: bool,
    /// An edge that leaves its line by at most this share of its length becomes straight; 0 for none.
    #[param(default = 0.005, min = 0.0, max = 0.19)]
    pub straight: f64,
    /// Stretch of the garment along warp and weft that the pattern must not have: (0.1, 0.2) of a knit that is worn 10 % longer and 20 % wider.
    #[param(default = (0.0, 0.0), min = -0.8, max = 9.0)]
    pub tension: (f64, f64),
    /// What becomes of cloth that cannot lie flat.
    #[param(default = Darts::None)]
    pub darts: Darts,
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
        let newton = NewtonOptions { iterations: self.iterations as usize, ..NewtonOptions::default() };
        let request = Request {
            method: &|surface, placement, _| symmetric_dirichlet(surface, newton, placement),
            care: Some((Objective::SymmetricDirichlet, care(self.seams, self.straight, self.mirror, newton))),
            darts: self.darts,
            tension: self.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.darts.checked().err().into_iter().collect()
    }
}

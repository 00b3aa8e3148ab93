//! `Arap`: as rigid as possible.

use super::dart::Darts;
use super::flattened::{Request, care};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::arap;
use toile_flatten::newton::NewtonOptions;

/// Lays each piece flat so that every triangle keeps its shape as far as its neighbours let it: the least error of area.
///
/// A triangle's deviation is the squared distance of its map from the nearest rotation. No triangle flips, and the scale is true.
#[stage(
    role = Flattener,
    version = 3,
    source = "Liu, Zhang, Xu, Gotsman, Gortler 2008",
    example = "Arap(darts: Propose)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Arap {
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
impl Arap {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let newton = NewtonOptions { iterations: self.iterations as usize, ..NewtonOptions::default() };
        let objective = Objective::Arap;
        let options = toile_flatten::flatteners::ArapOptions { newton, ..Default::default() };
        let request = Request {
            method: &|surface, placement, _| arap(surface, options, placement),
            care: Some((objective, care(self.seams, self.straight, self.mirror, newton))),
            darts: self.darts,
            tension: self.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.darts.checked().err().into_iter().collect()
    }
}

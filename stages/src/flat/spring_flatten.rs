//! `SpringFlatten`: the published method.

use super::dart::Darts;
use super::flattened::{Request, care};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::flatteners::springs;
use toile_flatten::newton::NewtonOptions;

/// Lays each piece flat by the distances between neighbours, then lets springs along the edges relax in the plane.
///
/// The relaxation spreads the unavoidable error over the piece, until the energy that one more step would save is below `settled`. Where
/// the layout by distances turns triangles over, the springs start from a map that turns none.
#[stage(
    role = Flattener,
    version = 2,
    source = "Fan, Zhou, Wang, Yuen 1999",
    example = "SpringFlatten(settled: 1e-8)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct SpringFlatten {
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
    /// The energy by area that one more step may still save; 0.0002 is about a strain of one per cent everywhere.
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
        let newton = NewtonOptions { iterations: self.iterations as usize, tolerance: self.settled };
        let request = Request {
            method: &|surface, placement, _| springs(surface, newton, placement),
            care: Some((Objective::Springs, care(self.seams, self.straight, self.mirror, newton))),
            darts: self.darts,
            tension: self.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.darts.checked().err().into_iter().collect()
    }
}

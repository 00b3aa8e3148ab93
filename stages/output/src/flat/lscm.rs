//! `Lscm`: angles kept.

use super::dart::Darts;
use super::flattened::Request;
use toile_core::prelude::*;
use toile_flatten::flatteners::lscm;

/// Lays each piece flat with the least error of angles, its whole area true: quick, and a start for
/// comparison.
///
/// Lengths are not kept where a piece is curved, so the sides of seams come out unlike; no pattern
/// care is taken. Where the map turns triangles over, the embedding of Tutte stands in.
#[stage(
    role = Flattener,
    version = 2,
    source = "Lévy, Petitjean, Ray, Maillot 2002",
    example = "Lscm(tension: (0.05, 0.1))",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Lscm {
    /// Stretch of the garment along warp and weft that the pattern must not have: (0.1, 0.2) of a
    /// knit that is worn 10 % longer and 20 % wider.
    #[param(default = (0.0, 0.0), min = -0.8, max = 9.0)]
    pub tension: (f64, f64),
}

#[stage]
impl Lscm {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let request = Request {
            method: &|surface, placement, _| lscm(surface, placement),
            care: None,
            darts: Darts::None,
            tension: self.tension,
        };
        request.run(garment, pattern, cx)
    }
}

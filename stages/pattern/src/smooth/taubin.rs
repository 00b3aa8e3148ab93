//! Smoothing without shrinkage.
//!
//! Method: a Laplacian step inward and a slightly larger one outward make a low-pass filter with
//! pass band `1/lambda + 1/mu` (Taubin 1995). The outline is filtered along itself, along its
//! normal, within the outline's tolerance; corners and ends of named edges are pinned.
//! Cost: twice a Laplacian round.
//! Limits: needs `mu < -lambda`.

use super::guard::smooth;
use super::laplacian::Umbrella;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// Smooths inner vertices and the outline with a filter that does not shrink.
///
/// The outline moves along its normal only and stays within its tolerance, lengths of edges within
/// 0.1 %, corners exactly.
#[stage(
    role = Smoother,
    source = "Taubin, 1995",
    example = "Taubin(lambda: 0.5, mu: -0.53, iterations: 5)",
    contracts(Deterministic, ThreadInvariant, TranslationEquivariant, RotationEquivariant, ScaleEquivariant, Cancellable)
)]
pub struct Taubin {
    /// Share of the inward step.
    #[param(default = 0.5, min = 0.0, max = 1.0)]
    pub(crate) lambda: f64,
    /// Share of the outward step: negative, and greater in magnitude than lambda.
    #[param(default = -0.53, min = -1.1, max = 0.0)]
    pub(crate) mu: f64,
    /// Number of rounds.
    #[param(default = 5, min = 0, max = 1000, trades, finer = "more")]
    pub(crate) iterations: u32,
}

#[stage]
impl Taubin {
    pub(crate) fn run(&self, panel: &Panel, cx: &Context) -> Result<Panel, StageError> {
        super::check(panel)?;
        self.outweighs()?;
        let inward = Umbrella { share: self.lambda, outline: true };
        let outward = Umbrella { share: self.mu, outline: true };
        smooth(panel, self.iterations as usize, &[&inward, &outward], cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.outweighs().err().into_iter().collect()
    }

    fn outweighs(&self) -> Result<(), StageError> {
        if self.mu >= -self.lambda && self.lambda > 0.0 {
            return Err(StageError::new(
                ErrorCode::InvalidParameter,
                format!("mu is {}, but must be below -lambda = {}", self.mu, -self.lambda),
            )
            .hint("the outward step must outweigh the inward one; -0.53 goes with 0.5")
            .at("mu"));
        }
        Ok(())
    }
}

//! `Woven`: threads keep their lengths, shear is soft.

use super::flattened::{Care, Request};
use toile_core::prelude::*;
use toile_flatten::care::Objective;
use toile_flatten::energy::WovenStiffness;
use toile_flatten::flatteners::woven;
use toile_flatten::newton::StoppingLimits;

/// Lays each piece flat as its fabric would: warp and weft keep their lengths by the fabric's own
/// curves, shear is soft.
///
/// The stiffness of warp and weft is the force of the fabric's curve at `strain` over that strain,
/// that of shear the same at `angle`. The grain is held upright.
#[stage(
    role = Flattener,
    version = 2,
    source = "Fan, Zhou, Wang, Yuen 1999; membrane energy of warp, weft and shear",
    example = "Woven(strain: 0.02)",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct Woven {
    /// Care of the pattern.
    #[param(flatten)]
    pub care: Care,
    /// The strain at which the curves of warp and weft are read.
    #[param(default = 0.01, min = 1e-4, max = 1.0)]
    pub strain: f64,
    /// The angle at which the curve of shear is read.
    #[param(default = 5.0, min = 0.01, max = 60.0, unit = "deg")]
    pub angle: f64,
    /// Most steps of Newton's method a piece.
    #[param(default = 100, min = 1, max = 10_000, trades)]
    pub iterations: u32,
}

#[stage]
impl Woven {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<(Pattern, Garment), StageError> {
        let newton = StoppingLimits { iterations: self.iterations as usize, ..StoppingLimits::default() };
        let stiffness: Vec<WovenStiffness> =
            garment.panels.iter().map(|p| self.stiffness(&p.fabric)).collect();
        let first = stiffness.first().copied().unwrap_or(WovenStiffness::COTTON);
        if let Some(k) = stiffness.iter().position(|s| *s != first) {
            let [a, b] = [0, k].map(|k| garment.panels[k].fabric.name.as_str());
            cx.warn(format!("panels are of \"{a}\" and of \"{b}\": seams and straight edges are settled with the curves of \"{a}\""));
        }
        let of = |panel: usize| stiffness.get(panel).copied().unwrap_or(first);
        let request = Request {
            method: &|surface, placement, panel| woven(surface, of(panel), newton, placement),
            care: Some((Objective::Woven(first), self.care.options(newton))),
            darts: self.care.darts,
            tension: self.care.tension,
        };
        request.run(garment, pattern, cx)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.care.darts.checked().err().into_iter().collect()
    }
}

impl Woven {
    fn stiffness(&self, fabric: &Fabric) -> WovenStiffness {
        let secant = |curve: &Curve, at: f64| curve.at(at).0 / at;
        WovenStiffness {
            warp: secant(&fabric.warp, self.strain),
            weft: secant(&fabric.weft, self.strain),
            shear: secant(&fabric.shear, self.angle.to_radians()),
        }
    }
}

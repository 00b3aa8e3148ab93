//! Rule `mixed-precision`: the factor of each step's matrix in single precision, where that solves
//! the step.
//!
//! Fact: every step's solution is compared with its matrix in double precision, and refined; where
//! more than a ten-thousandth of the right side is left, the matrix is too ill conditioned, and is
//! factored anew in double precision. Forces, energies and the proof of rest are of double
//! precision always. Tolerance: the state meets the same limit of speed; which of several
//! neighbouring states is found may differ, as between starts that are moved by a millimetre.
//! Source: Wilkinson 1963, Carson and Higham 2018.

use toile_core::cost::{Quantity, Size};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_core::prelude::*;

/// How precise the factor of each step's matrix is.
#[choice]
#[derive(Copy, Eq)]
pub enum FactorPrecision {
    /// Single where that solves the step well, else double.
    Mixed,
    /// Always double.
    Double,
}

impl From<FactorPrecision> for toile_cloth::statics::drive::solve::Precision {
    fn from(precision: FactorPrecision) -> Self {
        match precision {
            FactorPrecision::Mixed => Self::Mixed,
            FactorPrecision::Double => Self::Double,
        }
    }
}

/// Share of the stage's time that it saves, on garments of some thousand triangles.
const SHARE: f64 = 0.08;

/// How far the surface may lie from that of double precision (95 %), metres: continued, as far as
/// states that chance picks from.
pub(super) const APART_CONTINUED: f64 = 0.008;
/// How far the surface may lie from that of double precision (95 %), metres: straight, as far as
/// the folds of two moved starts.
pub(super) const APART_STRAIGHT: f64 = 0.02;

/// The decision of a drape of so many triangles.
pub(super) fn rule(precision: FactorPrecision, continued: bool, size: &Size) -> Option<Decision> {
    let triangles = size.get(Quantity::Triangles).filter(|n| *n > 0.0)?;
    (precision == FactorPrecision::Mixed).then(|| Decision {
        rule: "mixed-precision".into(),
        state: State::Simplified,
        what: "double precision of each step's factor: only where single does not solve the step".into(),
        fact: format!(
            "about {triangles:.0} triangles, whose matrix shows at each step how well it is solved"
        ),
        tolerance: Tolerance::Distance(if continued { APART_CONTINUED } else { APART_STRAIGHT }),
        saves: Saves::Share(SHARE),
        source: "iterative refinement: Wilkinson 1963; Carson, Higham 2018".into(),
        turn: Turn::Param { name: "precision".into(), value: "Double".into() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_speaks_where_precision_is_mixed_and_there_is_cloth() {
        let size = Size::new().with(Quantity::Triangles, 4_673.0);
        let told = rule(FactorPrecision::Mixed, true, &size).map(|d| (d.fact, d.tolerance));
        let words = "about 4673 triangles, whose matrix shows at each step how well it is solved".to_owned();
        assert_eq!(told, Some((words, Tolerance::Distance(0.008))));
        assert_eq!(
            rule(FactorPrecision::Mixed, false, &size).map(|d| d.tolerance),
            Some(Tolerance::Distance(0.02))
        );
        assert_eq!(rule(FactorPrecision::Double, true, &size), None);
        assert_eq!(rule(FactorPrecision::Mixed, true, &Size::new()), None);
    }
}

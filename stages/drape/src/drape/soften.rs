//! What the stages of springs make of a garment's fabrics.

use std::sync::Arc;
use toile_cloth::energy::{Bending, Membrane, Models};
use toile_core::prelude::*;

/// Line force that a worn garment meets where it is tight, N/m: a snug sleeve pulls by about that.
const WORN_FORCE: f64 = 50.0;

/// Models with springs along edges, and over every second vertex.
pub(crate) fn springs() -> Models {
    Models { membrane: Membrane::Springs, bending: Bending::SkipOne }
}

/// The garment with no slope of any fabric's curves above `stiffest`, N/m.
pub(crate) fn softened(garment: &Garment, stiffest: f64) -> Garment {
    let mut garment = garment.clone();
    for panel in &mut garment.panels {
        let f = &panel.fabric;
        let [warp, weft, shear] = [&f.warp, &f.weft, &f.shear].map(|c| cut(c, stiffest));
        panel.fabric = Arc::new(Fabric { warp, weft, shear, ..Fabric::clone(f) });
    }
    garment
}

/// A curve with no slope above `steepest`, N/m.
fn cut(curve: &Curve, steepest: f64) -> Curve {
    let (mut from, mut force) = ((0.0, 0.0), 0.0);
    let mut softer = |&to: &(f64, f64)| {
        force += ((to.1 - from.1) / (to.0 - from.0)).min(steepest) * (to.0 - from.0);
        from = to;
        (to.0, force)
    };
    Curve(curve.0.iter().map(&mut softer).collect())
}

/// The strain that the softest fabric of the garment takes on under [`WORN_FORCE`]: a knit may
/// stretch by that, whatever the limit.
pub(super) fn easy_strain(garment: &Garment) -> f64 {
    let at_force = |curve: &Curve| {
        let mut from = (0.0, 0.0);
        for (i, &to) in curve.0.iter().enumerate() {
            if to.1 >= WORN_FORCE || i + 1 == curve.0.len() {
                return from.0 + (WORN_FORCE - from.1) * (to.0 - from.0) / (to.1 - from.1);
            }
            from = to;
        }
        0.0
    };
    let fabrics = garment.panels.iter().map(|p| &p.fabric);
    fabrics.map(|f| at_force(&f.warp).max(at_force(&f.weft))).fold(0.0, f64::max)
}

/// Damping of the garment's fabrics, weighted by their masses, 1/s.
pub(crate) fn damping(garment: &Garment) -> f64 {
    let mass = |p: &GarmentPanel| garment.panel_areas(p).0 * p.fabric.area_density;
    let masses: f64 = garment.panels.iter().map(mass).sum();
    let sum: f64 = garment.panels.iter().map(|p| mass(p) * p.fabric.damping).sum();
    if masses > 0.0 { sum / masses } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_slope_is_above_the_cut_and_softer_ones_stay() {
        let curve = Curve(vec![(0.01, 5.0), (0.03, 45.0), (0.05, 65.0)]);
        let softer = cut(&curve, 1200.0);
        assert!((softer.steepest() - 1200.0).abs() < 1e-9);
        for (strain, force) in [(0.01, 5.0), (0.03, 5.0 + 24.0), (0.05, 29.0 + 20.0)] {
            assert!((softer.at(strain).0 - force).abs() < 1e-9, "{strain}");
        }
        assert_eq!(cut(&curve, f64::INFINITY).steepest(), curve.steepest());
    }
}

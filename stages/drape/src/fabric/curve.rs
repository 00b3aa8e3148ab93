//! Force-strain curves from the few figures that a tensile or shear test reports.
//!
//! Method: the Kawabata tensile test stretches cloth to 500 gf/cm and reports the strain there
//! (EMT) and the linearity LT: the work done over that of a straight line. Woven cloth first
//! straightens its crimp at a low force (LT below 1), so the curve is two straight pieces that meet
//! halfway in strain and enclose the measured work. Cost: nothing. Limit: between the ends the true
//! curve is smooth; two pieces err by some per cent of the end's force.

use toile_core::artifact::Curve;

/// The line force at which the Kawabata tensile test ends, N/m (500 gf/cm).
pub(crate) const KES_FORCE: f64 = 490.332_5;

/// The least linearity that two rising pieces can show.
pub(crate) const LEAST_LINEARITY: f64 = 0.55;

/// The greatest linearity that two rising pieces can show.
pub(crate) const GREATEST_LINEARITY: f64 = 1.0;

/// Shear angle at which threads jam and stiffen, radians.
const JAM_ANGLE: f64 = 0.5;

/// Shear angle where the curve's given part ends, radians.
const LAST_ANGLE: f64 = 0.8;

/// Jammed threads are stiffer in shear by this factor.
const JAMMED: f64 = 10.0;

/// The curve through (`strain`, `force`) whose work is `linearity` times that of a straight line.
pub fn tensile_curve(strain: f64, force: f64, linearity: f64) -> Curve {
    let linearity = linearity.clamp(LEAST_LINEARITY, GREATEST_LINEARITY);
    if linearity >= 1.0 {
        return Curve(vec![(strain, force)]);
    }
    // Work of the two pieces that meet at (strain/2, y): strain (y/2 + (y + force)/2) / 2 = LT
    // strain force / 2.
    let half = (2.0 * linearity - 1.0) * force / 2.0;
    Curve(vec![(strain / 2.0, half), (strain, force)])
}

/// The shear curve with stiffness `k` (N/m per rad) up to the angle where threads jam.
pub(crate) fn shear_curve(k: f64) -> Curve {
    let jam = k * JAM_ANGLE;
    Curve(vec![(JAM_ANGLE, jam), (LAST_ANGLE, jam + JAMMED * k * (LAST_ANGLE - JAM_ANGLE))])
}

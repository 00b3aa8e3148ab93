//! A waist that an elastic draws in.
//!
//! Shorts and sweatpants lie with a waist far narrower than any wearer's; worn, the elastic gives
//! way. The drawn-in waist is not the body's, and the cloth beneath it is not cut so
//! narrow: it is as wide as the wearer's waist at least. How much wider the cloth is cut under the
//! elastic a photo does not show. Limits: a waist that is too narrow because the scale is wrong, of
//! a garment whose hip fits all the same, is taken for an elastic one. A skirt may flare from a
//! waist of its own width, so that its hip tells nothing of it: skirts are left as they lie.

use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use toile_core::prelude::*;

/// A garment may be narrower than the body by this share: a knit stretches so far (a quarter).
pub(super) const NARROWEST: f64 = 0.8;
/// A waist narrower than this share of the hip is drawn in: of bodies it is 0.7 at least, and
/// garments are cut straighter than bodies.
const DRAWN_IN: f64 = 0.66;
/// Around such a waist the garment is wider than its wearer by this share.
const EASE: f64 = 0.03;

/// Whether a waist of that girth lies drawn in, above a hip of that girth.
pub(super) fn is_drawn_in(form: &Form, waist: f64, hip: f64) -> bool {
    form.has_legs() && waist < DRAWN_IN * hip
}

/// Widens the waist of a fit that no one could wear as it lies to the body's; both girths, metres,
/// before and after. `None` where the waist is left as it is.
pub(super) fn stretched(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let k = form.at(EdgeRole::Waist).filter(|k| *k > 0)?;
    let waist = 2.0 * fit.sides.iter().map(|s| s[k].a.x).sum::<f64>();
    let (hip, needed) = (fit.hip(form)?, *body.measurements.get("waist")?);
    let wide = (needed * (1.0 + EASE)).min(hip);
    if !is_drawn_in(form, waist, hip) || waist >= NARROWEST * needed || waist <= 0.0 || wide <= waist {
        return None;
    }
    for side in &mut fit.sides {
        side[k].a.x *= wide / waist;
        side[k - 1].b = side[k].a;
    }
    Some([waist, wide])
}

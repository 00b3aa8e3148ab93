//! What an elastic or a rib draws in: the waist of shorts, the cuffs of a sweater.
//!
//! Shorts and sweatpants lie with a waist far narrower than any wearer's; worn, the elastic gives
//! way. The drawn-in waist is not the body's, and the cloth beneath it is not cut so
//! narrow: it is nearly as wide as the wearer's waist at least. How much wider the cloth is cut
//! under the elastic a photo does not show. Limits: a waist that is too narrow because the scale is
//! wrong, of a garment whose hip fits all the same, is taken for an elastic one. A skirt may flare
//! from a waist of its own width, so that its hip tells nothing of it: skirts are left as they lie.
//!
//! Ribbed cuffs lie drawn in likewise, and those of short sleeves folded. Where a rib or a fold may
//! make so much, they are cut as wide as the wearer's arm is there.

use super::wearable::{NARROWEST, narrower_cuff};
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use toile_core::prelude::*;

/// A waist narrower than this share of the hip is drawn in: of bodies it is 0.7 at least, and
/// garments are cut straighter than bodies.
const DRAWN_IN: f64 = 0.66;
/// A rib draws a cuff in, and a fold hides of it, to no less than this share of the arm.
const RIB: f64 = 0.6;
/// Around such a waist the garment is narrower than its wearer by this share, so that it holds; and
/// around such a cuff it is wider.
const HOLDS: f64 = 0.04;
const EASE: f64 = 0.03;

/// Whether a waist of that girth lies drawn in, above a hip of that girth.
pub(super) fn is_drawn_in(form: &Form, waist: f64, hip: f64) -> bool {
    form.has_legs() && waist < DRAWN_IN * hip
}

/// Widens what lies drawn in; what it is, and its girths before and after, metres.
pub(super) fn all_stretched(fit: &mut Fit, form: &Form, body: &Body) -> Vec<(&'static str, [f64; 2])> {
    let waist = stretched_waist(fit, form, body).map(|girths| ("the waist", girths));
    let cuffs = stretched_cuffs(fit, form, body).map(|girths| ("the narrower cuff", girths));
    waist.into_iter().chain(cuffs).collect()
}

/// Widens the waist of a fit that no one could wear as it lies to the body's; both girths, metres,
/// before and after. `None` where the waist is left as it is.
fn stretched_waist(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let k = form.at(EdgeRole::Waist).filter(|k| *k > 0)?;
    let waist = 2.0 * fit.sides.iter().map(|s| s[k].a.x).sum::<f64>();
    let (hip, needed) = (fit.hip(form)?, *body.measurements.get("waist")?);
    let wide = (needed * (1.0 - HOLDS)).min(hip);
    if !is_drawn_in(form, waist, hip) || waist >= NARROWEST * needed || waist <= 0.0 || wide <= waist {
        return None;
    }
    for side in &mut fit.sides {
        side[k].a.x *= wide / waist;
        side[k - 1].b = side[k].a;
    }
    Some([waist, wide])
}

/// Widens cuffs that no one could wear as they lie to the wearer's arm; girths of
/// the narrower one, metres, before and after. `None` where they are left as they are.
fn stretched_cuffs(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let k = form.underarm()?;
    let narrower = narrower_cuff(form, fit, body)?;
    let wide = narrower.body * (1.0 + EASE);
    if narrower.garment >= NARROWEST * narrower.body || narrower.garment < RIB * narrower.body {
        return None;
    }
    for side in &mut fit.sides {
        let cuff = side[k + 1];
        let times = 0.5 * wide / cuff.length().max(f64::MIN_POSITIVE);
        if times > 1.0 {
            side[k + 1].a = cuff.b + (cuff.a - cuff.b) * times;
            side[k].b = side[k + 1].a;
        }
    }
    Some([narrower.garment, wide])
}

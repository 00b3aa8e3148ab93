//! What an elastic or a rib draws in: the waist of shorts, the cuffs of a sweater.
//!
//! Shorts and sweatpants lie with a waist far narrower than any wearer's; worn, the elastic gives
//! way. The drawn-in waist is not the body's, and the cloth beneath it is not cut so
//! narrow: it is nearly as wide as the wearer's waist at least. How much wider the cloth is cut
//! under the elastic a photo does not show. Limits: a waist that is too narrow because the scale is
//! wrong, of a garment whose hip fits all the same, is taken for an elastic one. A skirt may flare
//! from a waist of its own width, so that its hip tells nothing of it: skirts are left as they lie.
//!
//! Ribbed cuffs and hems of legs lie drawn in likewise, and cuffs of short sleeves folded. Where a
//! rib or a fold may make so much, they are cut as wide as the wearer's arm or leg is there. An
//! armhole whose sleeve hangs beside the body lies folded, and is cut as deep as the arm needs it.

use super::pieces;
use super::wearable::{NARROWEST, narrow_ankle, narrow_wrist, narrower_cuff, narrower_hem, upper_arm};
use crate::style::block::template::bow::Bow;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::flat::Side;
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::Layer;
use toile_core::prelude::*;

/// A waist narrower than this share of the hip is drawn in: of bodies it is 0.7 at least, and
/// garments are cut straighter than bodies.
const DRAWN_IN: f64 = 0.66;
/// A rib draws a cuff in, and a fold hides of it, to no less than this share of the arm.
const RIB: f64 = 0.5;
/// The cuff of a short sleeve that is narrower than this share of the arm is cut wider: the armhole
/// beside it does not give way.
const SHORT_CUFF: f64 = 0.9;
/// No more than this share of a sleeve is cut off.
const MOST_OFF: f64 = 0.3;
/// Around such a waist the garment is narrower than its wearer by this share, so that it holds, and
/// no more, since it would be drawn up into the fork; a belt draws a waist in by less; and around
/// such a cuff it is wider.
const HOLDS: f64 = 0.06;
const BELT: f64 = 0.03;
/// A belt draws in a waist that is wider than the wearer's by these shares: less holds at the hip,
/// and more is another's.
const BELTED: [f64; 2] = [0.08, 0.4];
/// A waist that is wider than this share of the wearer's hip slides over it: children's are hardly
/// narrower than their hips.
const HELD: f64 = 0.88;
const EASE: f64 = 0.03;
/// Half an armhole, from the armpit straight to the shoulder point, is no shorter than this share
/// of the upper arm's girth: an armhole is some 40 % longer than the upper arm is around (Aldrich
/// 2008).
const ARMHOLE: f64 = 0.68;
/// The lowering of an armpit is found in so many steps, and is no more than this share of the
/// side's length.
const LOWERINGS: usize = 8;
const LOWEST: f64 = 0.3;

/// Whether a waist of that girth lies drawn in, above a hip of that girth.
pub(super) fn is_drawn_in(form: &Form, waist: f64, hip: f64) -> bool {
    form.has_legs() && waist < DRAWN_IN * hip
}

/// Widens what lies drawn in or folded; what it is, and its girths before and after, metres.
pub(super) fn all_stretched(fit: &mut Fit, form: &Form, body: &Body) -> Vec<(&'static str, [f64; 2])> {
    let waist = stretched_waist(fit, form, body).map(|girths| ("the waist", girths));
    let armhole = stretched_armholes(fit, form, body).map(|girths| ("the narrower armhole", girths));
    let cuffs = stretched_cuffs(fit, form, body).map(|girths| ("the narrower cuff", girths));
    let hems = stretched_hems(fit, form, body).map(|girths| ("the narrower leg", girths));
    [waist, armhole, cuffs, hems].into_iter().flatten().collect()
}

/// Cuts the waist of trousers as it is worn: what lies drawn in is widened to the wearer's, and
/// what is wider than that is drawn in, as a belt does it; both girths, metres, before and after.
/// `None` where the waist is left as it is.
fn stretched_waist(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let k = form.at(EdgeRole::Waist).filter(|k| *k > 0 && form.has_legs())?;
    let waist = 2.0 * fit.sides.iter().map(|s| s[k].a.x).sum::<f64>();
    let (hip, needed) = (fit.hip(form)?, *body.measurements.get("waist")?);
    let [least, most] = BELTED.map(|share| needed * (1.0 + share));
    let held = HELD * body.measurements.get("hip").copied().unwrap_or(f64::INFINITY);
    let wide = if is_drawn_in(form, waist, hip) && waist < NARROWEST * needed {
        (needed * (1.0 - HOLDS)).min(hip)
    } else if held < needed && (held..least).contains(&waist) {
        held * (1.0 - BELT)
    } else if (least..most).contains(&waist) {
        needed * (1.0 - BELT)
    } else {
        return None;
    };
    if waist <= 0.0 {
        return None;
    }
    for side in &mut fit.sides {
        side[k].a.x *= wide / waist;
        side[k - 1].b = side[k].a;
    }
    Some([waist, wide])
}

/// Shortens limbs whose narrow ends lie beyond the wearer's; what it is and why, and by how much,
/// metres.
pub(super) fn all_shortened(fit: &mut Fit, form: &Form, body: &Body) -> Vec<(&'static str, f64)> {
    let legs = shortened_legs(fit, form, body)
        .map(|by| ("the legs: no foot passes through their hems, which lie below the ankle", by));
    let sleeves = shortened_sleeves(fit, form, body)
        .map(|by| ("the sleeves: no hand passes through their cuffs, which lie below the wrist", by));
    legs.into_iter().chain(sleeves).collect()
}

/// Moves the cuffs up along the underarm.
fn shortened_sleeves(fit: &mut Fit, form: &Form, body: &Body) -> Option<f64> {
    let k = form.underarm()?;
    let below = narrow_wrist(form, fit, body)?;
    let shorter = fit.sides.iter().map(|side| (side[k].b - side[k].a).norm()).fold(f64::INFINITY, f64::min);
    let off = below.min(MOST_OFF * shorter);
    for side in &mut fit.sides {
        let along = side[k].b - side[k].a;
        let up = along * (off / along.norm().max(f64::MIN_POSITIVE));
        side[k + 1].a -= up;
        side[k + 1].b -= up;
        side[k].b = side[k + 1].a;
        side[k + 2].a = side[k + 1].b;
    }
    Some(off)
}

/// Moves the hems up.
fn shortened_legs(fit: &mut Fit, form: &Form, body: &Body) -> Option<f64> {
    let k = form.at(EdgeRole::Hem).filter(|k| form.has_legs() && *k > 0)?;
    let ankle = narrow_ankle(form, fit, body)?;
    for side in &mut fit.sides {
        side[k].a.y += ankle;
        side[k].b.y += ankle;
        side[k - 1].b = side[k].a;
        side[k + 1].a = side[k].b;
    }
    Some(ankle)
}

/// Widens cuffs that no one could wear as they lie to the wearer's arm; girths of
/// the narrower one, metres, before and after. `None` where they are left as they are.
fn stretched_cuffs(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let k = form.underarm()?;
    let narrower = narrower_cuff(form, fit, body)?;
    match is_short(fit, form) {
        true => lowered_cuffs(fit, k, narrower.garment, narrower.body),
        false => stretched_ends(fit, k + 1, narrower.garment, narrower.body),
    }
}

fn is_short(fit: &Fit, form: &Form) -> bool {
    (0..2).any(|side| pieces::lying_sleeve_of(fit, form, side).is_some_and(|shape| shape.is_short()))
}

/// Widens the cuffs of short sleeves by lowering their underarm seams along the sides: the seam of
/// number `k` keeps its length, and the armhole becomes deeper by as much.
fn lowered_cuffs(fit: &mut Fit, k: usize, garment: f64, body: f64) -> Option<[f64; 2]> {
    let wide = 0.5 * body * (1.0 + EASE);
    if k == 0 || garment >= SHORT_CUFF * body || garment < RIB * body {
        return None;
    }
    for side in &mut fit.sides {
        let (cuff, down) = (side[k + 1].a - side[k + 1].b, side[k - 1].a - side[k - 1].b);
        let most = LOWEST * down.norm();
        let Some(down) = down.try_normalize(1e-9) else { continue };
        let along = cuff.dot(&down);
        let by = (along * along - cuff.norm_squared() + wide * wide).max(0.0).sqrt() - along;
        if cuff.norm() < wide {
            lower(side, k, down * by.clamp(0.0, most), true);
        }
    }
    let narrower = fit.sides.iter().map(|side| 2.0 * side[k + 1].length()).fold(f64::INFINITY, f64::min);
    (narrower > garment + 1e-3).then_some([garment, narrower])
}

/// Moves the armpit where edge `k` begins, and with it the underarm's end at the cuff.
fn lower(side: &mut [Bow], k: usize, by: Vector2, with_cuff: bool) {
    side[k].a += by;
    side[k - 1].b = side[k].a;
    if with_cuff {
        side[k].b += by;
        side[k + 1].a = side[k].b;
    }
}

/// The same of the hems of legs.
fn stretched_hems(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    let narrower = narrower_hem(form, fit, body)?;
    stretched_ends(fit, form.at(EdgeRole::Hem)?, narrower.garment, narrower.body)
}

/// Widens the ends of limbs, edges of that number of which the narrower goes around `garment`, to
/// a limb of `body`, metres.
fn stretched_ends(fit: &mut Fit, k: usize, garment: f64, body: f64) -> Option<[f64; 2]> {
    let wide = body * (1.0 + EASE);
    if k == 0 || garment >= NARROWEST * body || garment < RIB * body {
        return None;
    }
    for side in &mut fit.sides {
        let end = side[k];
        let times = 0.5 * wide / end.length().max(f64::MIN_POSITIVE);
        if times > 1.0 {
            side[k].a = end.b + (end.a - end.b) * times;
            side[k - 1].b = side[k].a;
        }
    }
    Some([garment, wide])
}

/// Lowers the armpits of a fit whose armholes no one could wear as they lie; girths of the narrower
/// one, metres, before and after. `None` where they are left as they are.
fn stretched_armholes(fit: &mut Fit, form: &Form, body: &Body) -> Option<[f64; 2]> {
    // Sleeves cut in one with the trunk leave it at their cuffs.
    let k = form.armpit().or_else(|| form.at(EdgeRole::Cuff)).filter(|k| *k > 0)?;
    let needed = ARMHOLE * upper_arm(body)?;
    let chord = |fit: &Fit, side: usize| match form.underarm() {
        Some(_) => pieces::armhole(&Side::of(fit, form, Layer::Front, side), form),
        None => Some((fit.sides[side][k].b - fit.sides[side][k].a).norm()),
    };
    let narrower = |fit: &Fit| Some(2.0 * chord(fit, 0)?.min(chord(fit, 1)?));
    let before = narrower(fit)?;
    let with_cuffs = is_short(fit, form);
    for side in 0..2 {
        let [low, armpit] = [fit.sides[side][k - 1].a, fit.sides[side][k].a];
        for _ in 0..LOWERINGS {
            let lacks = needed - chord(fit, side)?;
            let most = LOWEST * (armpit - low).norm() - (fit.sides[side][k].a - armpit).norm();
            let by = lacks.min(most);
            if by <= 1e-4 {
                break;
            }
            let down = (low - armpit).try_normalize(1e-9)?;
            lower(&mut fit.sides[side], k, down * by, with_cuffs);
        }
    }
    let after = narrower(fit)?;
    (after > before + 1e-3).then_some([before, after])
}

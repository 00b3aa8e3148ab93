//! What is told of a fit: how far the outline strays from the template, and how unevenly the
//! garment lies.

use super::Sides;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use toile_core::prelude::*;

/// What is more than this share of the garment's size is told.
const TOLD: f64 = 0.025;
/// From this share on a stray edge is to be looked at.
const FAR: f64 = 0.05;
/// And a difference of both sides.
const APART: f64 = 0.15;

/// The value that 19 of 20 do not exceed.
pub(super) fn at_95(misses: &[f64]) -> f64 {
    let mut sorted = misses.to_vec();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, 0.95)
}

/// How far the outline strays from the template, by edges.
pub(super) fn figures(panel: &str, form: &Form, fit: &Fit, cx: &Context) {
    for (e, misses) in form.edges.iter().zip(&fit.misses).filter(|(_, m)| !m.is_empty()) {
        cx.figure(&format!("stray_{panel}_{}", e.role), at_95(misses) * 1e3, "mm");
    }
}

/// Tells edges from which the outline strays far, all in one sentence.
pub(super) fn astray(panel: &str, form: &Form, fit: &Fit, size: f64, cx: &Context) {
    let strays = form.edges.iter().zip(&fit.misses).filter(|(_, m)| !m.is_empty());
    let far: Vec<(EdgeRole, f64)> =
        strays.map(|(e, m)| (e.role, at_95(m))).filter(|(_, stray)| *stray > TOLD * size).collect();
    let list: Vec<String> =
        far.iter().map(|(role, stray)| format!("its {role} by {:.0} mm", stray * 1e3)).collect();
    let text = format!("\"{panel}\" strays from {}, and is cut as one: {}", form.word, and(&list));
    match far.iter().map(|(_, stray)| *stray).fold(0.0, f64::max) {
        most if most > FAR * size => cx.warn(text),
        most if most > 0.0 => cx.note(text),
        _ => {}
    }
}

/// Words as a list: `a, b and c`.
fn and(words: &[String]) -> String {
    match words {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

/// Tells what was taken apart along a border that only the network sees.
pub(super) fn apart(panel: &str, what: &[&'static str], cx: &Context) {
    if !what.is_empty() {
        let list = and(&what.iter().map(|w| (*w).to_owned()).collect::<Vec<String>>());
        cx.note(format!(
            "\"{panel}\" is cut as if {list} lay apart: the network sees where the one ends and the other begins; --set 'style.network=false' keeps the outline as it is"
        ));
    }
}

/// Tells that one half alone looks like the garment; side 0 lies to the right as one looks at the
/// photo.
pub(super) fn one_half(panel: &str, form: &Form, side: usize, cx: &Context) {
    let [seen, other] = if side == 0 { ["right", "left"] } else { ["left", "right"] };
    cx.warn(format!(
        "only the {seen} half of \"{panel}\" in the photo looks like {}: the {other} one is cut as its mirror image",
        form.word
    ));
}

/// Tells edges that are longer on one side, all in one sentence: the garment lies uneven.
pub(super) fn uneven(panel: &str, form: &Form, fit: &Fit, size: f64, sides: Sides, cx: &Context) {
    let cut = match sides {
        Sides::Alike => "both sides are cut alike (--set 'style.sides=AsTheyLie' keeps them apart)",
        Sides::AsTheyLie => "it is cut as it lies",
    };
    let mut uneven: Vec<(String, f64)> = Vec::new();
    let mut k = 0;
    while k < form.edges.len() {
        let role = form.edges[k].role;
        // Where the one ends and the other begins a flat garment does not show.
        let goes_on = |next: EdgeRole| {
            matches!(
                (role, next),
                (EdgeRole::Top, EdgeRole::Shoulder) | (EdgeRole::Side | EdgeRole::Outseam, EdgeRole::Hip)
            )
        };
        let both = form.edges.get(k + 1).is_some_and(|next| goes_on(next.role));
        let length = |s: usize| (k..=k + usize::from(both)).map(|i| fit.sides[s][i].length()).sum::<f64>();
        let differ = (length(0) - length(1)).abs();
        if differ > TOLD * size {
            uneven.push((format!("its {role} by {:.0} mm", differ * 1e3), differ));
        }
        k += 1 + usize::from(both);
    }
    let list: Vec<String> = uneven.iter().map(|(text, _)| text.clone()).collect();
    let text = format!("\"{panel}\" lies uneven, {}; {cut}", and(&list));
    match uneven.iter().map(|(_, differ)| *differ).fold(0.0, f64::max) {
        most if most > APART * size => cx.warn(text),
        most if most > 0.0 => cx.note(text),
        _ => {}
    }
}

//! What is told of a fit: how far the outline strays from the template, and how unevenly the garment lies.

use super::Sides;
use super::fit::Fit;
use super::form::Form;
use toile_core::prelude::*;

/// What is more than this share of the garment's size is told.
const TOLD: f64 = 0.025;

/// The value that 19 of 20 do not exceed.
pub(super) fn at_95(misses: &[f64]) -> f64 {
    let mut sorted = misses.to_vec();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, 0.95)
}

/// How far the outline strays from the template, by edges.
pub(super) fn figures(panel: &str, form: &Form, fit: &Fit, cx: &Context) {
    for (e, misses) in form.edges.iter().zip(&fit.misses).filter(|(_, m)| !m.is_empty()) {
        cx.figure(&format!("stray_{panel}_{}", e.name), at_95(misses) * 1e3, "mm");
    }
}

/// Tells edges from which the outline strays far.
pub(super) fn astray(panel: &str, form: &Form, fit: &Fit, size: f64, cx: &Context) {
    for (e, misses) in form.edges.iter().zip(&fit.misses).filter(|(_, m)| !m.is_empty()) {
        let stray = at_95(misses);
        if stray > TOLD * size {
            cx.warn(format!(
                "the {} of \"{panel}\" strays by {:.0} mm from that of {}; it is cut as the block has it",
                e.name,
                stray * 1e3,
                form.word
            ));
        }
    }
}

/// Tells that one half alone looks like the garment; side 0 lies to the right as one looks at the photo.
pub(super) fn one_half(panel: &str, form: &Form, side: usize, cx: &Context) {
    let [seen, other] = if side == 0 { ["right", "left"] } else { ["left", "right"] };
    cx.warn(format!(
        "only the {seen} half of \"{panel}\" in the photo looks like {}: the {other} one is cut as its mirror image",
        form.word
    ));
}

/// Tells edges that are longer on one side: the garment lies uneven.
pub(super) fn uneven(panel: &str, form: &Form, fit: &Fit, size: f64, sides: Sides, cx: &Context) {
    let cut = match sides {
        Sides::Alike => "both sides are cut alike (`Block(sides: AsTheyLie)` keeps them apart)",
        Sides::AsTheyLie => "it is cut as it lies",
    };
    for (k, e) in form.edges.iter().enumerate() {
        let [a, b] = [0, 1].map(|s: usize| fit.sides[s][k].length());
        if (a - b).abs() > TOLD * size {
            cx.warn(format!(
                "\"{panel}\" lies uneven: its {} measures {:.0} mm on one side and {:.0} mm on the other; {cut}",
                e.name,
                a * 1e3,
                b * 1e3
            ));
        }
    }
}

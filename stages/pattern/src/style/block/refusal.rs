//! What is said where no template fits.

use super::tell::at_95;
use crate::style::block::template::fit::Fit;
use crate::style::block::template::form::Form;
use toile_core::prelude::*;

/// What a photographer can do.
pub(in crate::style) const LAY: &str = "lay the garment flat and smooth, neck or waist up, sleeves and legs away from the body, all of it in the picture";

pub(in crate::style) fn no_front() -> StageError {
    StageError::invalid("there is no photo \"front\" to cut the garment from")
        .hint("call the photo of the garment's front \"front\"")
}

pub(super) fn no_axis(panel: &str) -> StageError {
    StageError::invalid(format!("the garment in \"{panel}\" has no left and right half")).hint(LAY)
}

/// No form at all, with the reason of each.
pub(super) fn none(panel: &str, reasons: &[(&Form, &'static str)]) -> StageError {
    match reasons {
        [(form, reason)] => {
            StageError::invalid(format!("\"{panel}\" does not look like {}: {reason}", form.word))
                .hint(stated_hint())
        }
        _ => {
            let words: Vec<&str> = reasons.iter().map(|(form, _)| form.word).collect();
            StageError::invalid(format!("\"{panel}\" looks like none of these: {}", words.join(", ")))
                .hint(LAY)
        }
    }
}

/// A form that fits, of a garment that the network takes for another kind.
pub(super) fn another(panel: &str, form: &Form, kind: &str, probability: f64) -> StageError {
    StageError::invalid(format!(
        "the outline of \"{panel}\" is that of {}, but the photo shows {kind}, as the network sees it with a probability of {probability:.2}",
        form.word
    ))
    .hint(format!("{LAY}; or say what it is: --set 'style.style=Vest' --set 'body.style=Vest'"))
}

/// A form that fits badly, with its worst edge.
pub(super) fn strays(panel: &str, form: &Form, fit: &Fit, stray: f64, auto: bool) -> StageError {
    let worst =
        form.edges.iter().zip(&fit.misses).map(|(e, m)| (e.role, if m.is_empty() { 0.0 } else { at_95(m) }));
    let (edge, most) = worst.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((EdgeRole::Hem, stray));
    let looks = if auto { "looks most like" } else { "was to be" };
    StageError::invalid(format!(
        "\"{panel}\" {looks} {}, but strays from one by {:.0} mm, most at its {edge}, by {:.0} mm",
        form.word,
        stray * 1e3,
        most * 1e3
    ))
    .hint(if auto {
        format!("{LAY}; or say what it is: --set 'style.style=Vest' --set 'body.style=Vest'")
    } else {
        stated_hint()
    })
}

/// What helps where the user said what it is.
fn stated_hint() -> String {
    format!("{LAY}; or let it be named: --set 'style.style=Auto' --set 'body.style=Auto'")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::block::template::form::SKIRT;

    #[test]
    fn a_garment_that_the_network_takes_for_another_kind_is_told_with_what_can_be_said() {
        let e = another("front", &SKIRT, "a pair of shorts", 0.973);
        assert_eq!(
            e.to_string(),
            "the outline of \"front\" is that of a skirt, but the photo shows a pair of shorts, as the network sees it with a probability of 0.97"
        );
        let hint = e.hint.unwrap_or_default();
        assert_eq!(
            hint,
            format!("{LAY}; or say what it is: --set 'style.style=Vest' --set 'body.style=Vest'")
        );
    }
}

//! Which seams no longer agree in length.

use crate::style::sewing::MAX_EASE;
use toile_core::prelude::*;

/// Sides that differ by less are of one length, metres.
const SAME: f64 = 5e-4;
/// A side that changed by less did not change, metres.
const KEPT: f64 = 1e-4;

/// Tells the seams whose sides differ in length, of those that changed.
pub(super) fn tell(before: &Pattern, after: &Pattern, cx: &Context) {
    for seam in after.seams.iter().filter(|s| s.kind == SeamKind::Matched) {
        let is = lengths(after, seam);
        let was = before.seams.iter().find(|s| s.name == seam.name).map(|s| lengths(before, s));
        let changed =
            |was: &Vec<f64>| was.len() != is.len() || was.iter().zip(&is).any(|(a, b)| (a - b).abs() > KEPT);
        if was.is_none_or(|was| changed(&was)) {
            differ(seam, &is).into_iter().for_each(|text| cx.note(text));
        }
    }
}

fn lengths(pattern: &Pattern, seam: &PatternSeam) -> Vec<f64> {
    seam.sides.iter().map(|side| pattern.side_length(side)).collect()
}

/// What is said of a seam whose longest and shortest side differ.
fn differ(seam: &PatternSeam, lengths: &[f64]) -> Option<String> {
    let order = |a: &&usize, b: &&usize| lengths[**a].total_cmp(&lengths[**b]);
    let all: Vec<usize> = (0..lengths.len()).collect();
    let (long, short) = (*all.iter().max_by(order)?, *all.iter().min_by(order)?);
    let by = lengths[long] - lengths[short];
    if by <= SAME {
        return None;
    }
    let words = |k: usize| {
        let edges: Vec<String> = seam.sides[k].iter().map(|u| u.edge.to_string()).collect();
        edges.join(" + ")
    };
    let how = match by <= MAX_EASE * lengths[long] {
        true => "eased in",
        false => "gathered",
    };
    Some(format!(
        "{} is {:.1} mm long now, {} {:.1} mm: the longer one is {how} by {:.1} %",
        words(long),
        lengths[long] * 1e3,
        words(short),
        lengths[short] * 1e3,
        100.0 * by / lengths[long]
    ))
}

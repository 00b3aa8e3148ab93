//! The edge of a half piece that lies on the fold, where the pattern does not say which.
//!
//! Method: Seamly2D says of a piece that it is cut on the fold, and not where. Cloth is folded
//! along its grain, so that the edge is straight, runs along the grain, and has the whole piece on
//! one side; of several the longest is taken, which is told.

use super::super::side::{Side, points};
use super::super::unfold::Fold;
use toile_core::Remarks;
use toile_core::prelude::*;

/// An edge runs along the grain to this, as the sine of its angle.
const ALONG: f64 = 0.02;
/// No point of the piece lies beyond the edge by more, metres.
const BEYOND: f64 = 1e-3;

/// The fold of a piece whose grain runs up; none where no edge can lie on it.
pub(super) fn along_grain(sides: &[Side], piece: &str, told: &mut Remarks) -> Option<Fold> {
    let outline = points(sides);
    let folds = sides.iter().filter_map(|s| Some((s, lies(s, &outline)?)));
    let found: Vec<(&Side, Fold)> = folds.collect();
    let longest = found.iter().max_by(|a, b| a.0.length().total_cmp(&b.0.length()))?;
    if found.len() > 1 {
        let others: Vec<&str> =
            found.iter().map(|(s, _)| s.name.as_str()).filter(|n| *n != longest.0.name).collect();
        told.warnings.push(format!(
            "piece \"{piece}\" is cut on the fold, and the pattern does not say at which edge: \"{}\" is taken, not \"{}\"",
            longest.0.name,
            others.join("\", \"")
        ));
    }
    Some(longest.1)
}

/// The line of an edge, where it can lie on a fold.
fn lies(side: &Side, outline: &[Point2]) -> Option<Fold> {
    let way = side.end() - side.start;
    let fold = Fold::through(side.start, side.end())?;
    let is_up = way.x.abs() <= ALONG * way.norm() && fold.holds(std::slice::from_ref(side));
    let beyond = |p: &Point2| way.perp(&(p - side.start)) / way.norm();
    let is_at_side =
        outline.iter().all(|p| beyond(p) >= -BEYOND) || outline.iter().all(|p| beyond(p) <= BEYOND);
    (is_up && is_at_side).then_some(fold)
}

//! Whether cloth can be cut to a changed piece, and how far a change goes where it cannot.

use crate::mesh::crossing::first_crossing;
use crate::mesh::predicates::{distance_to_segment, inside};
use toile_core::prelude::*;

/// Halvings that find how far a change goes.
const HALVINGS: usize = 10;
/// No edge is shorter than this, metres.
const LEAST: f64 = 1e-4;
/// Points of lines may lie so far outside of the outline, metres: they end on edges.
const OUTSIDE: f64 = 1e-3;

/// The piece changed by the whole of what is asked.
///
/// # Errors
/// No cloth can be cut to it. The hint tells the change that goes, as `told` writes a share of it.
pub(super) fn whole(
    before: &Piece,
    changed: impl Fn(f64) -> Piece,
    told: impl Fn(f64) -> Option<String>,
) -> Result<Piece, StageError> {
    let after = changed(1.0);
    let Some(what) = fault(before, &after) else { return Ok(after) };
    let (mut goes, mut fails) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let share = 0.5 * (goes + fails);
        match fault(before, &changed(share)) {
            None => goes = share,
            Some(_) => fails = share,
        }
    }
    let hint = told(goes).map_or_else(
        || "it cannot be moved that way at all".to_owned(),
        |text| format!("so far it goes: {text}"),
    );
    Err(refused(before, &what).hint(hint))
}

/// The refusal of a change, by what is wrong with it.
pub(super) fn refused(piece: &Piece, what: &str) -> StageError {
    StageError::invalid(format!("\"{}\" could not be cut so: {what}", piece.name))
}

/// What is wrong with a piece that was changed, and was not before.
pub(super) fn fault(before: &Piece, after: &Piece) -> Option<String> {
    let n = after.outer.edges.len();
    let short =
        (0..n).find(|k| after.outer.path(*k).length().is_nan() || after.outer.path(*k).length() < LEAST);
    if let Some(k) = short {
        return Some(format!("its {} would have no length", after.outer.edges[k].name));
    }
    if let Some(what) = meeting(after).filter(|_| meeting(before).is_none()) {
        return Some(what);
    }
    let outline = after.outer.points().0;
    if polygon_area(&outline) <= 0.0 {
        return Some("it would be turned inside out".to_owned());
    }
    let lies_out = |h: &PatternLoop| h.corners.iter().any(|c| !inside(&outline, *c));
    if after.holes.iter().any(lies_out) {
        return Some("a hole of it would lie outside".to_owned());
    }
    let line = outside(&outline, after)?;
    (outside(&before.outer.points().0, before).as_ref() != Some(&line))
        .then(|| format!("its line {line} would lie outside"))
}

/// Which edges of a piece meet where they should not, in words.
fn meeting(piece: &Piece) -> Option<String> {
    let (mut points, mut segments, mut names) = (Vec::<Point2>::new(), Vec::new(), Vec::new());
    for l in std::iter::once(&piece.outer).chain(&piece.holes) {
        let (drawn, corners) = l.points();
        let from = points.len() as u32;
        let mut kept: Vec<(Point2, usize)> = Vec::with_capacity(drawn.len());
        for (i, p) in drawn.iter().enumerate() {
            if kept.last().is_none_or(|(q, _)| q != p) {
                kept.push((*p, corners.partition_point(|c| *c <= i).saturating_sub(1)));
            }
        }
        while kept.len() > 1 && kept.first().map(|k| k.0) == kept.last().map(|k| k.0) {
            kept.pop();
        }
        let n = kept.len() as u32;
        segments.extend((0..n).map(|k| [from + k, from + (k + 1) % n]));
        names.extend(kept.iter().map(|(_, edge)| l.edges[*edge].name.as_str()));
        points.extend(kept.into_iter().map(|(p, _)| p));
    }
    let [i, j] = first_crossing(&points, &segments)?;
    Some(match names[i] == names[j] {
        true => format!("its {} would cross itself", names[i]),
        false => format!("its {} would cross its {}", names[i], names[j]),
    })
}

/// The first line that leaves the outline.
fn outside(outline: &[Point2], piece: &Piece) -> Option<String> {
    let n = outline.len();
    let off = |p: &Point2| {
        let sides = (0..n).map(|i| distance_to_segment(*p, outline[i], outline[(i + 1) % n]).0);
        sides.fold(f64::INFINITY, f64::min)
    };
    let leaves = |p: &Point2| !inside(outline, *p) && off(p) > OUTSIDE;
    piece.lines.iter().find(|l| l.points.iter().any(leaves)).map(|l| l.name.clone())
}

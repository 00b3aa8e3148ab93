//! Where an outline asks for short edges: where it curves, and where the cloth is narrow.
//!
//! Method: at points along each stretch the longest chord is found, of a ladder of lengths, that
//! leaves the curve no farther than meshers are allowed (as gauges do for whole edges). Where the
//! other side of the cloth is near, straight across, edges are a share of the way there (the local
//! feature size of Ruppert 1995, of sides that do not meet nearby). Cost: points of the outline
//! times the points under a chord; samples times their neighbours within reach. Limits: inner lines
//! ask for short edges where they curve, not where they run near something.

use super::super::layout::Layout;
use super::super::polyline::Polyline;
use super::field::{Range, SizeField};
use std::collections::BTreeMap;
use toile_core::artifact::{CHORD_TOLERANCE, Point2, Vector2};
use toile_core::{Context, StageError};

/// From a chord to the next shorter one.
const RATIO: f64 = 1.15;
/// Chords shorter than this share of the longest edge are a matter of a missed corner, not of the
/// curve.
const LEAST_SHARE: f64 = 1.0 / 8.0;
/// Samples to an edge of the shortest length.
const SAMPLES_AN_EDGE: f64 = 2.0;
/// Edges across the narrowest cloth.
const ACROSS: f64 = 3.0;
/// Cosine between "straight across" and the way to the other side.
const FACING: f64 = 0.7;
/// Samples between two looks at the stop flag.
const CHECK_EVERY: usize = 200;
/// Sides meet nearby where the way along the outline is no longer than so many times the way
/// across.
const MEETS: f64 = 4.0;

/// Lowers the field along everything that a mesh must follow; [`SizeField::spread`] is for the
/// caller.
pub(crate) fn lower_along(
    field: &mut SizeField,
    layout: &Layout<'_>,
    cx: &Context,
) -> Result<(), StageError> {
    let range = field.range();
    let stretches = layout.stretches().map(|s| (&s.line, &s.marks));
    for (line, marks) in stretches.chain(layout.lines.iter().map(|l| (&l.path, &l.marks))) {
        for (k, arc) in samples(line, range.fine).enumerate() {
            if k % CHECK_EVERY == 0 {
                cx.check()?;
            }
            field.lower(line.at(arc), chord_at(line, marks, arc, range));
        }
    }
    let border: Vec<Vec<Sample>> =
        layout.loops.iter().map(|stretches| rim(stretches.iter().map(|s| &s.line), range.fine)).collect();
    for (p, size) in narrow(&border, range, cx)? {
        field.lower(p, size);
    }
    Ok(())
}

/// Arc lengths at most half of the shortest edge apart, both ends included.
pub(crate) fn samples(line: &Polyline, fine: f64) -> impl Iterator<Item = f64> + use<> {
    let length = line.length();
    let n = (length * SAMPLES_AN_EDGE / fine).ceil().max(1.0) as usize;
    (0..=n).map(move |k| length * (k as f64 / n as f64))
}

/// The longest chord about a point of a line that stays true, metres; marks are corners, across
/// which no chord runs.
fn chord_at(line: &Polyline, marks: &[f64], arc: f64, range: Range) -> f64 {
    let k = marks.partition_point(|m| *m <= arc);
    let from = if k > 0 { marks[k - 1] } else { 0.0 };
    let to = marks.get(k).copied().unwrap_or(line.length());
    let allowed = 0.5 * CHORD_TOLERANCE * range.edge;
    let least = range.fine.min(LEAST_SHARE * range.edge);
    let mut chord = range.edge;
    // Near a corner the chord begins there, so that the curve's end is judged by whole chords as
    // well.
    let sag = |chord: f64| {
        let start = (arc - chord / 2.0).min(to - chord).max(from);
        line.sag(start, (start + chord).min(to))
    };
    while chord > least && sag(chord) > allowed {
        chord /= RATIO;
    }
    chord
}

/// A point of a loop, with the way into the cloth and the arc length from the loop's start.
struct Sample {
    at: Point2,
    inward: Vector2,
    arc: f64,
}

/// Samples along a loop that has the cloth on its left, in the middle between the samples of
/// [`samples`].
fn rim<'a>(lines: impl Iterator<Item = &'a Polyline>, fine: f64) -> Vec<Sample> {
    let mut out = Vec::new();
    let mut before = 0.0;
    for line in lines {
        let arcs: Vec<f64> = samples(line, fine).collect();
        for w in arcs.windows(2) {
            let (a, b) = (line.at(w[0]), line.at(w[1]));
            let inward = Vector2::new(a.y - b.y, b.x - a.x).try_normalize(0.0).unwrap_or_default();
            out.push(Sample { at: nalgebra::center(&a, &b), inward, arc: before + (w[0] + w[1]) / 2.0 });
        }
        before += line.length();
    }
    out
}

/// Where the cloth is narrow, and how long edges should be there, metres.
fn narrow(border: &[Vec<Sample>], range: Range, cx: &Context) -> Result<Vec<(Point2, f64)>, StageError> {
    let reach = ACROSS * range.edge;
    let cell = |p: Point2| ((p.x / reach).floor() as i64, (p.y / reach).floor() as i64);
    let mut cells: BTreeMap<(i64, i64), Vec<(usize, &Sample)>> = BTreeMap::new();
    for (l, rim) in border.iter().enumerate() {
        rim.iter().for_each(|s| cells.entry(cell(s.at)).or_default().push((l, s)));
    }
    let lengths: Vec<f64> = border.iter().map(|r| r.last().map_or(0.0, |s| s.arc)).collect();
    let across = |l: usize, s: &Sample| {
        let (i, j) = cell(s.at);
        let near = (j - 1..=j + 1).flat_map(|y| (i - 1..=i + 1).map(move |x| (x, y)));
        let others = near.filter_map(|c| cells.get(&c)).flatten();
        let ways = others.filter_map(|(m, o)| way_across(s, o, (l == *m).then_some(lengths[l])));
        ways.fold(reach, f64::min)
    };
    let all = border.iter().enumerate().flat_map(|(l, rim)| rim.iter().map(move |s| (l, s)));
    let mut sized = Vec::new();
    for (k, (l, s)) in all.enumerate() {
        if k % CHECK_EVERY == 0 {
            cx.check()?;
        }
        sized.push((s.at, across(l, s) / ACROSS));
    }
    sized.retain(|(_, size)| *size < range.edge);
    Ok(sized)
}

/// The way through the cloth from one sample to another that faces it; `round` is the length of the
/// loop that both are on.
fn way_across(from: &Sample, to: &Sample, round: Option<f64>) -> Option<f64> {
    let way = to.at - from.at;
    let far = way.norm();
    let faces = way.dot(&from.inward) > FACING * far && -way.dot(&to.inward) > FACING * far;
    let meets = round.is_some_and(|round| {
        let along = (from.arc - to.arc).abs();
        along.min(round - along) <= MEETS * far
    });
    (faces && !meets).then_some(far)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::super::fixtures::{disc, p, rectangle, vest};
    use super::*;
    use toile_core::artifact::Outline;

    const RANGE: Range = Range { fine: 0.006, edge: 0.024, grading: 0.3 };

    fn sized(outline: &Outline) -> SizeField {
        let mut field = SizeField::new(outline.bounds(), RANGE);
        lower_along(&mut field, &Layout::of(outline, RANGE.fine), &Context::quiet()).unwrap();
        field.spread();
        field
    }

    #[test]
    fn a_circle_asks_for_the_chord_that_its_radius_allows() {
        // sag = s^2 / 8 r, allowed is a hundredth of the longest edge; one rung of the ladder more
        // or less.
        let wanted = (8.0 * 0.2 * 0.01 * RANGE.edge).sqrt();
        let found = sized(&disc()).at(p(0.2, 0.0));
        assert!(found <= wanted * 1.08 && found > wanted / RATIO / 1.08, "{found} for {wanted}");
    }

    #[test]
    fn straight_sides_and_corners_ask_for_nothing() {
        let field = sized(&rectangle(0.4, 0.3));
        for q in [p(0.0, 0.0), p(0.4, 0.3), p(0.2, 0.0), p(0.2, 0.15)] {
            assert!((field.at(q) - RANGE.edge).abs() < 1e-12);
        }
    }

    #[test]
    fn a_strip_has_three_edges_across() {
        let found = sized(&rectangle(0.5, 0.036)).at(p(0.25, 0.0));
        assert!((found - 0.012).abs() < 5e-4, "{found}");
        let thin = sized(&rectangle(0.5, 0.009)).at(p(0.25, 0.0));
        assert!((RANGE.fine..1.1 * RANGE.fine).contains(&thin), "never below the finest: {thin}");
    }

    #[test]
    fn a_vest_is_fine_at_neck_and_armhole_and_coarse_at_its_hem() {
        let field = sized(&vest());
        let (neck, armhole) = (field.at(p(0.0, 0.54)), field.at(p(0.2209, 0.4259)));
        let (hem, middle) = (field.at(p(0.0, 0.0)), field.at(p(0.0, 0.25)));
        assert!(neck < 0.6 * hem && armhole < 0.8 * hem, "{neck} {armhole} {hem}");
        assert!(hem == RANGE.edge && middle == RANGE.edge, "{hem} {middle}");
    }
}

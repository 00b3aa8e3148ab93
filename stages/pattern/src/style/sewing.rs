//! Seams: which edges meet, whether they can, and into how many parts both are divided.
//!
//! Method: both edges of a seam get one [`Gauge`] that suits either, so that meshers divide them
//! alike. A seam's direction is checked by laying both panels face to face and one edge on the
//! other: its threads must not be longer than those of the opposite pairing. Cost: linear in the
//! edges.

use super::block::Layer;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_core::nearest;
use toile_core::prelude::*;

/// Lengths that differ by more than this share are no seam unless it is declared gathered.
pub(super) const MAX_EASE: f64 = 0.03;
/// Lengths that differ by more than this share are eased with a warning.
const EASE_WARNING: f64 = 0.01;
/// Threads of a reversed seam are at least this much longer than those of the right one; edges that
/// run at right angles to each other may be sewn either way.
const REVERSED: f64 = 1.25;
/// Points on an edge at which its threads are measured.
const THREADS: usize = 9;

/// The style's seams between `front` and `back`, for edges that both have.
pub(super) fn pairs(outlines: &Set<Outline>, names: &[&str], cx: &Context) -> Vec<Seam> {
    let [front, back] = Layer::BOTH.map(Layer::word);
    for (panel, _) in outlines.iter().filter(|(p, _)| *p != front && *p != back) {
        cx.warn(format!("the style sews \"{front}\" and \"{back}\"; the panel \"{panel}\" stays unsewn"));
    }
    match (outlines.get(front), outlines.get(back)) {
        (Some(_), Some(_)) => names.iter().map(|n| between(front, back, n)).collect(),
        (one, _) => {
            let lone = if one.is_some() { front } else { back };
            cx.warn(format!(
                "the panel \"{lone}\" has no partner and stays unsewn; give a photo of the other side, or \
                 `MirrorOf(\"{lone}\")` in its place"
            ));
            Vec::new()
        }
    }
}

fn between(a: &str, b: &str, edge: &str) -> Seam {
    let of = |panel: &str| EdgeRef { panel: panel.to_owned(), edge: edge.to_owned() };
    Seam { a: of(a), b: of(b), kind: SeamKind::Matched, reversed: false }
}

/// Checks the seams and lets their edges agree on their divisions.
pub(super) fn sew(
    outlines: &Set<Outline>,
    seams: Vec<Seam>,
    cx: &Context,
) -> Result<(Set<Outline>, SewingPlan), StageError> {
    let mut sewn: BTreeMap<String, Outline> =
        outlines.iter().map(|(k, o)| (k.to_owned(), o.clone())).collect();
    sewn.values_mut().for_each(own_gauges);
    let mut used: Vec<&EdgeRef> = Vec::new();
    for (i, seam) in seams.iter().enumerate() {
        for (k, side) in [&seam.a, &seam.b].into_iter().enumerate() {
            find(&sewn, side).map_err(|e| of_seam(e, i).within(k))?;
            if used.contains(&side) {
                return Err(of_seam(twice(side), i).within(k));
            }
            used.push(side);
        }
        check_lengths(&sewn, seam, cx).map_err(|e| of_seam(e, i))?;
        check_direction(&sewn, seam).map_err(|e| of_seam(e, i))?;
        agree(&mut sewn, seam);
    }
    let sewn = sewn.into_iter().map(|(k, o)| (k, Arc::new(o))).collect();
    Ok((Set(sewn), SewingPlan { seams }))
}

/// Puts an error at the seam of that number, where the file lists seams.
fn of_seam(error: StageError, number: usize) -> StageError {
    error.at("seams").within(number)
}

fn twice(side: &EdgeRef) -> StageError {
    StageError::invalid(format!("the edge {side} stands in more than one seam")).hint("sew every edge once")
}

/// What is wrong with seams by the names of panels and edges alone, as far as these are known
/// before the outlines are.
pub(super) fn misnamed(
    seams: &[Seam],
    panels: Option<&[String]>,
    edges: Option<&[String]>,
) -> Vec<StageError> {
    let (mut used, mut found): (Vec<&EdgeRef>, Vec<StageError>) = (Vec::new(), Vec::new());
    for (i, seam) in seams.iter().enumerate() {
        for (k, side) in [&seam.a, &seam.b].into_iter().enumerate() {
            let is_in = |names: &[String], name: &String| names.contains(name);
            let error = match (panels, edges) {
                (Some(names), _) if !is_in(names, &side.panel) => Some(no_panel(side, &texts(names))),
                (_, Some(names)) if !is_in(names, &side.edge) => Some(no_edge(side, &texts(names))),
                _ if used.contains(&side) => Some(twice(side)),
                _ => None,
            };
            used.push(side);
            found.extend(error.map(|e| of_seam(e, i).within(k)));
        }
    }
    found
}

fn texts(names: &[String]) -> Vec<&str> {
    names.iter().map(String::as_str).collect()
}

fn no_panel(side: &EdgeRef, names: &[&str]) -> StageError {
    let text = format!("there is no panel \"{}\"", side.panel);
    unknown(text, &side.panel, names, |n| format!("{n}.{}", side.edge))
}

fn no_edge(side: &EdgeRef, names: &[&str]) -> StageError {
    let text = format!("the panel \"{}\" has no edge \"{}\"", side.panel, side.edge);
    unknown(text, &side.edge, names, |n| format!("{}.{n}", side.panel))
}

/// The points of an edge or an inner line.
fn find(outlines: &BTreeMap<String, Outline>, side: &EdgeRef) -> Result<Vec<Point2>, StageError> {
    let Some(outline) = outlines.get(&side.panel) else {
        return Err(no_panel(side, &outlines.keys().map(String::as_str).collect::<Vec<_>>()));
    };
    if let Some(edge) = outline.edge(&side.edge) {
        return Ok(outline.edge_points(edge));
    }
    if let Some(line) = outline.inner.iter().find(|l| l.name == side.edge) {
        return Ok(line.points.clone());
    }
    let edges = outline.edges.iter().map(|e| e.name.as_str());
    let names: Vec<&str> = edges.chain(outline.inner.iter().map(|l| l.name.as_str())).collect();
    Err(no_edge(side, &names))
}

fn unknown(text: String, name: &str, names: &[&str], full: impl Fn(&str) -> String) -> StageError {
    let hint = match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean \"{}\"?", full(near)),
        None if names.is_empty() => "its edges have no names; a style must come before".to_owned(),
        None => format!("known are {}", names.join(", ")),
    };
    StageError::invalid(text).hint(hint)
}

fn check_lengths(outlines: &BTreeMap<String, Outline>, seam: &Seam, cx: &Context) -> Result<(), StageError> {
    let [a, b] = [polyline_length(&find(outlines, &seam.a)?), polyline_length(&find(outlines, &seam.b)?)];
    let difference = (a - b).abs() / a.max(b);
    let words = format!("{} is {:.1} mm long, {} {:.1} mm", seam.a, a * 1e3, seam.b, b * 1e3);
    match seam.kind {
        SeamKind::Gathered
        | SeamKind::Dart
        | SeamKind::Pleat(_)
        | SeamKind::Elastic { .. }
        | SeamKind::Patch
        | SeamKind::Folded { .. } => Ok(()),
        SeamKind::Matched if difference.is_nan() || difference > MAX_EASE => Err(StageError::invalid(
            format!("{words}: they differ by {:.1} %, too much to be sewn flat", 100.0 * difference),
        )
        .hint(format!(
            "if the longer one is meant to be gathered, write Gather(\"{}\", \"{}\")",
            seam.a, seam.b
        ))),
        SeamKind::Matched => {
            if difference > EASE_WARNING {
                cx.note(format!("{words}; the longer one is eased in by {:.1} %", 100.0 * difference));
            }
            Ok(())
        }
    }
}

/// Refuses a seam whose threads would cross when both panels lie face to face on the body.
fn check_direction(outlines: &BTreeMap<String, Outline>, seam: &Seam) -> Result<(), StageError> {
    let [a, b] = [&seam.a, &seam.b].map(|side| {
        // As it is seen from before the wearer.
        let sign = if Layer::of_name(&side.panel) == Layer::Back { -1.0 } else { 1.0 };
        let points = find(outlines, side)?;
        Ok::<_, StageError>(evenly(&points).map(|q| Point2::new(sign * q.x, q.y)))
    });
    let (a, b): ([Point2; THREADS], [Point2; THREADS]) = (a?, b?);
    // Only the run of the edges counts, not how far the panels lie apart.
    let centre = |t: &[Point2; THREADS]| t.iter().map(|p| p.coords).sum::<Vector2>() / THREADS as f64;
    let apart = centre(&b) - centre(&a);
    let threads = |reversed: bool| -> f64 {
        (0..THREADS).map(|k| (b[if reversed { k } else { THREADS - 1 - k }] - a[k] - apart).norm()).sum()
    };
    if threads(seam.reversed) <= REVERSED * threads(!seam.reversed) {
        return Ok(());
    }
    let better = if seam.reversed { "Match" } else { "Reversed" };
    let text = format!("the seam {} is reversed: its threads would cross between the panels", seam.name());
    Err(StageError::invalid(text).hint(format!(
        "each edge runs counter-clockwise, and the start of one meets the end of the other; sew the edges \
         that lie on each other, or write {better}(\"{}\", \"{}\")",
        seam.a, seam.b
    )))
}

/// Points of a polyline at equal steps of its length, both ends included.
pub(in crate::style) fn evenly<const N: usize>(points: &[Point2]) -> [Point2; N] {
    let total = polyline_length(points);
    std::array::from_fn(|k| {
        let mut left = total * k as f64 / (N - 1) as f64;
        for w in points.windows(2) {
            let piece = (w[1] - w[0]).norm();
            if left <= piece && piece > 0.0 {
                return w[0] + (w[1] - w[0]) * (left / piece);
            }
            left -= piece;
        }
        points[points.len() - 1]
    })
}

/// Gives every edge the divisions that suit it alone.
fn own_gauges(outline: &mut Outline) {
    let gauges: Vec<Gauge> = outline.edges.par_iter().map(|e| own_gauge(outline, e)).collect();
    outline.edges.iter_mut().zip(gauges).for_each(|(e, gauge)| e.gauge = gauge);
}

/// The divisions that suit an edge alone.
pub(super) fn own_gauge(outline: &Outline, edge: &Edge) -> Gauge {
    let n = outline.outer.points.len();
    let within: Vec<usize> = outline.outer.corners.iter().map(|c| (c + n - edge.start) % n).collect();
    Gauge::of(&outline.edge_points(edge), &within)
}

/// Both edges of a seam take the longer length and the greater sag.
fn agree(outlines: &mut BTreeMap<String, Outline>, seam: &Seam) {
    let gauge = |side: &EdgeRef| Some(outlines.get(&side.panel)?.edge(&side.edge)?.gauge);
    let (Some(a), Some(b)) = (gauge(&seam.a), gauge(&seam.b)) else { return };
    let shared = a.shared(&b);
    for side in [&seam.a, &seam.b] {
        let edge =
            outlines.get_mut(&side.panel).and_then(|o| o.edges.iter_mut().find(|e| e.name == side.edge));
        if let Some(edge) = edge {
            edge.gauge = shared;
        }
    }
}

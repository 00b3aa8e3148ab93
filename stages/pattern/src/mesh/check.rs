//! What an outline must be before it can be meshed, and the words for what it is not.

use super::crossing::first_crossing;
use super::predicates::inside;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// The largest mesh that a mesher makes, triangles: about 1 GB of arrays.
pub(crate) const MAX_TRIANGLES: f64 = 5e6;

/// Points of an outline nearer to each other than this share of its size are one point: far
/// below a pixel, far above rounding.
const SAME_POINT: f64 = 1e-9;

/// Checks the outline against an edge length (metres).
pub(crate) fn check_outline(outline: &Outline, h: f64, cx: &Context) -> Result<(), StageError> {
    check_numbers(outline)?;
    check_size(outline, h)?;
    cx.check()?;
    check_crossings(outline)?;
    check_direction(outline)?;
    check_holes(outline)
}

fn degenerate(message: impl Into<String>) -> StageError {
    StageError::new(ErrorCode::DegenerateTriangles, message)
}

fn check_numbers(outline: &Outline) -> Result<(), StageError> {
    let loops = std::iter::once(&outline.outer).chain(&outline.holes);
    let lines = outline.inner.iter().map(|l| &l.points);
    let finite = |p: &Point2| p.x.is_finite() && p.y.is_finite();
    if !loops.map(|l| &l.points).chain(lines).flatten().all(finite) {
        return Err(StageError::invalid("the outline has a point that is not a finite number"));
    }
    let n = outline.outer.points.len();
    for e in &outline.edges {
        if e.start >= n || e.end >= n {
            return Err(StageError::invalid(format!(
                "edge \"{}\" points outside the outline's {n} points",
                e.name
            )));
        }
    }
    match outline.inner.iter().find(|l| l.points.len() < 2) {
        Some(l) => Err(StageError::invalid(format!("inner line \"{}\" has fewer than two points", l.name))),
        None => Ok(()),
    }
}

fn check_size(outline: &Outline, h: f64) -> Result<(), StageError> {
    if !(h.is_finite() && h > 0.0) {
        return Err(
            StageError::new(ErrorCode::InvalidParameter, "the edge length must be above zero").at("edge")
        );
    }
    if outline.outer.points.len() < 3 {
        return Err(degenerate(format!(
            "the outline has {} points, a panel needs three",
            outline.outer.points.len()
        )));
    }
    let (low, high) = outline.bounds();
    let span = high - low;
    let area = polygon_area(&outline.outer.points);
    if area.abs() <= SAME_POINT * span.norm_squared() {
        return Err(degenerate("the outline encloses no area")
            .hint("is the outline a line that runs forth and back?"));
    }
    if h > span.x.max(span.y) {
        return Err(too_long(h, span));
    }
    let triangles = 4.0 / 3f64.sqrt() * area.abs() / (h * h);
    if triangles > MAX_TRIANGLES {
        let least = (4.0 / 3f64.sqrt() * area.abs() / MAX_TRIANGLES).sqrt();
        return Err(StageError::invalid(format!(
            "an edge of {} would make {:.0} million triangles, the limit is 5 million",
            show(h),
            triangles / 1e6
        ))
        .hint(format!("use an edge of at least {}", show((least * 1e4).ceil() / 1e4)))
        .at("edge"));
    }
    check_segments(outline, h)
}

/// Refuses an outline that would be cut into more segments than a mesh has triangles.
fn check_segments(outline: &Outline, h: f64) -> Result<(), StageError> {
    let loops = std::iter::once(&outline.outer).chain(&outline.holes);
    let round = |l: &Loop| polyline_length(&l.points) / h;
    let inner = outline.inner.iter().map(|l| polyline_length(&l.points) / h);
    let named = outline.edges.iter().map(|e| e.gauge.divisions(h) as f64);
    let segments: f64 = loops.map(round).chain(inner).chain(named).sum();
    match segments <= MAX_TRIANGLES {
        true => Ok(()),
        false => Err(degenerate(format!(
            "an edge of {} would cut the outline into {:.0} million segments, the limit is 5 million",
            show(h),
            segments / 1e6
        ))
        .hint("look at the outline's picture: it may have a spike, or a bend of no radius")),
    }
}

fn too_long(h: f64, span: Vector2) -> StageError {
    let size = format!("{:.0} by {:.0} mm", span.x * 1e3, span.y * 1e3);
    StageError::invalid(format!("an edge of {} is larger than the panel, which measures {size}", show(h)))
        .hint("use a smaller edge, or check the photo's scale")
        .at("edge")
}

/// A length in its own words.
pub(crate) fn show(metres: f64) -> String {
    Length::m(metres).to_string()
}

/// All loops as one list of points and segments, points that repeat their predecessor left out.
fn segments_of_loops(outline: &Outline) -> (Vec<Point2>, Vec<[u32; 2]>) {
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    for lp in std::iter::once(&outline.outer).chain(&outline.holes) {
        let mut kept = lp.points.clone();
        kept.dedup();
        if kept.len() > 1 && kept.first() == kept.last() {
            kept.pop();
        }
        let (from, n) = (points.len() as u32, kept.len() as u32);
        segments.extend((0..n).map(|k| [from + k, from + (k + 1) % n]));
        points.extend(kept);
    }
    (points, segments)
}

fn check_crossings(outline: &Outline) -> Result<(), StageError> {
    let (points, segments) = segments_of_loops(outline);
    let Some([i, _]) = first_crossing(&points, &segments) else { return Ok(()) };
    let p = points[segments[i][0] as usize];
    Err(degenerate(format!(
        "the outline crosses or touches itself near ({:.1}, {:.1}) mm",
        p.x * 1e3,
        p.y * 1e3
    ))
    .hint("look at the outline's picture; a smoother mask or a larger denoiser radius helps"))
}

fn check_direction(outline: &Outline) -> Result<(), StageError> {
    match polygon_area(&outline.outer.points) > 0.0 {
        true => Ok(()),
        false => Err(StageError::invalid("the outline runs clockwise")
            .hint("outer outlines run counter-clockwise, y up")),
    }
}

fn check_holes(outline: &Outline) -> Result<(), StageError> {
    for (i, hole) in outline.holes.iter().enumerate() {
        if polygon_area(&hole.points) == 0.0 {
            return Err(degenerate(format!("hole {} encloses no area", i + 1)));
        }
        let first = hole.points[0];
        let others = outline.holes.iter().enumerate().filter(|(j, _)| *j != i);
        if !inside(&outline.outer.points, first) || others.into_iter().any(|(_, o)| inside(&o.points, first))
        {
            return Err(StageError::invalid(format!("hole {} lies outside the cloth", i + 1)));
        }
    }
    Ok(())
}

//! Gaps of seams.
//!
//! A seam of a pattern is measured between its sides in space: vertex by vertex where both have as
//! many, which also tells of sides that are shifted along each other; else by the farthest that a
//! vertex of one is from the other side as a polyline. A seam that a file tells as pairs of
//! vertices is measured by those. Limits: seams along lines inside a piece, pleats and bands of one
//! side are not measured; they are listed with the reason.

use crate::laid::ByPiece;
use serde::Serialize;
use toile_core::artifact::{
    EdgeUse, Garment, GarmentSeam, Pattern, PatternSeam, Point3, SeamKind, SeamState,
};

/// Sides of a matched seam whose lengths differ by more than this share are gathered, as the
/// pattern is sewn.
const EASE: f64 = 0.03;

/// A seam that was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeamGap {
    /// Its name.
    pub name: String,
    /// The greatest distance, metres.
    pub gap_m: f64,
    /// Where, metres.
    pub at: [f64; 3],
}

/// What is known of the seams.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gaps {
    /// Those that were measured.
    pub seams: Vec<SeamGap>,
    /// Those that were not, with the reason.
    pub unmeasured: Vec<(String, String)>,
}

/// Gaps of the seams that the garment tells as pairs of vertices.
#[must_use]
pub fn by_pairs(garment: &Garment) -> Gaps {
    let gap = |s: &GarmentSeam| {
        let ends = s.pairs.iter().map(|p| p.map(|v| garment.positions[v as usize]));
        widest(&s.name, ends.map(|[a, b]| ((a - b).norm(), nalgebra::center(&a, &b))))
    };
    Gaps { seams: garment.seams.iter().filter_map(gap).collect(), unmeasured: Vec::new() }
}

/// Gaps of the pattern's seams; `laid` are the panels by their pieces.
#[must_use]
pub fn by_pattern(garment: &Garment, pattern: &Pattern, laid: &ByPiece<'_>) -> Gaps {
    let mut gaps = Gaps::default();
    for s in &pattern.seams {
        match of_seam(garment, pattern, laid, s) {
            Ok(gap) => gaps.seams.extend(gap),
            Err(why) => gaps.unmeasured.push((s.name.clone(), why)),
        }
    }
    gaps
}

/// The seams of the pattern as pairs of vertices, where their sides have as many.
#[must_use]
pub fn pairs(garment: &Garment, pattern: &Pattern, laid: &ByPiece<'_>) -> Vec<GarmentSeam> {
    let length = |side: &[u32]| {
        side.windows(2)
            .map(|w| (garment.rest[w[0] as usize] - garment.rest[w[1] as usize]).norm())
            .sum::<f64>()
    };
    let seam = |s: &PatternSeam| {
        let sides = sides(pattern, laid, s).ok()?;
        let (first, others) = sides.split_first()?;
        let pairs = others.iter().filter(|o| o.len() == first.len());
        let pairs: Vec<[u32; 2]> =
            pairs.flat_map(|o| first.iter().zip(o).map(|(a, b)| [*a, *b])).filter(|p| p[0] != p[1]).collect();
        let unlike = others.iter().any(|o| {
            let (a, b) = (length(first), length(o));
            (a - b).abs() > EASE * a.max(b)
        });
        let kind = if s.kind == SeamKind::Matched && unlike { SeamKind::Gathered } else { s.kind };
        (!pairs.is_empty()).then(|| GarmentSeam {
            name: s.name.clone(),
            kind,
            pairs,
            state: SeamState::Closed,
        })
    };
    pattern.seams.iter().filter_map(seam).collect()
}

/// How far the ends and the middles of the sides are apart, summed over the seams whose panels are
/// all laid, metres; and how many seams those are.
#[must_use]
pub fn ends_apart(garment: &Garment, pattern: &Pattern, laid: &ByPiece<'_>) -> (f64, usize) {
    let of = |s: &PatternSeam| {
        let sides = sides(pattern, laid, s).ok()?;
        let marks =
            |side: &[u32]| [0, side.len() / 2, side.len() - 1].map(|k| garment.positions[side[k] as usize]);
        let first = marks(&sides[0]);
        let apart =
            |other: &Vec<u32>| first.iter().zip(marks(other)).map(|(a, b)| (a - b).norm()).sum::<f64>();
        Some(sides[1..].iter().map(apart).sum::<f64>())
    };
    let all: Vec<f64> = pattern.seams.iter().filter_map(of).collect();
    (all.iter().sum(), all.len())
}

fn of_seam(
    garment: &Garment,
    pattern: &Pattern,
    laid: &ByPiece<'_>,
    seam: &PatternSeam,
) -> Result<Option<SeamGap>, String> {
    match seam.kind {
        SeamKind::Pleat(_) => return Err("the layers of a pleat are folded, not laid edge on edge".into()),
        SeamKind::Elastic { .. } if seam.sides.len() < 2 => return Err("it is a band on one edge".into()),
        SeamKind::Matched
        | SeamKind::Gathered
        | SeamKind::Dart
        | SeamKind::Elastic { .. }
        | SeamKind::Patch
        | SeamKind::Folded { .. } => {}
    }
    let sides = sides(pattern, laid, seam)?;
    let places = |side: &Vec<u32>| side.iter().map(|v| garment.positions[*v as usize]).collect::<Vec<_>>();
    let first = places(&sides[0]);
    let mut far: Vec<(f64, Point3)> = Vec::new();
    for other in sides[1..].iter().map(places) {
        if first.len() == other.len() {
            far.extend(first.iter().zip(&other).map(|(a, b)| ((a - b).norm(), nalgebra::center(a, b))));
        } else {
            far.extend(first.iter().map(|p| (to_polyline(p, &other), *p)));
            far.extend(other.iter().map(|p| (to_polyline(p, &first), *p)));
        }
    }
    Ok(widest(&seam.name, far.into_iter()))
}

/// The sides of a seam as vertices.
fn sides(pattern: &Pattern, laid: &ByPiece<'_>, seam: &PatternSeam) -> Result<Vec<Vec<u32>>, String> {
    seam.sides.iter().map(|side| chain(pattern, laid, side)).collect()
}

fn chain(pattern: &Pattern, laid: &ByPiece<'_>, side: &[EdgeUse]) -> Result<Vec<u32>, String> {
    let mut vertices: Vec<u32> = Vec::new();
    for link in side {
        let (name, edge) = (&link.edge.panel, &link.edge.edge);
        let piece = pattern.pieces.iter().position(|p| p.name == *name);
        let (_, laid) = piece
            .and_then(|k| laid.get(&k))
            .ok_or_else(|| format!("no panel of the garment has the shape of piece \"{name}\""))?;
        let number = piece.and_then(|k| pattern.pieces[k].edge_number(edge));
        let number = number.ok_or_else(|| format!("\"{edge}\" of piece \"{name}\" is a line inside it"))?;
        let mut along = laid.edges[number].clone();
        if link.reversed {
            along.reverse();
        }
        let skip = usize::from(vertices.last().is_some_and(|v| along.first() == Some(v)));
        vertices.extend(&along[skip..]);
    }
    if vertices.is_empty() { Err("it has no edge".into()) } else { Ok(vertices) }
}

fn widest(name: &str, far: impl Iterator<Item = (f64, Point3)>) -> Option<SeamGap> {
    let (gap_m, at) = far.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    Some(SeamGap { name: name.to_owned(), gap_m, at: at.coords.into() })
}

/// Distance of a point to a polyline.
fn to_polyline(p: &Point3, line: &[Point3]) -> f64 {
    let to_segment = |w: &[Point3]| {
        let (way, length) = (w[1] - w[0], (w[1] - w[0]).norm_squared());
        let share = if length > 0.0 { ((p - w[0]).dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
        (p - (w[0] + way * share)).norm()
    };
    let single = line.first().map_or(f64::INFINITY, |q| (p - q).norm());
    line.windows(2).map(to_segment).fold(single, f64::min)
}

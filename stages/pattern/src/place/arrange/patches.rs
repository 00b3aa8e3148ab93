//! Pieces that are sewn onto another: laid on it where their seam says.
//!
//! Method: the flat piece is turned and moved so that its sewn edge lies on the line of the other
//! piece as nearly as a rigid move can bring it (Kabsch 1976, in the plane); each of its points
//! then stands a little outside of the point of the other piece that it covers. Cost: linear in
//! vertices. Limits: a patch on a patch follows the order of the seams.

use super::{PiecePlaces, unknown};
use crate::place::sew::Offsets;
use nalgebra::{Isometry2, Rotation2};
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// How far outside of its piece a patch starts, metres.
const AWAY: f64 = 0.006;
/// A patch may stand out beyond the edge of its piece by this, metres.
const REACH: f64 = 0.5;

/// The names of the pieces that lie on others.
pub(super) fn names(pattern: &Pattern) -> BTreeSet<String> {
    let patches = pattern.seams.iter().filter(|s| s.kind == SeamKind::Patch);
    patches.filter_map(|s| s.sides.first()?.first()).map(|u| u.edge.panel.clone()).collect()
}

/// The pattern without them and their seams.
pub(super) fn without(pattern: &Pattern, patches: &BTreeSet<String>) -> Pattern {
    let stays = |s: &&PatternSeam| !s.sides.iter().flatten().any(|u| patches.contains(&u.edge.panel));
    Pattern {
        name: pattern.name.clone(),
        pieces: pattern.pieces.iter().filter(|p| !patches.contains(&p.name)).cloned().collect(),
        seams: pattern.seams.iter().filter(stays).cloned().collect(),
    }
}

/// Places every patch; a sentence each.
///
/// Errors: patches that lie on each other in a ring.
pub(super) fn lay(
    patches: &BTreeSet<String>,
    places: &mut PiecePlaces,
    seams: &[GarmentSeam],
    offsets: &Offsets,
) -> Result<Vec<String>, StageError> {
    let (mut left, mut told) = (patches.clone(), Vec::new());
    while !left.is_empty() {
        let ready = left.iter().find_map(|name| {
            let (base, pairs) = on(name, seams, offsets)?;
            places.contains_key(base).then(|| (name.clone(), base.to_owned(), pairs))
        });
        let Some((name, base, pairs)) = ready else {
            let name = left.first().cloned().unwrap_or_default();
            return Err(StageError::invalid(format!(
                "nothing tells on which piece the patch \"{name}\" lies"
            ))
            .hint(
                "give its seam the patch's edge for the first side and the line of a piece for the second",
            ));
        };
        let (patch, under) = (offsets.get(name.as_str()), offsets.get(base.as_str()));
        let (Some((_, patch)), Some((_, under))) = (patch, under) else { return Err(unknown(&name)) };
        let laid = laid(patch, under, &places[&base], &pairs);
        places.insert(name.clone(), laid);
        told.push(format!("\"{name}\" lies on \"{base}\", where its seam says"));
        left.remove(&name);
    }
    Ok(told)
}

/// The piece that a patch is sewn onto, and the pairs of their vertices, each in its own panel.
fn on<'a>(name: &str, seams: &[GarmentSeam], offsets: &'a Offsets) -> Option<(&'a str, Vec<[usize; 2]>)> {
    let of = |v: u32| {
        offsets.iter().find_map(|(n, (first, p))| {
            (v as usize).checked_sub(*first).filter(|k| *k < p.positions.len()).map(|k| (*n, k))
        })
    };
    let mut found: Option<(&str, Vec<[usize; 2]>)> = None;
    for [a, b] in seams.iter().filter(|s| s.kind == SeamKind::Patch).flat_map(|s| &s.pairs) {
        let (Some((patch, i)), Some((base, j))) = (of(*a), of(*b)) else { continue };
        if patch != name || base == name {
            continue;
        }
        let (at, pairs) = found.get_or_insert((base, Vec::new()));
        if *at == base {
            pairs.push([i, j]);
        }
    }
    found
}

/// Where the vertices of a patch stand.
fn laid(patch: &Panel, under: &Panel, base: &[Point3], pairs: &[[usize; 2]]) -> Vec<Point3> {
    let from: Vec<Point2> = pairs.iter().map(|p| patch.positions[p[0]]).collect();
    let to: Vec<Point2> = pairs.iter().map(|p| under.positions[p[1]]).collect();
    let by = fitted(&from, &to);
    let corners = under.triangles.iter().map(|t| t.map(|v| under.positions[v as usize])).collect();
    let locator = Locator::new(corners, REACH);
    let outside = outsides(under, base);
    let place = |p: &Point2| {
        let found = locator.as_ref().and_then(|l| l.find(by * p));
        let Some(found) = found else { return base.first().copied().unwrap_or_else(Point3::origin) };
        let t = under.triangles[found.triangle].map(|v| v as usize);
        let up: Vector3 = (0..3).map(|k| outside[t[k]] * found.weights[k].max(0.0)).sum();
        found.in_space(t.map(|v| base[v])) + up.try_normalize(0.0).unwrap_or_else(Vector3::zeros) * AWAY
    };
    patch.positions.iter().map(place).collect()
}

/// The rigid move of the plane that brings points nearest to others, pair by pair.
fn fitted(from: &[Point2], to: &[Point2]) -> Isometry2<f64> {
    let middle = |all: &[Point2]| all.iter().map(|p| p.coords).sum::<Vector2>() / all.len().max(1) as f64;
    let (a, b) = (middle(from), middle(to));
    let (mut cos, mut sin) = (0.0, 0.0);
    for (p, q) in from.iter().zip(to) {
        let (p, q) = (p.coords - a, q.coords - b);
        cos += p.dot(&q);
        sin += p.perp(&q);
    }
    let turn = Rotation2::new(sin.atan2(cos));
    Isometry2::new(b - turn * a, turn.angle())
}

/// The direction outwards at each vertex of a placed panel; what is turned over by a fold looks
/// inwards.
pub(super) fn outsides(panel: &Panel, places: &[Point3]) -> Vec<Vector3> {
    let mut outside = vec![Vector3::zeros(); places.len()];
    for t in &panel.triangles {
        let [a, b, c] = t.map(|v| places[v as usize]);
        let up = (b - a).cross(&(c - a)) * panel.triangle_area(*t).signum();
        t.iter().for_each(|v| outside[*v as usize] += up);
    }
    outside.iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::zeros)).collect()
}

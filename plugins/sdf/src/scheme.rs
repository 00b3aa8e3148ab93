//! The collision service: the body's field, cloth against itself, and the settings.
//!
//! A path enters the body where the field along it turns from positive to negative. It is followed
//! in steps of the distance itself, at least [`STEP`] of a cell (sphere tracing, Hart 1996), and
//! the place is found by halving.

use crate::cloth::ClothCells;
use crate::field::DistanceField;
use rayon::prelude::*;
use toile_core::artifact::{BodyContact, Collide, ColliderCard, Point3, SelfContact};

/// The shortest step along a path, in cells: what dips into the body for less is not seen.
const STEP: f64 = 0.25;
/// The share of the distance that a step may take: interpolation is off by less than the rest.
const SAFE: f64 = 0.8;
/// A path is no longer followed after so many steps; longer ones take longer steps.
const MAX_STEPS: f64 = 4096.0;
/// Halvings of the step in which a path enters.
const HALVINGS: usize = 24;
/// Vertices that one parallel task takes at least.
const CHUNK: usize = 256;

/// Collisions by a signed-distance grid.
#[derive(Debug)]
pub struct SdfScheme {
    card: ColliderCard,
    field: Option<DistanceField>,
}

impl SdfScheme {
    /// The scheme for a body's field, or for cloth alone.
    pub fn new(card: ColliderCard, field: Option<DistanceField>) -> Self {
        SdfScheme { card, field }
    }

    /// The body's field.
    pub fn field(&self) -> Option<&DistanceField> {
        self.field.as_ref()
    }
}

/// The share of the path at which it first enters the body.
fn entry(field: &DistanceField, from: &Point3, to: &Point3) -> Option<f64> {
    let way = to - from;
    let length = way.norm();
    // A path that is no finite number is none.
    if !(length.is_finite() && length > 0.0 && from.iter().all(|x| x.is_finite())) {
        return None;
    }
    let least = (STEP * field.cell()).max(length / MAX_STEPS);
    let at = |s: f64| field.distance(&(from + way * (s / length)));
    let (mut s, mut d) = (0.0, at(0.0));
    while s < length {
        let next = (s + (SAFE * d.abs()).max(least)).min(length);
        let there = at(next);
        if d >= 0.0 && there < 0.0 {
            return Some(halve(at, s, next) / length);
        }
        (s, d) = (next, there);
    }
    None
}

fn halve(at: impl Fn(f64) -> f64, mut outside: f64, mut inside: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (outside + inside);
        if at(middle) < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    outside
}

impl Collide for SdfScheme {
    fn card(&self) -> ColliderCard {
        self.card
    }

    fn body_contacts(&self, positions: &[Point3], reach: f64, out: &mut Vec<BodyContact>) {
        let Some(field) = &self.field else { return };
        let contact = |(i, p): (usize, &Point3)| {
            let r = field.at(p).filter(|r| r.distance <= reach)?;
            let point = p - r.normal * r.distance;
            Some(BodyContact { vertex: i as u32, point, normal: r.normal, distance: r.distance })
        };
        let found = positions.par_iter().enumerate().with_min_len(CHUNK).map(contact);
        out.extend(found.flatten_iter().collect::<Vec<_>>());
    }

    fn body_hits(&self, from: &[Point3], to: &[Point3], out: &mut Vec<BodyContact>) {
        let Some(field) = &self.field else { return };
        let hit = |(i, (p, q)): (usize, (&Point3, &Point3))| {
            let s = entry(field, p, q)?;
            let point = p + (q - p) * s;
            let normal = field.at(&point)?.normal;
            Some(BodyContact { vertex: i as u32, point, normal, distance: field.distance(q) })
        };
        let found = from.par_iter().zip(to).enumerate().with_min_len(CHUNK).map(hit);
        out.extend(found.flatten_iter().collect::<Vec<_>>());
    }

    fn self_contacts(
        &self,
        positions: &[Point3],
        triangles: &[[u32; 3]],
        reach: f64,
        out: &mut Vec<SelfContact>,
    ) {
        ClothCells::new(positions, triangles, reach).contacts(out);
    }

    fn conservative_bounds(&self, positions: &[Point3], triangles: &[[u32; 3]], reach: f64) -> Vec<f64> {
        ClothCells::new(positions, triangles, reach).bounds()
    }

    fn self_crossings(&self, positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        ClothCells::new(positions, triangles, 0.0).crossings()
    }
}

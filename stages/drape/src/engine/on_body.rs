//! How much of a garment is still in its place on the body, whatever holds up the part that slid
//! off.
//!
//! Method: for each connected piece of cloth that starts upright, the mean downward displacement
//! of its vertices, less the way from its upper edge down to the body under it: a skirt that slid
//! on one side only has sunk by half, a hood that falls onto the back hardly. Of cloth that starts
//! lying, the height of its upper edge at the start, but no higher than the body under it, minus
//! its height at the end. The distance sunk over the piece's size (the root of its flat area) is
//! the share that has left its place. So cloth that starts above a ball and ends on it has sunk by
//! 0, a skirt that slides 5 cm onto the hips by some hundredths, a skirt that ends around the feet
//! by 1. Cost: some hundred distances a piece. Limit: a body thinner than a ninth of the piece is
//! not seen under it; then its start alone counts.

use super::SchemeSurface;
use super::pieces::pieces;
use nalgebra::Vector3;
use toile_cloth::contact::collision_surface::CollisionSurface;
use toile_cloth::contact::past::BodyBox;
use toile_core::artifact::{Collide, Garment, Point3};

/// Points on a side of the raster in which the body under a piece is looked for.
const RASTER: usize = 9;

/// Pieces from which on only the box of the body is looked at: a garment has few, and each costs a
/// raster.
const MANY: usize = 64;

/// Nearer than this to the body, a way down has met it, metres; and the least step down.
const MET: f64 = 1e-3;

/// Steps down at most.
const STEPS: usize = 400;

/// What is taller than this at its start, as a share of the piece's size, stands upright; a sheet
/// that lies above a ball does not.
const UPRIGHT: f64 = 0.3;

/// For each panel the share of it that is still in its place, of its piece that has sunk farthest;
/// 1 for what pins hold. `garment` stands where it starts, `end` is where its vertices have come
/// to. Empty without a body or weight.
pub fn on_body(garment: &Garment, end: &[Point3], scheme: &dyn Collide, gravity: &Vector3<f64>) -> Vec<f64> {
    let skin = SchemeSurface::new(scheme);
    let Some(body) = BodyBox::of(&skin, gravity) else { return Vec::new() };
    let up = -gravity.normalize();
    let pieces = pieces(garment);
    let is_few = pieces.len() <= MANY;
    let mut shares = vec![1.0; garment.positions.len()];
    for piece in pieces.iter().filter(|p| !p.is_held) {
        let top = |x: &[Point3]| {
            piece.vertices.iter().map(|&v| x[v].coords.dot(&up)).fold(f64::NEG_INFINITY, f64::max)
        };
        let start: Vec<Vector3<f64>> = piece.vertices.iter().map(|&v| garment.positions[v].coords).collect();
        let under =
            if is_few { body.highest_under(&start, RASTER, |p| down(&skin, p, &up, &body)) } else { None };
        let size = piece.area.sqrt();
        let highest = top(&garment.positions);
        let from = highest.min(under.unwrap_or(f64::INFINITY));
        let lowest = start.iter().map(|p| p.dot(&up)).fold(f64::INFINITY, f64::min);
        let sunk = if highest - lowest > UPRIGHT * size {
            let down = piece.vertices.iter().map(|&v| (garment.positions[v] - end[v]).dot(&up));
            down.sum::<f64>() / piece.vertices.len() as f64 - (highest - from)
        } else {
            from - top(end)
        };
        let share = (1.0 - sunk.max(0.0) / size).clamp(0.0, 1.0);
        piece.vertices.iter().for_each(|&v| shares[v] = share);
    }
    let panel = |own: &std::ops::Range<usize>| shares[own.clone()].iter().copied().fold(1.0, f64::min);
    garment.panels.iter().map(|p| panel(&p.vertices)).collect()
}

/// Shares after one solver and the next.
pub fn both(before: &[f64], after: Vec<f64>) -> Vec<f64> {
    match before.len() == after.len() {
        true => before.iter().zip(after).map(|(a, b)| a * b).collect(),
        false => after,
    }
}

/// The height at which a way straight down from `p` meets the body.
fn down(skin: &SchemeSurface<'_>, p: &Vector3<f64>, up: &Vector3<f64>, body: &BodyBox) -> Option<f64> {
    let mut at = *p;
    for _ in 0..STEPS {
        let distance = skin.nearest(&[at], &[f64::INFINITY])[0]?.distance;
        if distance < MET {
            return Some(at.dot(up));
        }
        at -= up * distance.max(MET);
        if at.dot(up) < body.lowest() {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests;

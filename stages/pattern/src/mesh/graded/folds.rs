//! Where a draped garment asks for short edges: where it is bent.
//!
//! Method: the shape operator of each triangle from the angles to its neighbours (Grinspun et al.
//! 2006), in the panel's own flat coordinates; neighbours across a closed seam count as well. An
//! edge of length h leaves a surface of curvature k by h^2 k / 8 (Narain, Samii, O'Brien 2012, with
//! the flat pattern as the metric), so h = sqrt(8 tolerance / k). Cost: linear in the garment's
//! triangles. Limits: what the drape's own mesh is too coarse to show is not seen.

use super::field::SizeField;
use nalgebra::Matrix2;
use toile_core::artifact::{Garment, GarmentPanel, Point2, Vector2, Vector3};

/// A side of a triangle: its ends' welded vertices in order, the triangle and the corner across.
type FoldSide = ((u32, u32), usize, usize);

/// The greatest curvature of every triangle of a garment, 1/m.
pub(crate) fn curvatures(garment: &Garment) -> Vec<f64> {
    let mut bend: Vec<Matrix2<f64>> = vec![Matrix2::zeros(); garment.triangles.len()];
    let mut sides = sides(garment);
    sides.sort_unstable();
    for pair in sides.chunk_by(|s, t| s.0 == t.0) {
        if let [one, two] = pair {
            let angle = turn(garment, one.1, two.1, one.0);
            add(&mut bend, garment, one, angle);
            add(&mut bend, garment, two, angle);
        }
    }
    bend.iter().map(greatest).collect()
}

/// The greater eigenvalue of a symmetric matrix, without its sign.
fn greatest(m: &Matrix2<f64>) -> f64 {
    let (mean, half) = ((m.m11 + m.m22) / 2.0, (m.m11 - m.m22) / 2.0);
    mean.abs() + half.hypot(m.m12)
}

fn sides(garment: &Garment) -> Vec<FoldSide> {
    let welded = |v: u32| garment.weld[v as usize];
    let side = |t: usize, k: usize| {
        let corners = garment.triangles[t];
        let (a, b) = (welded(corners[(k + 1) % 3]), welded(corners[(k + 2) % 3]));
        ((a.min(b), a.max(b)), t, k)
    };
    (0..garment.triangles.len()).flat_map(|t| (0..3).map(move |k| side(t, k))).collect()
}

/// The angle between two triangles that share a side, radians; positive where the garment is bent
/// outwards.
fn turn(garment: &Garment, s: usize, t: usize, (a, b): (u32, u32)) -> f64 {
    let (m, n) = (normal(garment, s), normal(garment, t));
    let along = garment.positions[b as usize] - garment.positions[a as usize];
    let angle = m.cross(&n).norm().atan2(m.dot(&n));
    let to = centre(garment, t) - centre(garment, s);
    if along.norm() > 0.0 { -angle * to.dot(&m).signum() } else { 0.0 }
}

fn normal(garment: &Garment, t: usize) -> Vector3 {
    let [a, b, c] = garment.triangles[t].map(|v| garment.positions[v as usize]);
    (b - a).cross(&(c - a))
}

fn centre(garment: &Garment, t: usize) -> Vector3 {
    garment.triangles[t].map(|v| garment.positions[v as usize].coords).iter().sum::<Vector3>() / 3.0
}

/// Adds what a bent side contributes to its triangle: angle times length over twice the area,
/// across the side.
fn add(bend: &mut [Matrix2<f64>], garment: &Garment, side: &FoldSide, angle: f64) {
    let (t, k) = (side.1, side.2);
    let [a, b, c] = garment.triangles[t].map(|v| garment.rest[v as usize]);
    let twice = (b - a).perp(&(c - a)).abs();
    let corners = [a, b, c];
    let along = corners[(k + 2) % 3] - corners[(k + 1) % 3];
    let Some(way) = along.try_normalize(0.0) else { return };
    let across = Vector2::new(way.y, -way.x);
    if twice > 0.0 {
        bend[t] += across * across.transpose() * (angle * along.norm() / twice);
    }
}

/// Lowers a panel's field where the drape of that panel is bent so that edges would leave it by
/// more than `tolerance` (metres).
pub(crate) fn lower_at_folds(
    field: &mut SizeField,
    garment: &Garment,
    panel: &GarmentPanel,
    curvatures: &[f64],
    tolerance: f64,
) {
    for t in panel.triangles.clone() {
        let size = (8.0 * tolerance / curvatures[t].max(f64::MIN_POSITIVE)).sqrt();
        if size >= field.range().edge {
            continue;
        }
        let corners = garment.triangles[t].map(|v| garment.rest[v as usize]);
        spots(corners).into_iter().for_each(|p| field.lower(p, size));
    }
}

/// The corners of a triangle, the middles of its sides and its centre.
fn spots([a, b, c]: [Point2; 3]) -> [Point2; 7] {
    let middle = |p: &Point2, q: &Point2| nalgebra::center(p, q);
    let centre = Point2::from((a.coords + b.coords + c.coords) / 3.0);
    [a, b, c, middle(&a, &b), middle(&b, &c), middle(&c, &a), centre]
}

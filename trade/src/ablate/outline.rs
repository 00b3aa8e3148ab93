//! How far the outlines of two garments' flat panels are from each other.
//!
//! From the vertices and the middles of the segments of either boundary to the nearest point of the
//! other's, both ways, panel by panel. Cost: vertices squared, a few milliseconds.

use crate::surface::Spread;
use toile_core::artifact::{Garment, GarmentPanel, Point2};

/// Distances between the boundaries of panels of the same name.
pub(super) fn distance(a: &Garment, b: &Garment) -> Spread {
    let mut all = Vec::new();
    for p in &a.panels {
        if let Some(q) = b.panels.iter().find(|q| q.name == p.name) {
            let (p, q) = (boundary(a, p), boundary(b, q));
            all.extend(one_way(&p, &q));
            all.extend(one_way(&q, &p));
        }
    }
    Spread::of(all)
}

fn boundary(garment: &Garment, panel: &GarmentPanel) -> Vec<Point2> {
    panel.boundary.iter().map(|&i| garment.rest[i as usize]).collect()
}

/// The sides of a closed polygon.
fn sides(polygon: &[Point2]) -> impl Iterator<Item = [Point2; 2]> + '_ {
    (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
}

fn one_way(from: &[Point2], to: &[Point2]) -> Vec<f64> {
    let points = sides(from).flat_map(|[a, b]| [a, Point2::from((a.coords + b.coords) * 0.5)]);
    let nearest = |p: Point2| sides(to).map(|s| to_side(p, s)).fold(f64::INFINITY, f64::min);
    points.map(nearest).filter(|d| d.is_finite()).collect()
}

fn to_side(p: Point2, [a, b]: [Point2; 2]) -> f64 {
    let side = b - a;
    let share = ((p - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
    if share.is_nan() { (p - a).norm() } else { (a + side * share - p).norm() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64) -> Vec<Point2> {
        [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(Point2::from).to_vec()
    }

    #[test]
    fn a_square_that_has_grown_is_as_far_as_it_has_grown() {
        let far = |a: &[Point2], b: &[Point2]| one_way(a, b).into_iter().fold(0.0, f64::max);
        assert_eq!(far(&square(1.0), &square(1.0)), 0.0);
        assert!((far(&square(1.0), &square(1.25)) - 0.25).abs() < 1e-12);
        assert!((far(&square(1.25), &square(1.0)) - 0.25 * 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(far(&square(1.0), &[]), 0.0, "nothing to be far from");
        assert_eq!(to_side(Point2::new(3.0, 4.0), [Point2::origin(); 2]), 5.0);
    }
}

//! Where the inside of a panel lies in its photo, when its outline was straightened.
//!
//! Method: mean value coordinates (Floater 2003; Hormann and Floater 2006): smooth, exact on the
//! outline, and exact for rigid motions and scalings of it. Cost: one pass over the outline a
//! point. Limits: where the outline as it lies is far from what it was straightened to, the map may
//! fold over.

use crate::artifact::{Outline, Point2, Vector2};

/// Of the product of two distances: below it a point lies on the segment between them.
const ON: f64 = 1e-9;

impl Outline {
    /// The place of a point of the panel in the coordinates of `frame`: by `lies`, or where it is.
    pub fn lying(&self, p: Point2) -> Point2 {
        if self.lies.len() == self.outer.points.len() && self.lies.len() > 2 {
            mean_value(&self.outer.points, &self.lies, p)
        } else {
            p
        }
    }

    /// The pixel under a point of the panel; none without a photo.
    pub fn to_px(&self, p: Point2) -> Option<Point2> {
        self.frame.map(|frame| frame.to_px(self.lying(p)))
    }
}

/// The image of `p` where the vertices of a polygon go to `to`.
fn mean_value(polygon: &[Point2], to: &[Point2], p: Point2) -> Point2 {
    let n = polygon.len();
    let way: Vec<Vector2> = polygon.iter().map(|q| q - p).collect();
    let far: Vec<f64> = way.iter().map(Vector2::norm).collect();
    let mut halves = Vec::with_capacity(n);
    for i in 0..n {
        let k = (i + 1) % n;
        let product = far[i] * far[k];
        let under = product + way[i].dot(&way[k]);
        if under <= ON * product || far[i] == 0.0 {
            let sum = far[i] + far[k];
            let share = if sum > 0.0 { far[i] / sum } else { 0.0 };
            return to[i] + (to[k] - to[i]) * share;
        }
        // The tangent of half the angle under which the segment is seen.
        halves.push(way[i].perp(&way[k]) / under);
    }
    let (mut sum, mut total) = (Vector2::zeros(), 0.0);
    for i in 0..n {
        let weight = (halves[(i + n - 1) % n] + halves[i]) / far[i];
        sum += to[i].coords * weight;
        total += weight;
    }
    if total.abs() > 0.0 { Point2::from(sum / total) } else { p }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testkit::shapes;
    use nalgebra::{Rotation2, Similarity2};
    use proptest::prelude::*;

    fn vest() -> Outline {
        shapes::vest(0.1)
    }

    #[test]
    fn without_lies_a_point_is_where_it_is() {
        let p = Point2::new(0.01, 0.2);
        assert_eq!(vest().lying(p), p);
        assert_eq!(vest().to_px(p), None);
    }

    #[test]
    fn a_point_of_the_outline_goes_where_it_lies() {
        let vest = vest();
        let lies: Vec<Point2> =
            vest.outer.points.iter().map(|p| Point2::new(p.x + 0.1 * p.y * p.y, p.y)).collect();
        let leant = Outline { lies: lies.clone(), ..vest.clone() };
        for (p, q) in vest.outer.points.iter().zip(&lies) {
            assert!((leant.lying(*p) - q).norm() < 1e-12);
        }
        let (a, b) = (vest.outer.points[3], vest.outer.points[4]);
        let middle = leant.lying(nalgebra::center(&a, &b));
        assert!((middle - nalgebra::center(&lies[3], &lies[4])).norm() < 1e-9);
    }

    proptest! {
        #[test]
        fn turned_and_scaled_outlines_take_their_inside_along(
            angle in -3.0..3.0f64, scale in 0.5..2.0f64, x in -1.0..1.0f64, u in -0.2..0.2f64, v in 0.0..0.6f64,
        ) {
            let vest = vest();
            let motion = Similarity2::from_parts(Vector2::new(x, -x).into(), Rotation2::new(angle).into(), scale);
            let lies = vest.outer.points.iter().map(|p| motion * p).collect();
            let p = Point2::new(u, v);
            let at = Outline { lies, ..vest }.lying(p);
            prop_assert!((at - motion * p).norm() < 1e-8, "{at} for {}", motion * p);
        }
    }
}

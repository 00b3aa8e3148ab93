//! Angles of triangles, and a quick look whether any is too small.
//!
//! Method: an angle t is below a bound b where sin(t - b) is negative, which takes products only.
//! Where their sign is certain in spite of rounding, it decides; elsewhere the angles are computed,
//! so that the result is always that of the angles.

use toile_core::artifact::Point2;

/// Far more than the products of a sine may be off by rounding, as a share of them.
const ROUNDING: f64 = 1e-12;

/// Squared sides nearer to each other than this factor count as alike.
const ALIKE: f64 = 1.000_001;

/// The angles of the triangle abc at its corners, radians; negative where it is turned over.
pub(crate) fn angles(a: Point2, b: Point2, c: Point2) -> [f64; 3] {
    [0, 1, 2].map(|k| angle_at([a, b, c], k))
}

fn angle_at(t: [Point2; 3], k: usize) -> f64 {
    let (u, v) = (t[(k + 1) % 3] - t[k], t[(k + 2) % 3] - t[k]);
    u.perp(&v).atan2(u.dot(&v))
}

/// The least angle of the triangle abc, radians; negative where it is turned over.
pub(crate) fn least_angle(a: Point2, b: Point2, c: Point2) -> f64 {
    match shortest_side([a, b, c]) {
        Some(k) => angle_at([a, b, c], k),
        None => angles(a, b, c).into_iter().fold(f64::INFINITY, f64::min),
    }
}

/// The corner across from the shortest side of a counter-clockwise triangle: the least angle is
/// there. `None` where the triangle is turned over, or two sides are so alike that rounding could
/// decide.
fn shortest_side(t: [Point2; 3]) -> Option<usize> {
    let side = |k: usize| (t[(k + 2) % 3] - t[(k + 1) % 3]).norm_squared();
    let sides = [side(0), side(1), side(2)];
    let k = (0..3).find(|&k| (1..3).all(|j| sides[k] * ALIKE < sides[(k + j) % 3]))?;
    ((t[1] - t[0]).perp(&(t[2] - t[0])) > 0.0).then_some(k)
}

/// The least angle of all triangles, where it is above `bound` (radians).
pub(crate) fn least_angle_above(
    triangles: impl Iterator<Item = [Point2; 3]> + Clone,
    bound: f64,
) -> Option<f64> {
    let within = (0.0..std::f64::consts::PI).contains(&bound);
    let (sin, cos) = bound.sin_cos();
    if within && triangles.clone().any(|t| surely_below(sin, cos, t)) {
        return None;
    }
    let least = triangles.map(|[a, b, c]| least_angle(a, b, c)).fold(f64::INFINITY, f64::min);
    (least > bound).then_some(least)
}

/// True where the triangle surely has an angle below the bound (0 to pi) of this sine and cosine;
/// false where it has none, or one so near to the bound that rounding could decide.
fn surely_below(sin: f64, cos: f64, [a, b, c]: [Point2; 3]) -> bool {
    let below = |p: Point2, q: Point2, r: Point2| {
        let (u, v) = (q - p, r - p);
        let (rise, run) = (u.perp(&v) * cos, u.dot(&v) * sin);
        rise - run < -ROUNDING * (rise.abs() + run.abs())
    };
    below(a, b, c) || below(b, c, a) || below(c, a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point2> {
        (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| Point2::new(x, y))
    }

    proptest! {
        #[test]
        fn a_quick_look_says_what_angles_say(
            star in prop::collection::vec([point(), point(), point()], 1..6), bound in -0.5..3.5_f64, near in 0..4_u8,
        ) {
            let least = star.iter().map(|&[a, b, c]| least_angle(a, b, c)).fold(f64::INFINITY, f64::min);
            // Half of the bounds lie where rounding decides.
            let bound = match near { 0 => least, 1 => least.next_down(), _ => bound };
            prop_assert_eq!(least_angle_above(star.iter().copied(), bound), (least > bound).then_some(least));
        }
    }

    proptest! {
        #[test]
        fn the_least_angle_is_the_least_of_all_three(a in point(), b in point(), c in point(), flat in 0.0..1e-3_f64) {
            let least = |a, b, c| angles(a, b, c).into_iter().fold(f64::INFINITY, f64::min);
            prop_assert_eq!(least_angle(a, b, c), least(a, b, c));
            let d = a + (b - a) * 0.4 + (c - a) * flat;
            prop_assert_eq!(least_angle(a, b, d), least(a, b, d));
        }
    }

    #[test]
    fn a_triangle_turned_over_has_a_negative_angle() {
        let [a, b, c] = [Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(0.0, 1.0)];
        assert_eq!(least_angle_above([[a, c, b]].into_iter(), 0.1), None);
        assert!((least_angle(a, b, c).to_degrees() - 45.0).abs() < 1e-12);
    }
}

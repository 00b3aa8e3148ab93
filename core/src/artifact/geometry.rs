//! The geometric words every artifact uses.

/// A point of the flat pattern, metres.
pub type Point2 = nalgebra::Point2<f64>;
/// A vector of the flat pattern, metres.
pub type Vector2 = nalgebra::Vector2<f64>;
/// A point in space, metres, Y up.
pub type Point3 = nalgebra::Point3<f64>;
/// A vector in space.
pub type Vector3 = nalgebra::Vector3<f64>;

/// Signed area of a closed polygon (shoelace): positive when counter-clockwise.
pub fn polygon_area(points: &[Point2]) -> f64 {
    let n = points.len();
    let twice: f64 = (0..n)
        .map(|i| {
            let (a, b) = (points[i], points[(i + 1) % n]);
            a.x * b.y - b.x * a.y
        })
        .sum();
    twice / 2.0
}

/// Length of an open polyline.
pub fn polyline_length(points: &[Point2]) -> f64 {
    points.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

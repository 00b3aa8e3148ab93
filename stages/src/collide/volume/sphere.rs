//! The sphere.

use super::{BoundingVolume, PAD};
use toile_core::artifact::Point3;

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Its middle.
    pub center: Point3,
    /// Its radius.
    pub radius: f64,
}

impl Sphere {
    fn padded(center: Point3, radius: f64) -> Self {
        Sphere { center, radius: radius + PAD * (radius + center.coords.amax()) }
    }

    /// The ball grown just enough to hold a point.
    fn with(&self, p: &Point3) -> Self {
        let d = (p - self.center).norm();
        if d <= self.radius {
            return *self;
        }
        let radius = (self.radius + d) / 2.0;
        Sphere { center: self.center + (p - self.center) * ((radius - self.radius) / d), radius }
    }
}

/// The point farthest from `from`; the first of equals.
fn farthest<'a>(points: &'a [Point3], from: &Point3) -> &'a Point3 {
    let better = |a: &'a Point3, b: &'a Point3| match (b - from).norm_squared() > (a - from).norm_squared() {
        true => b,
        false => a,
    };
    points.iter().fold(&points[0], better)
}

impl BoundingVolume for Sphere {
    // Ritter 1990: the ball between two far points, grown to the rest; within some 10 % of the best.
    fn fit(points: &[Point3]) -> Self {
        let a = farthest(points, &points[0]);
        let b = farthest(points, a);
        let start = Sphere { center: nalgebra::center(a, b), radius: (b - a).norm() / 2.0 };
        let ball = points.iter().fold(start, |s, p| s.with(p));
        let radius = points.iter().map(|p| (p - ball.center).norm()).fold(0.0, f64::max);
        Sphere::padded(ball.center, radius)
    }

    fn merge(&self, other: &Self) -> Self {
        let between = other.center - self.center;
        let d = between.norm();
        if d + other.radius <= self.radius {
            return *self;
        }
        if d + self.radius <= other.radius {
            return *other;
        }
        let radius = (d + self.radius + other.radius) / 2.0;
        Sphere::padded(self.center + between * ((radius - self.radius) / d), radius)
    }

    fn near(&self, other: &Self, reach: f64) -> bool {
        let r = self.radius + other.radius + reach;
        (other.center - self.center).norm_squared() <= r * r * (1.0 + PAD)
    }

    fn distance_squared(&self, p: &Point3) -> f64 {
        let d = ((p - self.center).norm() - self.radius).max(0.0);
        d * d
    }

    fn size(&self) -> f64 {
        self.radius
    }
}

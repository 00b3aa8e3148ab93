//! The sphere.

use super::{BoundingVolume, PAD};
use crate::Vec3;

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingSphere {
    /// Its middle.
    pub center: Vec3,
    /// Its radius.
    pub radius: f64,
}

impl BoundingSphere {
    fn padded(center: Vec3, radius: f64) -> Self {
        BoundingSphere { center, radius: radius + PAD * (radius + center.amax()) }
    }

    /// The ball grown just enough to hold a point.
    fn with(&self, p: &Vec3) -> Self {
        let d = (p - self.center).norm();
        if d <= self.radius {
            return *self;
        }
        let radius = (self.radius + d) / 2.0;
        BoundingSphere { center: self.center + (p - self.center) * ((radius - self.radius) / d), radius }
    }
}

/// The point farthest from `from`; the first of equals.
fn farthest<'a>(points: &'a [Vec3], from: &Vec3) -> &'a Vec3 {
    let better = |a: &'a Vec3, b: &'a Vec3| match (b - from).norm_squared() > (a - from).norm_squared() {
        true => b,
        false => a,
    };
    points.iter().fold(&points[0], better)
}

impl BoundingVolume for BoundingSphere {
    // Ritter 1990: the ball between two far points, grown to the rest; within some 10 % of the
    // best.
    fn fit(points: &[Vec3]) -> Self {
        let a = farthest(points, &points[0]);
        let b = farthest(points, a);
        let start = BoundingSphere { center: ((a + b) / 2.0), radius: (b - a).norm() / 2.0 };
        let ball = points.iter().fold(start, |s, p| s.with(p));
        let radius = points.iter().map(|p| (p - ball.center).norm()).fold(0.0, f64::max);
        BoundingSphere::padded(ball.center, radius)
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
        BoundingSphere::padded(self.center + between * ((radius - self.radius) / d), radius)
    }

    fn near(&self, other: &Self, reach: f64) -> bool {
        let r = self.radius + other.radius + reach;
        (other.center - self.center).norm_squared() <= r * r * (1.0 + PAD)
    }

    fn distance_squared(&self, p: &Vec3) -> f64 {
        let d = ((p - self.center).norm() - self.radius).max(0.0);
        d * d
    }

    fn size(&self) -> f64 {
        self.radius
    }
}

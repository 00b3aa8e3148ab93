//! Rigid obstacles with a closed form, as a filter on vertex velocities.
//!
//! The normal part of a velocity may at most close the gap in one step; what it must lose for that,
//! times the friction coefficient, is what the tangential part may lose at most: Coulomb's law for
//! one vertex in one step, exactly. A vertex whose tangential velocity is used up stands still,
//! without creep.

use crate::error::{ClothError, check_parameter};
use toile_geometry::Vec3;

/// A body given by its distance.
pub trait Obstacle: Send + Sync {
    /// Signed distance of a point and the outward direction there.
    fn distance(&self, x: &Vec3) -> (f64, Vec3);

    /// Coulomb's coefficient.
    fn friction(&self) -> f64;

    /// The velocity that a vertex at `x` keeps in a step of `dt` if it would move with `v`.
    fn stop(&self, x: &Vec3, v: &Vec3, dt: f64) -> Vec3 {
        let (gap, normal) = self.distance(x);
        let approach = v.dot(&normal);
        let allowed = -gap / dt;
        if approach >= allowed {
            return *v;
        }
        let tangential = v - normal * approach;
        let (speed, loss) = (tangential.norm(), self.friction() * (allowed - approach));
        let kept = if speed > loss { tangential * (1.0 - loss / speed) } else { Vec3::zeros() };
        kept + normal * allowed
    }
}

/// The half-space below a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    point: Vec3,
    normal: Vec3,
    friction: f64,
}

impl Plane {
    /// Through `point`, free side along `normal`.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative friction or a normal without length.
    pub fn new(point: Vec3, normal: Vec3, friction: f64) -> Result<Self, ClothError> {
        check_friction(friction)?;
        check_parameter("normal length", normal.norm(), |n| n > 0.0, "above 0")?;
        Ok(Self { point, normal: normal.normalize(), friction })
    }
}

impl Obstacle for Plane {
    fn distance(&self, x: &Vec3) -> (f64, Vec3) {
        ((x - self.point).dot(&self.normal), self.normal)
    }

    fn friction(&self) -> f64 {
        self.friction
    }
}

/// An endless cylinder along z through `centre`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CylinderObstacle {
    centre: Vec3,
    radius: f64,
    friction: f64,
}

impl CylinderObstacle {
    /// Along z.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative friction or a radius of 0 or less.
    pub fn new(centre: Vec3, radius: f64, friction: f64) -> Result<Self, ClothError> {
        check_friction(friction)?;
        check_parameter("radius", radius, |r| r > 0.0, "above 0 m")?;
        Ok(Self { centre, radius, friction })
    }
}

impl Obstacle for CylinderObstacle {
    fn distance(&self, x: &Vec3) -> (f64, Vec3) {
        let mut d = x - self.centre;
        d.z = 0.0;
        from_centre(d, self.radius)
    }

    fn friction(&self) -> f64 {
        self.friction
    }
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    centre: Vec3,
    radius: f64,
    friction: f64,
}

impl Sphere {
    /// Around `centre`.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative friction or a radius of 0 or less.
    pub fn new(centre: Vec3, radius: f64, friction: f64) -> Result<Self, ClothError> {
        check_friction(friction)?;
        check_parameter("radius", radius, |r| r > 0.0, "above 0 m")?;
        Ok(Self { centre, radius, friction })
    }
}

impl Obstacle for Sphere {
    fn distance(&self, x: &Vec3) -> (f64, Vec3) {
        from_centre(x - self.centre, self.radius)
    }

    fn friction(&self) -> f64 {
        self.friction
    }
}

fn check_friction(friction: f64) -> Result<(), ClothError> {
    check_parameter("friction", friction, |f| f >= 0.0, "0 or more")
}

/// The very centre is pushed up, so that no direction is 0/0.
fn from_centre(d: Vec3, radius: f64) -> (f64, Vec3) {
    let length = d.norm();
    (length - radius, if length > 0.0 { d / length } else { Vec3::y() })
}

//! What holds cloth besides its own forces: obstacles with a closed form, and limits on strain.

mod obstacle;
mod strain_limit;

#[cfg(test)]
mod tests;

pub use obstacle::{CylinderObstacle, Obstacle, Plane, Sphere};
pub use strain_limit::{Provot, StrainLimit};

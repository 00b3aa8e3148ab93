//! The place of a piece as the format has it: a translation, and Euler angles of `Rz Ry Rx`.
//!
//! Method: the angle about y from the first column, that about z from the same column, that about x
//! from what is left when z is undone, so that all three are sharp even where y is a right angle
//! (Shoemake 1994). Cost: none to speak of.

use toile_core::artifact::{Pose, Vector3};

/// Below this length of the first column beside y the angle about z means nothing.
const UPRIGHT: f64 = 1e-12;

/// The angles about x, y and z, degrees.
pub(super) fn angles(pose: &Pose) -> [f64; 3] {
    let (a, b, c) = (pose.across, pose.along, pose.outside());
    let beside = a.x.hypot(a.y);
    let y = (-a.z).atan2(beside);
    let z = if beside > UPRIGHT { a.y.atan2(a.x) } else { 0.0 };
    let (sin, cos) = z.sin_cos();
    let x = (sin * c.x - cos * c.y).atan2(cos * b.y - sin * b.x);
    // No negative zeros.
    [x, y, z].map(|angle| angle.to_degrees() + 0.0)
}

/// The pose with its axes made of length 1 and at right angles to the last bit.
pub(super) fn squared(pose: &Pose) -> Pose {
    let across: Vector3 = pose.across.normalize();
    let along = (pose.along - across * pose.along.dot(&across)).normalize();
    Pose { across, along, ..*pose }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::artifact::Point3;

    #[test]
    fn angles_turn_a_pose_into_itself_in_every_direction() {
        for x in -12..12 {
            for y in -6..=6 {
                for z in -12..12 {
                    let [x, y, z] = [x, y, z].map(|k| f64::from(k) * 15.0_f64.to_radians());
                    let turn = nalgebra::Rotation3::from_euler_angles(x, y, z);
                    let pose = Pose {
                        origin: Point3::origin(),
                        across: turn * Vector3::x(),
                        along: turn * Vector3::y(),
                    };
                    let [a, b, c] = angles(&squared(&pose)).map(f64::to_radians);
                    let again = nalgebra::Rotation3::from_euler_angles(a, b, c);
                    let off = (again.matrix() - turn.matrix()).amax();
                    assert!(off < 1e-14, "{x} {y} {z}: {off}");
                }
            }
        }
    }
}

//! Files whose z axis is up, turned so that y is.

use toile_body::Up;
use toile_core::artifact::Point3;

/// The axis that is up in a body's file: a body is taller than it is deep.
pub(super) fn of_body(positions: &[Point3], triangles: &[[u32; 3]]) -> Up {
    let span = |axis: usize| {
        let all = || triangles.iter().flatten().map(|v| positions[*v as usize][axis]);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    if span(2) > span(1) { Up::Z } else { Up::Y }
}

/// Turns places so that y is up.
pub(super) fn turn(up: Up, positions: &mut [Point3]) {
    if up == Up::Z {
        positions.iter_mut().for_each(|p| *p = Point3::new(p.x, p.z, -p.y));
    }
}

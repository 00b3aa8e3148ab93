//! The cameras of photos that were taken around an object, or of an object on a turntable.
//!
//! All look at one axis from the same distance, which is the unit of length. For a turn `d` from
//! one camera to another, the ray `(x, y, 1)` with the inverse depth `w` is seen by the other at
//! `x' = (x cos d + (1 - w) sin d) / z`, `y' = y / z` with the inverse depth `w' = w / z`, where
//! `z = (1 - w) cos d + w - x sin d`: as `w` runs, along the epipolar line.

/// Cameras of one kind on a circle.
#[derive(Debug, Clone, Copy)]
pub(super) struct OrbitCameras {
    /// Focal length, px.
    pub(super) focal: f64,
    /// The pixel that looks at the axis.
    pub(super) centre: [f64; 2],
}

impl OrbitCameras {
    /// Photos of that size.
    pub(super) fn new(focal: f64, size: [usize; 2]) -> OrbitCameras {
        OrbitCameras { focal, centre: size.map(|n| (n as f64 - 1.0) / 2.0) }
    }

    /// Where what a camera sees at a pixel with that inverse depth is seen by the camera that is
    /// turned by `turn` radians to the right, and with which inverse depth; none behind it.
    pub(super) fn seen(&self, pixel: [f64; 2], inverse_depth: f64, turn: f64) -> Option<([f64; 2], f64)> {
        let [x, y] = [0, 1].map(|c| (pixel[c] - self.centre[c]) / self.focal);
        let (sin, cos) = turn.sin_cos();
        let w = inverse_depth;
        let z = (1.0 - w) * cos + w - x * sin;
        let there = [(x * cos + (1.0 - w) * sin) / z, y / z];
        (z > 1e-3).then(|| ([0, 1].map(|c| self.centre[c] + self.focal * there[c]), w / z))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn the_axis_stays_and_there_and_back_is_the_same_place() {
        let orbit = OrbitCameras::new(400.0, [301, 401]);
        let ([x, y], w) = orbit.seen([150.0, 90.0], 1.0, 0.3).unwrap();
        assert!((x - 150.0).abs() < 1e-9 && (y - 90.0).abs() < 1e-9 && (w - 1.0).abs() < 1e-12);
        let (there, w) = orbit.seen([200.0, 50.0], 1.3, 0.2).unwrap();
        let (back, again) = orbit.seen(there, w, -0.2).unwrap();
        assert!(
            (back[0] - 200.0).abs() < 1e-9 && (back[1] - 50.0).abs() < 1e-9 && (again - 1.3).abs() < 1e-9
        );
        // What is before the axis moves to the left when the camera goes to the right.
        assert!(orbit.seen([150.0, 200.0], 1.2, 0.1).unwrap().0[0] < 150.0);
        assert_eq!(orbit.seen([300.0, 200.0], 0.001, 3.0), None);
    }
}

//! The potential of cloth that is nearer to cloth than a thickness: a spring, then a barrier.
//!
//! Down to half of the thickness `t` the energy is `k/2 (t - d)^2` of the distance `d`. Below, it
//! continues as a logarithm with the same slope and curvature (the two-stage potential of offset
//! geometric contact, Chen et al. 2025). A spring alone carries no more than `k t`: under a greater
//! load the distance of two layers would vanish, only collision detection would hold them apart,
//! and nothing could move any more. Cost: O(1).

/// Share of the thickness below which the barrier is continued by a parabola: layers that start in
/// one place have no distance.
const NEAREST: f64 = 1e-3;

/// Energy, force and curvature at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPotential {
    /// Energy, J.
    pub energy: f64,
    /// Repulsive force, N.
    pub force: f64,
    /// Curvature, N/m.
    pub curvature: f64,
}

impl ContactPotential {
    /// The potential at a distance above 0 m, for a stiffness in N/m and a thickness in m.
    pub(crate) fn of(stiffness: f64, thickness: f64, distance: f64) -> Self {
        let half = 0.5 * thickness;
        if distance >= half {
            return Self::spring(stiffness, thickness, distance);
        }
        let (wall, near) = (stiffness * half * half, distance.max(NEAREST * thickness));
        let (force, curvature) = (wall / near, wall / (near * near));
        let beyond = near - distance;
        let energy = wall * (0.5 + (half / near).ln()) + beyond * (force + 0.5 * curvature * beyond);
        Self { energy, force: force + curvature * beyond, curvature }
    }

    /// The spring alone, at any distance, also a negative one.
    pub(crate) fn spring(stiffness: f64, thickness: f64, distance: f64) -> Self {
        let depth = thickness - distance;
        let force = stiffness * depth;
        Self { energy: 0.5 * force * depth, force, curvature: stiffness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spring_and_wall_meet_and_each_is_the_slope_of_the_other() {
        let (k, t) = (300.0, 1e-3);
        let (above, below) =
            (ContactPotential::of(k, t, 0.5e-3), ContactPotential::of(k, t, 0.5e-3 * (1.0 - 1e-12)));
        assert!((above.energy - below.energy).abs() < 1e-9 * above.energy);
        assert!((above.force - below.force).abs() < 1e-9 * above.force);
        assert!((above.curvature - below.curvature).abs() < 1e-9 * k);
        for d in [0.9e-3, 0.6e-3, 0.3e-3, 0.01e-3, 0.5e-6] {
            let h = 1e-6 * d;
            let (up, down, at) = (
                ContactPotential::of(k, t, d + h),
                ContactPotential::of(k, t, d - h),
                ContactPotential::of(k, t, d),
            );
            assert!(((up.energy - down.energy) / (2.0 * h) + at.force).abs() < 1e-6 * at.force);
            assert!(((up.force - down.force) / (2.0 * h) + at.curvature).abs() < 1e-6 * at.curvature);
        }
    }

    #[test]
    fn no_load_brings_layers_together() {
        // A hundred times what the spring could carry leaves a four-hundredth of the thickness.
        assert!((ContactPotential::of(300.0, 1e-3, 2.5e-6).force - 100.0 * 300.0 * 1e-3).abs() < 1e-9);
        assert!(ContactPotential::of(300.0, 1e-3, 0.0).force.is_finite());
        assert_eq!(ContactPotential::spring(300.0, 1e-3, -1e-3).force, 0.6);
    }
}

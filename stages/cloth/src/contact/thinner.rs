//! A body that is thinner than it is by a stated length: the surface at that depth inside it.
//!
//! Seams whose straight way passes a little beside the middle of a limb close round a thin limb on the right side of it, where a full
//! one would push them off.
//!
//! Limits: a limb thinner than twice the length vanishes; what lies deeper than its middle is pushed to the nearest side.

use super::body::Nearest;
use super::skin::Skin;
use nalgebra::Vector3;
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// Looks along one move until it is known to be free or to end; each brings it nearer by the distance that is left.
const LOOKS: usize = 24;

/// A move ends when it is this near to where it must, m.
const NEAR: f64 = 1e-5;

/// The surface of `skin` moved inwards.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Thinner<'a> {
    pub(crate) skin: &'a dyn Skin,
    /// How far, m; 0 or more.
    pub(crate) by: f64,
}

impl Skin for Thinner<'_> {
    fn nearest(&self, points: &[Vec3], within: &[f64]) -> Vec<Option<Nearest>> {
        let reach: Vec<f64> = within.iter().map(|w| w + self.by).collect();
        let inwards = |(n, within): (Option<Nearest>, &f64)| {
            let Nearest { distance, normal, point } = n?;
            let distance = distance + self.by;
            (distance.abs() < *within).then(|| Nearest { distance, normal, point: point - normal * self.by })
        };
        self.skin.nearest(points, &reach).into_iter().zip(within).map(inwards).collect()
    }

    fn guard(&self, points: &[Vec3], moves: &mut [Vec3], gaps: &[f64]) {
        let guard = |((m, p), gap): ((&mut Vec3, &Vec3), &f64)| {
            let way = m.norm();
            let mut gone = 0.0;
            for look in 0..LOOKS {
                let left = way - gone;
                if left <= 0.0 {
                    return;
                }
                let at = p + *m * (gone / way);
                let Some(near) = self.nearest(&[at], &[left + gap.abs() + NEAR])[0] else { return };
                let free = near.distance - gap;
                if look == 0 && near.distance < 0.0 || free > left {
                    return;
                }
                if free < NEAR {
                    break;
                }
                gone += free;
            }
            *m *= gone / way;
        };
        moves.par_iter_mut().zip(points).zip(gaps).with_min_len(16).for_each(guard);
    }

    fn reach(&self, direction: &Vec3) -> Option<f64> {
        self.skin.reach(direction).map(|r| r - self.by)
    }
}

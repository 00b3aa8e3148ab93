//! One mesh level of a sewn garment, with its state.

use crate::mesh::Sheet;
use crate::statics::forces::body_contact::BodyContact;
use crate::statics::forces::system::System;
use nalgebra::{Rotation3, Vector3};

type Vec3 = Vector3<f64>;

/// A mesh level and the state of its nodes.
#[derive(Clone)]
pub(crate) struct Level<'s> {
    pub(crate) system: System<'s>,
    pub(crate) sheet: Sheet,
    /// The initial positions of the nodes, m; they order the elimination.
    pub(crate) layout: Vec<Vec3>,
    /// The positions of the nodes, m.
    pub(crate) x: Vec<Vec3>,
    /// Whether friction is disabled.
    pub(crate) is_frictionless: bool,
}

impl Level<'_> {
    /// Sets the positions of its nodes and their tangential displacements. `is_prolonged` tells
    /// that they come from a coarser level.
    pub(crate) fn begin(&mut self, x: Vec<Vec3>, slides: Vec<Vec3>, is_prolonged: bool) {
        if let Some(contact) = self.system.get_mut::<BodyContact>().filter(|_| slides.len() == x.len()) {
            contact.slides = slides;
        }
        self.system.elastic.hold(&x, is_prolonged);
        self.x = x;
    }

    /// Disables friction.
    pub(crate) fn disable_friction(&mut self) {
        if !std::mem::replace(&mut self.is_frictionless, true) {
            self.system.swap_friction();
        }
    }

    /// Enables friction; returns whether it was disabled.
    pub(crate) fn enable_friction(&mut self) -> bool {
        let was_disabled = std::mem::take(&mut self.is_frictionless);
        if was_disabled {
            self.system.swap_friction();
        }
        was_disabled
    }

    /// Mean length of its edges, m.
    pub(crate) fn edge(&self) -> f64 {
        let lengths = self.sheet.edges().iter().map(|e| e.rest_length);
        lengths.sum::<f64>() / self.sheet.edges().len().max(1) as f64
    }

    /// Its size, the root of its area, m.
    pub(crate) fn size(&self) -> f64 {
        self.sheet.size()
    }

    /// Its centre of mass, m.
    pub(crate) fn middle(&self) -> Vec3 {
        self.middle_of(&self.x)
    }

    fn middle_of(&self, x: &[Vec3]) -> Vec3 {
        let sum: Vec3 = x.iter().zip(&self.system.loads.masses).map(|(p, m)| p * *m).sum();
        sum / self.system.loads.masses.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// Distance of its centre of mass from the initial one, m.
    pub(crate) fn moved(&self) -> f64 {
        (self.middle() - self.middle_of(&self.layout)).norm()
    }

    /// Angle by which it has turned about its axis along gravity since the start, rad.
    pub(crate) fn turned(&self) -> f64 {
        let arms = |x| arms(&self.axis(), &self.middle_of(x), x);
        turn(&self.axis(), &self.system.loads.masses, &arms(&self.layout), &arms(&self.x))
    }

    /// Turns it about its axis towards its initial orientation, no farther than body contact can
    /// push cloth out. A level with pins stays.
    pub(crate) fn turn_back(&mut self) {
        let Some(depth) = self.system.get::<BodyContact>().map(|c| c.depth) else { return };
        if self.system.pinned.contains(&true) {
            return;
        }
        let (axis, middle) = (self.axis(), self.middle());
        let reach = arms(&axis, &middle, &self.x).iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let most = 0.5 * depth / reach;
        let back = Rotation3::from_scaled_axis(-axis * self.turned().clamp(-most, most));
        self.x.iter_mut().for_each(|p| *p = middle + back * (*p - middle));
    }

    /// Forces on its nodes that turn it about its axis, whose sum is a share of its weight, N.
    pub(crate) fn twist(&self, share: f64) -> Vec<Vec3> {
        let arms = arms(&self.axis(), &self.middle(), &self.x);
        let torque: f64 = arms.iter().zip(&self.system.loads.masses).map(|(a, m)| m * a.norm()).sum();
        let weight = self.system.loads.gravity.norm() * self.system.loads.masses.iter().sum::<f64>();
        let pull = share * weight / torque.max(f64::MIN_POSITIVE);
        arms.iter().zip(&self.system.loads.masses).map(|(a, m)| a * (pull * m)).collect()
    }

    /// The direction against gravity; zero without gravity.
    fn axis(&self) -> Vec3 {
        self.system.loads.gravity.try_normalize(0.0).map_or_else(Vec3::zeros, |g| -g)
    }
}

/// The moves of nodes that turn about an axis through `middle`, m/rad.
fn arms(axis: &Vec3, middle: &Vec3, x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|p| axis.cross(&(p - middle))).collect()
}

/// The angle about an axis that brings one set of arms nearest to another (least squares by mass),
/// rad.
fn turn(axis: &Vec3, masses: &[f64], from: &[Vec3], to: &[Vec3]) -> f64 {
    let each = || masses.iter().zip(from).zip(to);
    let sine: f64 = each().map(|((m, a), b)| m * axis.dot(&a.cross(b))).sum();
    let cosine: f64 = each().map(|((m, a), b)| m * a.dot(b)).sum();
    sine.atan2(cosine)
}

/// Mean distance of two states of the same nodes, m.
pub(crate) fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).sum::<f64>() / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> Vec<Vec3> {
        let at = |k: usize| {
            let angle = k as f64;
            Vec3::new(0.2 * angle.cos(), 0.01 * angle, 0.1 * angle.sin())
        };
        (0..40).map(at).collect()
    }

    #[test]
    fn a_turn_is_told_from_arms_whatever_the_shape_and_the_height() {
        let (axis, masses) = (Vec3::y(), vec![0.1; 40]);
        let turned = Rotation3::from_scaled_axis(axis * 0.3);
        let moved: Vec<Vec3> = ring().iter().map(|p| turned * p + Vec3::new(0.0, -0.4, 0.0)).collect();
        let (a, b) = (arms(&axis, &Vec3::zeros(), &ring()), arms(&axis, &Vec3::zeros(), &moved));
        assert!((turn(&axis, &masses, &a, &b) - 0.3).abs() < 1e-12);
        assert!((turn(&axis, &masses, &b, &a) + 0.3).abs() < 1e-12);
    }

    #[test]
    fn arms_are_level_and_grow_with_the_distance_from_the_axis() {
        let arms = arms(&Vec3::y(), &Vec3::new(0.0, 5.0, 0.0), &[Vec3::new(0.2, 7.0, 0.0)]);
        assert_eq!(arms, [Vec3::new(0.0, 0.0, -0.2)]);
    }
}

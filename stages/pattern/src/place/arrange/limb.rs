//! An arm as an axis with a radius.

use toile_core::prelude::*;

/// Vertices farther than this from the axis are of another part of the body, metres.
const REACH: f64 = 0.13;

/// So far along the axis the shoulder still counts with the arm, and would make it too thick,
/// metres.
const ROOT: f64 = 0.065;

/// An arm: its axis from the shoulder to the wrist, and which way is up and forward around it.
#[derive(Debug, Clone)]
pub(super) struct Limb {
    pub(super) hand: Hand,
    /// The middle of the arm's root.
    pub(super) root: Point3,
    /// Unit direction of the axis.
    pub(super) axis: Vector3,
    /// From the root to the wrist, metres.
    pub(super) length: f64,
    /// Unit direction forward, at right angles to the axis.
    pub(super) front: Vector3,
    /// Unit direction up, at right angles to both.
    pub(super) up: Vector3,
    /// Distance along the axis and from it of each vertex near it, metres.
    skin: Vec<(f64, f64)>,
}

impl Limb {
    /// The two arms of a body; those whose landmarks it has.
    pub(super) fn arms(body: &Body) -> Vec<Limb> {
        Hand::BOTH.into_iter().filter_map(|hand| Limb::arm(body, hand)).collect()
    }

    fn arm(body: &Body, hand: Hand) -> Option<Limb> {
        let at = |part: &str| body.landmark(part, hand);
        let root = nalgebra::center(&at("shoulder")?, &at("armpit")?);
        let arm = at("wrist")? - root;
        let axis = arm.try_normalize(1e-6)?;
        let forward = Vector3::z();
        let front = (forward - axis * axis.dot(&forward)).try_normalize(1e-6)?;
        let upward = Vector3::y();
        let level = upward - axis * axis.dot(&upward);
        let up = (level - front * front.dot(&level)).try_normalize(1e-6)?;
        // The flank of the trunk lies within reach of an arm that hangs steeply.
        let side = at("armpit")?.x;
        let near = |p: &Point3| {
            if p.x * side.signum() < side.abs() {
                return None;
            }
            let along = (p - root).dot(&axis);
            let off = (p - root - axis * along).norm();
            (along > 0.0 && off < REACH).then_some((along, off))
        };
        let skin = body.positions.iter().filter_map(near).collect();
        Some(Limb { hand, root, axis, length: arm.norm(), front, up, skin })
    }

    /// Whether a point is on the arm's side of the body.
    pub(super) fn has(&self, p: &Point3) -> bool {
        p.x * self.root.x > 0.0
    }

    /// The greatest distance of the skin from the axis over a stretch of it, metres; the root
    /// counts for what lies above it.
    pub(super) fn radius(&self, from: f64, to: f64) -> f64 {
        let (from, to) = (from.max(ROOT), to.max(2.0 * ROOT));
        let over = self.skin.iter().filter(|(s, _)| (from..=to).contains(s));
        over.map(|(_, r)| *r).fold(0.0, f64::max)
    }
}

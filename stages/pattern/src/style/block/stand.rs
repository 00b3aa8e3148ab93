//! Where the pieces of a garment stand around a body: as they lie, front before it and back behind
//! it.

use crate::style::block::template::piece_role::Layer;
use nalgebra::Rotation2;
use toile_core::prelude::*;

/// How far pieces stand from the farthest point of the trunk, metres.
const AWAY: f64 = 0.04;
/// How far neck and waist start above the body's, metres.
const ABOVE: f64 = 0.01;
/// Height of the trunk's lower end, as a share of the body's: feet stick out and do not count.
pub(crate) const TRUNK_BOTTOM: f64 = 0.3;
/// Height of the trunk's upper end, as a share of the body's: a head sticks out and does not count.
pub(crate) const TRUNK_TOP: f64 = 0.8;

/// Where a garment's axis stands: the height of its origin, and the planes of its layers.
#[derive(Debug, Clone, Copy)]
pub(in crate::style) struct Stand {
    height: f64,
    depth: (f64, f64),
}

impl Stand {
    /// `top` is the height of neck or waist in the garment's frame, `landmark` that of the body
    /// which it hangs at.
    pub(in crate::style) fn of(body: &Body, landmark: &str, top: f64) -> Result<Stand, StageError> {
        let at = body.landmarks.get(landmark).ok_or_else(|| {
            StageError::invalid(format!(
                "the body has no landmark \"{landmark}\", from which the garment hangs"
            ))
            .hint("take a Mannequin")
        })?;
        let crown = body.positions.iter().map(|p| p.y).fold(0.0, f64::max);
        let side = body.landmark("shoulder", Hand::Left).map_or(f64::INFINITY, |p| p.x.abs());
        let trunk = || {
            let counts =
                |p: &&Point3| p.x.abs() < side && p.y > TRUNK_BOTTOM * crown && p.y < TRUNK_TOP * crown;
            body.positions.iter().filter(counts).map(|p| p.z)
        };
        let depth = (trunk().fold(0.0, f64::max) + AWAY, trunk().fold(0.0, f64::min) - AWAY);
        Ok(Stand { height: at.y + ABOVE - top, depth })
    }

    /// The pose of a piece whose origin lies there in the garment's frame, turned by so much.
    pub(in crate::style) fn pose(&self, at: Point2, turn: f64, layer: Layer) -> Pose {
        // A piece behind the body is seen from behind: its right is the body's left.
        let (sign, z) = match layer {
            Layer::Front => (1.0, self.depth.0),
            Layer::Back => (-1.0, self.depth.1),
        };
        let way = |v: Vector2| {
            let v = Rotation2::new(turn) * v;
            Vector3::new(sign * v.x, v.y, 0.0)
        };
        Pose {
            origin: Point3::new(sign * at.x, self.height + at.y, z),
            across: way(Vector2::x()),
            along: way(Vector2::y()),
        }
    }
}

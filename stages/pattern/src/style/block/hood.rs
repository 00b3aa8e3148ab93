//! A hood: two halves, each other's mirror image, sewn to each other along the crown and to the
//! neck.
//!
//! A garment with a hood that lies flat hides its neckline behind the hood: front and back are
//! cut along the neckline of a block. A half of a hood is drawn as a tailor drafts it: a neck
//! edge as long as half the neckline, a straight opening, and a crown that runs from the nape
//! around the head to the opening, about three quarters as deep as the hood is high (Aldrich
//! 2008). It is as high as it lies, within what the wearer's head lets it be. Its photo is that
//! of the same half: the opening lies along the middle, the crown along the outline. Limits: a
//! hood that lies beside the neck, or folded in, is cut as high as the head needs it; a third
//! panel between the halves is not known.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::flat::{Flat, Run, Side, straight};
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// How deep the neckline lies below its ends, as a share of its width: before and behind.
const NECK_DEPTH: [f64; 2] = [0.42, 0.12];
/// Of a quarter of an ellipse as a cubic: how far its controls lie from its ends.
const ROUND: f64 = 0.5523;
/// Depth of a hood, as a share of its height.
const DEPTH: f64 = 0.72;
/// And it is deeper than its neck edge is long by this share at least.
const LEAST_DEPTH: f64 = 1.15;
/// A hood is higher than the way from the throat to the crown by these shares: at least, and at
/// most.
const EASE: [f64; 2] = [0.1, 0.22];
/// Height of the place where the crown is deepest, as a share of the height.
const DEEPEST: f64 = 0.5;
/// How far the opening lies back at its top, as a share of the depth.
const BACK: f64 = 0.1;
/// How far the halves stand from the head at first, metres.
const AWAY: f64 = 0.025;
/// A head begins at this share of the way from the throat to the crown.
const HEAD: f64 = 0.35;

/// The neckline of a side, from the neck point to the axis.
pub(super) fn neckline(side: &Side, layer: Layer) -> Curve {
    let start = top(side).0[0];
    let share = match layer {
        Layer::Front => NECK_DEPTH[0],
        Layer::Back => NECK_DEPTH[1],
    };
    let deep = share * 2.0 * start.x;
    let end = Point2::new(0.0, start.y - deep);
    let (down, out) = (Vector2::new(0.0, -ROUND * deep), Vector2::new(ROUND * start.x, 0.0));
    Curve([start, start + down, end + out, end])
}

/// The border of the hood in the photo, from the neck point to the axis.
fn top(side: &Side) -> Curve {
    side.edges.last().map_or(Curve([Point2::origin(); 4]), |e| e.1)
}

/// Half of the hood of a side, as it is cut for a head that is so high above the throat, metres; or
/// as it lies in the photo of the front.
pub(super) fn half(side: &Side, head: f64, is_cut: bool) -> Flat {
    let [front, back] = Layer::BOTH.map(|layer| neckline(side, layer));
    let (border, throat) = (top(side), front.0[3]);
    let edges = if is_cut {
        let [least, most] = EASE.map(|ease| head * (1.0 + ease));
        let high = (border.0[3].y - throat.y).clamp(least, most);
        let long = front.length() + back.length();
        let deep = (DEPTH * high).max(LEAST_DEPTH * long);
        let at = |x: f64, y: f64| Point2::new(x, y * high);
        let (nape, behind, opening) = (at(long, 0.0), at(deep, DEEPEST), at(BACK * deep, 1.0));
        let out = deep - long;
        let lower = Curve([nape, at(long + 0.6 * out, 0.15), at(deep, DEEPEST - 0.2), behind]);
        let upper = Curve([behind, at(deep, DEEPEST + 0.27), at(0.52 * deep, 1.0), opening]);
        [
            (EdgeRole::Joint, Run::Cubic(straight(at(0.0, 0.0), nape))),
            (EdgeRole::Crown, Run::Chain(vec![lower, upper])),
            (EdgeRole::Face, Run::Cubic(straight(opening, at(0.0, 0.0)))),
        ]
    } else {
        [
            (EdgeRole::Joint, Run::Cubic(front.turned())),
            (EdgeRole::Crown, Run::Cubic(border)),
            (EdgeRole::Face, Run::Cubic(straight(border.0[3], throat))),
        ]
    };
    Flat::of_trunk(PieceRole::Hood(side.hand), side.alone(&edges))
}

/// How high the top of a head lies above the throat, metres; 0 of a body without a throat, or with
/// none below its top.
pub(super) fn head(body: &Body) -> f64 {
    throat(body).map_or(0.0, |throat| (crown(body) - throat.y).max(0.0))
}

fn throat(body: &Body) -> Option<Point3> {
    body.landmarks.get("neck_base_front").copied()
}

fn crown(body: &Body) -> f64 {
    body.positions.iter().map(|p| p.y).fold(0.0, f64::max)
}

/// Where half of a hood stands: beside the head, its opening before the throat.
///
/// Errors: the body has no throat.
pub(super) fn pose(body: &Body, hand: Hand) -> Result<Pose, StageError> {
    let throat = throat(body).ok_or_else(|| {
        StageError::invalid("the body has no landmark \"neck_base_front\", at which a hood begins")
            .hint("take a Mannequin")
    })?;
    let low = throat.y + HEAD * head(body);
    let aside = body.positions.iter().filter(|p| p.y > low).map(|p| p.x.abs()).fold(0.0, f64::max) + AWAY;
    let sign = match hand {
        Hand::Left => 1.0,
        Hand::Right => -1.0,
    };
    Ok(Pose {
        origin: Point3::new(sign * aside, throat.y, throat.z + AWAY),
        // To the right as seen from outside: backwards on the left, forwards on the right.
        across: Vector3::new(0.0, 0.0, -sign),
        along: Vector3::y(),
    })
}

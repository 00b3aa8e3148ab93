//! Pieces that the user puts at a place of their own, as when they are dragged on the screen.
//!
//! Method: a piece keeps the shape that it has otherwise (bent around an arm, swung, folded). It is
//! turned about the middle of its box, which is then moved to its place. A piece that nothing else
//! places is flat and upright, its outside forwards. Cost: linear in vertices.

use super::{PiecePlaces, unknown};
use crate::place::sew::Offsets;
use nalgebra::Rotation3;
use std::collections::BTreeSet;
use toile_core::prelude::*;

/// No piece starts farther away than this, metres.
const FARTHEST: f64 = 10.0;

/// Where a piece starts.
#[choice]
pub struct HandPlace {
    /// The piece.
    pub piece: String,
    /// Where the middle of its box stands, from the point of the floor below the wearer: to the
    /// wearer's left, up, forwards.
    pub middle: (Length, Length, Length),
    /// Degrees by which it is turned about that point, around the same three axes one after the
    /// other.
    #[serde(default)]
    pub turn: (f64, f64, f64),
}

impl HandPlace {
    fn place(&self) -> Point3 {
        let (x, y, z) = &self.middle;
        Point3::new(x.metres(), y.metres(), z.metres())
    }

    fn rotation(&self) -> Rotation3<f64> {
        let (x, y, z) = self.turn;
        Rotation3::from_euler_angles(x.to_radians(), y.to_radians(), z.to_radians())
    }

    /// Moves a piece from where it stands otherwise.
    fn moved(&self, points: &mut [Point3]) {
        let (middle, place, rotation) = (middle(points), self.place(), self.rotation());
        points.iter_mut().for_each(|p| *p = place + rotation * (*p - middle));
    }
}

/// The pieces that have a place by hand.
///
/// Errors: a piece that is not there, that stands twice, that is far away, or that another
/// parameter or another piece places.
pub(super) fn names(
    hand_places: &[HandPlace],
    flat: &Offsets,
    patches: &BTreeSet<String>,
    keyed: &BTreeSet<String>,
) -> Result<BTreeSet<String>, StageError> {
    let mut names = BTreeSet::new();
    for HandPlace { piece, .. } in hand_places {
        if !flat.contains_key(piece.as_str()) {
            let known: Vec<String> = flat.keys().map(|name| format!("\"{name}\"")).collect();
            return Err(unknown(piece)
                .at("hand_places")
                .hint(format!("its pieces are {}", known.join(", "))));
        }
        let refused = |what: &str, hint: &str| {
            Err(StageError::invalid(format!("the piece \"{piece}\" {what}")).at("hand_places").hint(hint))
        };
        if patches.contains(piece) {
            return refused("lies on the piece that it is sewn onto", "take it out of `hand_places`");
        }
        if keyed.contains(piece) {
            return refused("has key points, too", "keep one of `key_points` and `hand_places` for it");
        }
        if !names.insert(piece.clone()) {
            return refused("has two places", "keep one of them");
        }
    }
    let far = |p: &&HandPlace| p.place().coords.amax() > FARTHEST;
    match hand_places.iter().find(far) {
        Some(HandPlace { piece, .. }) => {
            let what = format!("the piece \"{piece}\" starts more than {FARTHEST:.0} m away");
            let hint = "give its middle in metres from the floor below the wearer, such as (\"0 m\", \"1.2 m\", \"0.2 m\")";
            Err(StageError::invalid(what).at("hand_places").hint(hint))
        }
        None => Ok(names),
    }
}

/// Puts pieces that nothing else places flat and upright, their outside forwards.
pub(super) fn stand(dragged: &BTreeSet<String>, flat: &Offsets, places: &mut PiecePlaces) {
    for name in dragged.iter().filter(|name| !places.contains_key(*name)).collect::<Vec<_>>() {
        if let Some((_, panel)) = flat.get(name.as_str()) {
            let upright = panel.positions.iter().map(|p| Point3::new(p.x, p.y, 0.0));
            places.insert(name.clone(), upright.collect());
        }
    }
}

/// Moves the pieces to their places.
pub(super) fn put(hand_places: &[HandPlace], places: &mut PiecePlaces) {
    for own in hand_places {
        if let Some(points) = places.get_mut(&own.piece) {
            own.moved(points);
        }
    }
}

/// The middle of the box around points.
fn middle(points: &[Point3]) -> Point3 {
    let first = points.first().copied().unwrap_or_else(Point3::origin);
    let (lo, hi) = points.iter().fold((first, first), |(lo, hi), p| (lo.inf(p), hi.sup(p)));
    nalgebra::center(&lo, &hi)
}

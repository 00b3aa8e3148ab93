//! Legs that lie spread, stood under the hips: trousers are cut for legs that stand, however far
//! apart they lie in the photo.
//!
//! Method: below the seat, each height of a leg is moved towards the axis by as much as the leg
//! leans out there: by the lesser slope of its middle line and its outseam, so that shorts and
//! flared legs stay as they are. The hem is levelled with it. Heights stay, so that rise, inseam
//! and outseam keep their lengths to a part in a hundred. Limit: how the cloth folds at the fork of
//! spread legs is not known.

use crate::style::block::template::bow::Bow;
use crate::style::block::template::fit::{Fit, SEAT};
use crate::style::block::template::form::Form;
use nalgebra::Rotation2;
use toile_core::artifact::{EdgeRole, Point2};

/// Trousers are so many times as wide at the fork as at the seat; what is wider there is cloth of
/// the fork, which lies open between spread legs.
const WIDER: f64 = 1.03;

/// Stands the legs of a fit under its hips; nothing for what has none.
pub(crate) fn stood(fit: &mut Fit, form: &Form) {
    if !form.has_legs() {
        return;
    }
    let [inseam, hem, outseam] =
        [EdgeRole::Inseam, EdgeRole::Hem, EdgeRole::Outseam].map(|role| form.at(role));
    let (Some(inseam), Some(hem), Some(outseam)) = (inseam, hem, outseam) else { return };
    for side in &mut fit.sides {
        let (fork, waist) = (side[inseam].a, side[side.len() - 1].b);
        let seat = fork.y + SEAT * (waist.y - fork.y);
        let foot = nalgebra::center(&side[hem].a, &side[hem].b);
        let outer = |y: f64| at_height(&side[outseam..side.len() - 1], y);
        let (Some(beside), Some(above)) = (outer(fork.y), outer(seat)) else { continue };
        let slope = |low: Point2, high: Point2| (low.x - high.x) / (high.y - low.y).max(1e-3);
        let lean = slope(foot, nalgebra::center(&beside, &fork)).min(slope(side[outseam].a, beside)).max(0.0);
        let spread = (beside.x - WIDER * above.x).max(0.0);
        let moved = |p: Point2| {
            let below = (seat - p.y).max(0.0);
            let share = (below / (seat - fork.y).max(1e-6)).min(1.0);
            Point2::new(p.x - lean * below - spread * share, p.y)
        };
        let (level, stood) = (Rotation2::new(-lean.atan()), moved(foot));
        let ends = [side[hem].a, side[hem].b].map(|p| stood + level * (p - foot));
        (side[hem].a, side[hem].b) = (ends[0], ends[1]);
        (side[inseam].a, side[inseam].b) = (moved(fork), ends[0]);
        side[outseam].a = ends[1];
        side[outseam].b = moved(side[outseam].b);
        if let Some(next) = side.get_mut(outseam + 1) {
            next.a = moved(next.a);
        }
    }
}

/// The point of some edges nearest to a height.
fn at_height(edges: &[Bow], y: f64) -> Option<Point2> {
    let points = edges.iter().flat_map(Bow::points);
    points.min_by(|p, q| (p.y - y).abs().total_cmp(&(q.y - y).abs()))
}

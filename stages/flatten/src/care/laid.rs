//! Two outlines of a pair in one plane, and where the vertices of each belong on the other.
//!
//! Between corners and seam ends, which correspond by their lengths, a vertex belongs where the
//! other line is nearest, so that nothing is strained along the edge for the sake of its spacing.
//! Cost O(n^2) for n vertices of each outline.

use super::outline::{Correspondence, MeasuredOutline, RigidMotion};
use nalgebra::{Point2, Vector2};

/// Where a vertex should lie, and whether it must lie there.
pub(super) type Target = (Point2<f64>, bool);

/// The outlines of a pair, laid over each other.
pub(super) struct LaidPair {
    /// Their pieces.
    pub(super) pieces: [usize; 2],
    /// The first outline.
    pub(super) a: MeasuredOutline,
    /// The mirrored second outline in the plane of the first.
    pub(super) b: MeasuredOutline,
    /// Corners and seam ends of both.
    pub(super) ends: [Vec<usize>; 2],
    /// How near they must come.
    pub(super) near: f64,
    /// What has laid the mirrored second over the first.
    pub(super) motion: RigidMotion,
    /// Which length of the one is which of the other.
    pub(super) map: Correspondence,
}

/// One of the two outlines.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum PairSide {
    First,
    Second,
}

impl PairSide {
    fn other(self) -> Self {
        match self {
            PairSide::First => PairSide::Second,
            PairSide::Second => PairSide::First,
        }
    }
}

/// How an outline is drawn to the other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pull {
    /// Corners and seam ends to their places, what lies between onto the line, along which it is
    /// free.
    Slide,
    /// Every vertex to the place on the line that is nearest.
    Hold,
    /// As before, but that an edge that cuts off a vertex of the other outline is moved out by half
    /// of that.
    Fit,
}

impl LaidPair {
    /// Whether the outlines are near enough to be called mirror images.
    pub(super) fn is_near(&self) -> bool {
        self.distance() <= self.near
    }

    /// The largest distance of a vertex of either outline from the other.
    pub(super) fn distance(&self) -> f64 {
        let farthest = |x: &MeasuredOutline, y: &MeasuredOutline| {
            x.places().iter().map(|p| y.distance(p)).fold(0.0, f64::max)
        };
        farthest(&self.a, &self.b).max(farthest(&self.b, &self.a))
    }

    /// For each vertex of an outline, in its own plane and order, where it should lie, and whether
    /// it must lie there: corners and seam ends, and what stands for those of the other. The first
    /// is drawn to the mean of both, the second onto the first.
    pub(super) fn targets(&self, side: PairSide, pull: Pull) -> Vec<Target> {
        let targets = self.on_other(side, pull);
        match side {
            PairSide::First => {
                let mean = |(t, p): (&Target, &Point2<f64>)| (nalgebra::center(&t.0, p), t.1);
                targets.iter().zip(self.a.places()).map(mean).collect()
            }
            PairSide::Second => {
                let own_plane = |&(p, end): &Target| {
                    let p = self.motion.undone(&p);
                    (Point2::new(-p.x, p.y), end)
                };
                targets.iter().rev().map(own_plane).collect()
            }
        }
    }

    /// The same on the line of the other outline, in the common plane.
    fn on_other(&self, side: PairSide, pull: Pull) -> Vec<Target> {
        let [own, other] = self.own_and_other(side);
        let count = own.places().len();
        let mut targets: Vec<Target> = match pull {
            Pull::Slide => (0..count).map(|k| (other.at(self.across(side, own.arc(k))), false)).collect(),
            Pull::Hold | Pull::Fit => own.places().iter().map(|p| (other.nearest(p), false)).collect(),
        };
        for &k in &self.ends[side as usize] {
            targets[k] = (other.at(self.across(side, own.arc(k))), true);
        }
        for &k in &self.ends[side.other() as usize] {
            let stands_for = &mut targets[own.vertex_near(self.across(side.other(), other.arc(k)))];
            if !stands_for.1 {
                *stands_for = (other.places()[k], true);
            }
        }
        if pull == Pull::Fit {
            let free = targets.iter_mut().zip(moved_out(own, other)).filter(|(t, _)| !t.1);
            free.for_each(|(target, shift)| target.0 += shift);
        }
        targets
    }

    fn own_and_other(&self, side: PairSide) -> [&MeasuredOutline; 2] {
        match side {
            PairSide::First => [&self.a, &self.b],
            PairSide::Second => [&self.b, &self.a],
        }
    }

    /// The length on the other outline for one on this.
    fn across(&self, side: PairSide, arc: f64) -> f64 {
        match side {
            PairSide::First => self.map.forward(arc),
            PairSide::Second => self.map.back(arc),
        }
    }
}

/// By how much vertices of one outline are moved so that their edges cut off half as much of the
/// other.
fn moved_out(own: &MeasuredOutline, other: &MeasuredOutline) -> Vec<Vector2<f64>> {
    let mut shifts = vec![Vector2::zeros(); own.places().len()];
    for p in other.places() {
        let (edge, nearest) = own.nearest_edge(p);
        let shift = (p - nearest) / 2.0;
        for k in [edge, (edge + 1) % shifts.len()] {
            if shift.norm_squared() > shifts[k].norm_squared() {
                shifts[k] = shift;
            }
        }
    }
    shifts
}

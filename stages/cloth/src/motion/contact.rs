//! Contact of moving cloth with the body and with itself, as corrections of the moves of a step.
//! Cost: linear in the pairs.

use crate::contact::step_limit::limit_with_search;
use crate::statics::drive::solve::Collider;
use toile_geometry::pair::Pair;
use toile_geometry::signed_distance::Nearest;
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// Share of the overlap of two layers that one step removes.
const RELEASE: f64 = 0.2;

/// The response of the body to cloth in contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Response {
    /// Coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// `None` stops cloth at the contact distance.
    pub penalty: Option<PenaltyForce>,
}

/// The force with which the body pushes off cloth that is near it, outwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PenaltyForce {
    /// `c (d - distance)` within the contact distance d: the stiffness c, N/m per node (Fan, Zhou,
    /// Wang, Yuen 1999).
    Linear(f64),
    /// `c exp(-distance / d)`: the force c at the body, N per node (improved spring-mass model,
    /// 2003).
    Exponential(f64),
}

/// Greatest penalty stiffness, as a share of the unstable one.
const PENALTY_SHARE: f64 = 0.5;

/// The exponential force is neglected beyond so many contact distances, where it is less than a
/// thousandth of that at the body.
const NEGLIGIBLE: f64 = 7.0;

impl PenaltyForce {
    /// The distance up to which it acts, m, with this contact distance.
    fn range(self, offset: f64) -> f64 {
        match self {
            Self::Linear(_) => offset,
            Self::Exponential(_) => NEGLIGIBLE * offset,
        }
    }

    /// Its slope at a distance from the body, N/m, and the quotient of force and slope, m.
    fn slope(self, distance: f64, offset: f64) -> (f64, f64) {
        match self {
            Self::Linear(c) => (c, offset - distance),
            Self::Exponential(c) => (c / offset * (-distance / offset).exp(), offset),
        }
    }

    /// The way by which it pushes a node in a step, m, where `square` is the square of the time
    /// step over the node's mass, s2/kg. A force too steep for the step is reduced.
    fn push(self, distance: f64, offset: f64, square: f64) -> f64 {
        if distance >= self.range(offset) {
            return 0.0;
        }
        let (slope, quotient) = self.slope(distance, offset);
        (slope * square).min(PENALTY_SHARE) * quotient
    }
}

impl Response {
    /// How much farther than the contact distance the body acts on cloth, m.
    pub(super) fn beyond(&self, offset: f64) -> f64 {
        self.penalty.map_or(0.0, |p| p.range(offset) - offset)
    }
}

/// How a solid pushes out cloth that starts in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pushed {
    /// The depth from which it does, m.
    pub(super) reach: f64,
    /// The speed at which it does, m/s.
    pub(super) speed: f64,
}

/// What the response depends on.
pub(super) struct Answer<'a> {
    pub(super) response: Response,
    /// Inverse mass of each node, 1/kg; 0 for pinned nodes.
    pub(super) inverse: &'a [f64],
    /// Time step, s.
    pub(super) dt: f64,
    /// Coefficient of friction.
    pub(super) friction: f64,
    /// Farthest that a node is lifted to the contact distance, m.
    pub(super) lift: f64,
}

impl Answer<'_> {
    /// For a node at `distance` from the body that would move by `approach` along the normal: its
    /// move along the normal, and the part of it that is velocity. `None` for a node that is not
    /// in contact at the contact distance `offset`.
    fn along_normal(&self, node: usize, distance: f64, offset: f64, approach: f64) -> Option<(f64, f64)> {
        let gap = distance - offset;
        if let Some(penalty) = self.response.penalty {
            let push = penalty.push(distance, offset, self.dt * self.dt * self.inverse[node]);
            return (push > 0.0).then_some((approach + push, approach + push));
        }
        if approach >= -gap {
            return None;
        }
        let back = -self.response.restitution * approach;
        Some(match (gap < 0.0, back > 0.0) {
            // The node is lifted to the contact distance, which is no velocity.
            (true, _) => ((-gap).min(self.lift).max(back), approach.max(back).max(0.0)),
            (false, false) => (-gap, -gap),
            // The node moves back by the rest of its move.
            (false, true) => (-gap - self.response.restitution * (approach + gap), back),
        })
    }
}

/// The nearest places of the body for vertices that move, where they are nearer than their way and
/// `within`, m.
pub(super) fn nearest_on_body(
    collider: Collider<'_>,
    x: &[Vec3],
    moves: &[Vec3],
    within: f64,
) -> Vec<Option<Nearest>> {
    let within: Vec<f64> = moves.iter().map(|m| within + m.norm()).collect();
    collider.surface.nearest(x, &within)
}

/// Keeps moves out of the body, with Coulomb friction: the tangential move is reduced by up to the
/// coefficient of friction times the lost normal move.
///
/// Returns how much of each move lifts the vertex to the contact distance, which is no velocity.
pub(super) fn respond_to_body(
    near: &[Option<Nearest>],
    answer: &Answer<'_>,
    moves: &mut [Vec3],
    offset: f64,
) -> Vec<Vec3> {
    let mut pushed = vec![Vec3::zeros(); moves.len()];
    for (v, n) in near.iter().enumerate() {
        let Some(n) = n else { continue };
        let approach = moves[v].dot(&n.normal);
        let Some((goes, kept)) = answer.along_normal(v, n.distance, offset, approach) else { continue };
        let along = moves[v] - n.normal * approach;
        let (way, loss) = (along.norm(), answer.friction * (kept - approach).max(0.0));
        let along = if way > loss { along * (1.0 - loss / way) } else { Vec3::zeros() };
        pushed[v] = n.normal * (goes - kept);
        moves[v] = along + n.normal * goes;
    }
    pushed
}

/// Stops layers of cloth that come nearer than `thickness`, with friction, and pushes them apart a
/// little.
pub(super) fn respond_to_self_contact(
    pairs: &[Pair],
    x: &[Vec3],
    moves: &mut [Vec3],
    inverse: &[f64],
    thickness: f64,
    friction: &[f64],
    share: f64,
) {
    for p in pairs {
        let c = p.closest(x);
        if c.distance >= thickness || c.distance == 0.0 {
            continue;
        }
        let normal = c.between / c.distance;
        let way: Vec3 = (0..4).map(|i| moves[p.nodes[i] as usize] * c.weights[i]).sum();
        let (approach, wanted) = (way.dot(&normal), RELEASE * (thickness - c.distance));
        let sum: f64 = (0..4).map(|i| c.weights[i].powi(2) * inverse[p.nodes[i] as usize]).sum();
        if approach >= wanted || sum == 0.0 {
            continue;
        }
        let along = way - normal * approach;
        // The weights of either side have the sum 1, so that this is the mean of both sides.
        let mean_friction: f64 =
            (0..4).map(|i| 0.5 * c.weights[i].abs() * friction[p.nodes[i] as usize]).sum();
        let (length, loss) = (along.norm(), share * mean_friction * (wanted - approach));
        let drag = if length > 0.0 { along * (loss / length).min(1.0) } else { along };
        let change = (normal * (wanted - approach) - drag) / sum;
        for i in 0..4 {
            let v = p.nodes[i] as usize;
            moves[v] += change * (c.weights[i] * inverse[v]);
        }
    }
}

/// Shortens moves where cloth would collide with cloth; returns the share to which the whole step
/// was shortened.
pub(super) fn limit_step(tree: &ClothTree, x: &[Vec3], moves: &mut [Vec3], thickness: f64) -> f64 {
    let seek = |moves: &[Vec3]| tree.pairs(x, moves, thickness);
    let pairs = seek(moves);
    limit_with_search(x, moves, pairs, |_| true, |moves| Some(seek(moves))).1
}

//! What cloth meets on its way: the body, and itself.

use crate::contact::limit::hold_apart;
use crate::statics::drive::solve::Collider;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;
use toile_geometry::signed_distance::Nearest;

type Vec3 = Vector3<f64>;

/// Share of an overlap of two layers that one step takes away.
const RELEASE: f64 = 0.2;

/// How the body answers cloth that touches it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Response {
    /// Share of the speed into the body that comes back, 0 to 1.
    pub restitution: f64,
    /// Stiffness with which cloth within its distance is pushed off, N/m a node; where there is
    /// none, it is stopped at its distance.
    pub penalty: Option<f64>,
}

/// Penalty forces use no more than this share of the stiffness that would be unstable.
const PENALTY_SHARE: f64 = 0.5;

/// What an answer is reckoned with.
pub(super) struct Answer<'a> {
    pub(super) response: Response,
    /// One over the mass of each node, 1/kg; 0 for one that is held.
    pub(super) inverse: &'a [f64],
    /// s.
    pub(super) dt: f64,
    /// Coulomb's coefficient.
    pub(super) friction: f64,
}

impl Answer<'_> {
    /// The way along the normal, and how much of it is velocity, of a node at `gap` from its
    /// distance that would go by `approach`; none for one that is left alone.
    fn along_normal(&self, node: usize, gap: f64, approach: f64) -> Option<(f64, f64)> {
        if let Some(penalty) = self.response.penalty {
            let square = self.dt * self.dt * self.inverse[node];
            let push = (penalty * square).min(PENALTY_SHARE) * -gap;
            return (gap < 0.0).then_some((approach + push, approach + push));
        }
        if approach >= -gap {
            return None;
        }
        let back = -self.response.restitution * approach;
        Some(match (gap < 0.0, back > 0.0) {
            // Out of the layer it is lifted; that is no speed of its own.
            (true, _) => ((-gap).max(back), approach.max(back).max(0.0)),
            (false, false) => (-gap, -gap),
            // As much as is left of the way, it goes back.
            (false, true) => (-gap - self.response.restitution * (approach + gap), back),
        })
    }
}

/// The skin near vertices that move.
pub(super) fn skin_near(
    wearer: Collider<'_>,
    x: &[Vec3],
    moves: &[Vec3],
    offset: f64,
) -> Vec<Option<Nearest>> {
    let within: Vec<f64> = moves.iter().map(|m| offset + m.norm()).collect();
    wearer.skin.nearest(x, &within)
}

/// Keeps moves out of the body: what a vertex loses of its way into it, times the friction, it may
/// lose of its way along it.
///
/// Returns how much of each move is a push out of the layer around the body, which is no velocity.
pub(super) fn off_the_body(
    near: &[Option<Nearest>],
    answer: &Answer<'_>,
    moves: &mut [Vec3],
    offset: f64,
) -> Vec<Vec3> {
    let mut pushed = vec![Vec3::zeros(); moves.len()];
    for (v, n) in near.iter().enumerate() {
        let Some(n) = n else { continue };
        let (gap, approach) = (n.distance - offset, moves[v].dot(&n.normal));
        let Some((goes, kept)) = answer.along_normal(v, gap, approach) else { continue };
        let along = moves[v] - n.normal * approach;
        let (way, loss) = (along.norm(), answer.friction * (kept - approach).max(0.0));
        let along = if way > loss { along * (1.0 - loss / way) } else { Vec3::zeros() };
        pushed[v] = n.normal * (goes - kept);
        moves[v] = along + n.normal * goes;
    }
    pushed
}

/// SelfContact of cloth that come nearer than `thickness` are stopped, with friction, and pushed
/// apart a little.
pub(super) fn off_itself(
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
        // The weights of either side have the sum 1: the mean of both.
        let rub: f64 = (0..4).map(|i| 0.5 * c.weights[i].abs() * friction[p.nodes[i] as usize]).sum();
        let (length, loss) = (along.norm(), share * rub * (wanted - approach));
        let drag = if length > 0.0 { along * (loss / length).min(1.0) } else { along };
        let change = (normal * (wanted - approach) - drag) / sum;
        for i in 0..4 {
            let v = p.nodes[i] as usize;
            moves[v] += change * (c.weights[i] * inverse[v]);
        }
    }
}

/// Cuts moves short where cloth would pass through cloth; to what share all of the cloth was, for
/// want of a better way.
pub(super) fn stop_short(tree: &ClothTree, x: &[Vec3], moves: &mut [Vec3], thickness: f64) -> f64 {
    let seek = |moves: &[Vec3]| tree.pairs(x, moves, thickness);
    let pairs = seek(moves);
    hold_apart(x, moves, pairs, |_| true, |moves| Some(seek(moves))).1
}

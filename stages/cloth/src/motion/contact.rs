//! What cloth meets on its way: the body, and itself.

use crate::contact::limit::hold_apart;
use crate::rest::solve::Wearer;
use nalgebra::Vector3;
use toile_geometry::cloth_tree::ClothTree;
use toile_geometry::pair::Pair;

type Vec3 = Vector3<f64>;

/// Share of an overlap of two layers that one step takes away.
const RELEASE: f64 = 0.2;

/// Keeps moves out of the body: what a vertex loses of its way into it, times the friction, it may lose of its way along it.
///
/// Returns how much of each move is a push out of the layer around the body, which is no velocity.
pub(super) fn off_the_body(wearer: Wearer<'_>, x: &[Vec3], moves: &mut [Vec3], offset: f64) -> Vec<Vec3> {
    let within: Vec<f64> = moves.iter().map(|m| offset + m.norm()).collect();
    let near = wearer.skin.nearest(x, &within);
    let mut pushed = vec![Vec3::zeros(); x.len()];
    for (v, n) in near.iter().enumerate() {
        let Some(n) = n else { continue };
        let (gap, approach) = (n.distance - offset, moves[v].dot(&n.normal));
        if approach >= -gap {
            continue;
        }
        // Out of the layer it is lifted; that is no speed of its own.
        let kept = if gap < 0.0 { approach.max(0.0) } else { -gap };
        let along = moves[v] - n.normal * approach;
        let (way, loss) = (along.norm(), wearer.friction * (kept - approach).max(0.0));
        let along = if way > loss { along * (1.0 - loss / way) } else { Vec3::zeros() };
        pushed[v] = n.normal * (-gap - kept);
        moves[v] = along - n.normal * gap;
    }
    wearer.skin.guard(x, moves, &vec![0.5 * offset; x.len()]);
    pushed
}

/// Layers of cloth that come nearer than `thickness` are stopped, with friction, and pushed apart a little.
pub(super) fn off_itself(
    pairs: &[Pair],
    x: &[Vec3],
    moves: &mut [Vec3],
    inverse: &[f64],
    thickness: f64,
    friction: f64,
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
        let (length, loss) = (along.norm(), friction * (wanted - approach));
        let drag = if length > 0.0 { along * (loss / length).min(1.0) } else { along };
        let change = (normal * (wanted - approach) - drag) / sum;
        for i in 0..4 {
            let v = p.nodes[i] as usize;
            moves[v] += change * (c.weights[i] * inverse[v]);
        }
    }
}

/// Cuts moves short where cloth would pass through cloth; to what share all of the cloth was, for want of a better way.
pub(super) fn stop_short(tree: &ClothTree, x: &[Vec3], moves: &mut [Vec3], thickness: f64) -> f64 {
    let seek = |moves: &[Vec3]| tree.pairs(x, moves, thickness);
    let pairs = seek(moves);
    hold_apart(x, moves, pairs, |_| true, |moves| Some(seek(moves))).1
}

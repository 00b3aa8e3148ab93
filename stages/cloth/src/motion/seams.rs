//! Seams that close at a set speed. Cost: O(1) a pair.

use crate::scene::Scene;
use crate::statics::levels::pieces::Pieces;
use toile_geometry::Vec3;

/// Pairs of vertices that close.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Seams {
    pub(super) pairs: Vec<[u32; 2]>,
}

impl Seams {
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The pair with the widest gap.
    pub(super) fn widest(&self, x: &[Vec3]) -> Option<([u32; 2], f64)> {
        let gap = |p: &[u32; 2]| (x[p[0] as usize] - x[p[1] as usize]).norm();
        self.pairs.iter().map(|p| (*p, gap(p))).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Changes the moves so that the gap of each pair shrinks by at most `most`, with the momentum
    /// of the pair kept.
    pub(super) fn close(&self, x: &[Vec3], moves: &mut [Vec3], masses: &[f64], fixed: &[bool], most: f64) {
        for &[a, b] in &self.pairs {
            let (a, b) = (a as usize, b as usize);
            let gap = x[b] - x[a];
            let length = gap.norm();
            let wanted = if length > most { gap * (-most / length) } else { -gap };
            let weight = |v: usize| if fixed[v] { 0.0 } else { 1.0 / masses[v] };
            let (wa, wb) = (weight(a), weight(b));
            if wa + wb > 0.0 {
                let change = (wanted - (moves[b] - moves[a])) / (wa + wb);
                moves[a] -= change * wa;
                moves[b] += change * wb;
            }
        }
    }
}

/// The seam that a pair belongs to.
pub(super) fn name_of(scene: &Scene, pieces: &Pieces, pair: [u32; 2]) -> String {
    let point = pieces.point[pair[0] as usize];
    let has = |p: &[u32; 2]| pieces.point[p[0] as usize] == point;
    let seam = scene.seams.iter().find(|s| s.pairs.iter().any(has));
    seam.map_or("?".into(), |s| s.name.clone())
}

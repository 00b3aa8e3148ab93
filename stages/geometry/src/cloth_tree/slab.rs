//! A quick test for two triangles that are too far apart for any of their features to meet.
//!
//! Boxes of triangles that lie slanted are thick: where cloth lies in layers, a triangle's box
//! meets those of many layers. Along the normal of either triangle they are flat (two of the axes
//! of the separating axis theorem).

use super::features::PairSearch;

use crate::Vec3;
impl PairSearch<'_> {
    /// Whether the triangles are farther apart than any pair of their features looks:
    /// [`PairSearch::keep`] would drop all of them.
    pub(super) fn is_far(&self, a: &[u32; 3], b: &[u32; 3]) -> bool {
        let [p, q] = [a, b].map(|t| t.map(|v| self.x[v as usize]));
        let reach = self.reach + self.approach(a, b);
        is_beside(&p, &q, reach) || is_beside(&q, &p, reach)
    }

    /// A bound on how fast any two features of two triangles approach, by which the reach of a pair
    /// grows.
    fn approach(&self, a: &[u32; 3], b: &[u32; 3]) -> f64 {
        let shared = a.iter().chain(b).map(|&v| self.moves[v as usize]).sum::<Vec3>() / 6.0;
        let fastest = |t: &[u32; 3]| {
            t.iter().map(|&v| (self.moves[v as usize] - shared).norm_squared()).fold(0.0, f64::max).sqrt()
        };
        let (a, b) = (fastest(a), fastest(b));
        // What the four nodes of a pair share is within the fastest of what all six do not.
        a + b + 2.0 * a.max(b)
    }
}

/// Whether all of `b` lies farther than `reach` from the plane of `a`, on one side.
fn is_beside(a: &[Vec3; 3], b: &[Vec3; 3], reach: f64) -> bool {
    let normal = (a[1] - a[0]).cross(&(a[2] - a[0]));
    let heights = b.map(|p| normal.dot(&(p - a[0])));
    let least = reach * normal.norm() * (1.0 + 1e-9);
    heights.iter().all(|h| *h > least) || heights.iter().all(|h| *h < -least)
}

//! Offsets of body contact that allow for the sag of edges on a convex body. Cost: O(n).

use super::BodyContact;
use crate::statics::forces::distance_query::ContactQuery;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

impl BodyContact {
    /// Increases the offsets of nodes in contact where the edges between them would dip into a
    /// convex body. Edges over an edge of the body are left out.
    pub(super) fn allow_for_sag(&mut self, near: &[ContactQuery], x: &[Vec3]) {
        let mut sags = vec![0.0f64; self.offsets.len()];
        for &(edge, length) in &self.edges {
            let [i, j] = edge.map(|i| i as usize);
            if let (Some(a), Some(b)) = (&near[i].1, &near[j].1) {
                let turn = b.normal - a.normal;
                if turn.dot(&(x[j] - x[i])) > 0.0 && !self.is_bridge(edge) {
                    let sag = length * turn.norm() / 8.0;
                    (sags[i], sags[j]) = (sags[i].max(sag), sags[j].max(sag));
                }
            }
        }
        // Offsets only grow within a level, or contacts would come and go with them.
        for (i, sag) in sags.into_iter().enumerate() {
            // A polygon around a circle has its length when its corners stand a third of the sag
            // outside.
            let least =
                if self.keeps_edges_out { (sag - 0.5 * self.offset).max(sag / 3.0) } else { sag / 3.0 };
            self.offsets[i] = self.offsets[i].max(self.offset + least);
        }
    }

    /// Whether an edge of the cloth lies over an edge of the body, so that its nodes need no larger
    /// offset.
    fn is_bridge(&self, [a, b]: [u32; 2]) -> bool {
        self.bridges.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }
}

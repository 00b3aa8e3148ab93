//! Which triangles lie in others: so near that their sides cannot be distinguished.

use super::ClothTree;
use crate::closest::on_triangle;
use crate::volume::BoundingVolume;

use crate::Vec3;
impl<V: BoundingVolume> ClothTree<V> {
    /// Triangles whose middles are nearer than `reach` to another triangle, and that one, sorted;
    /// those about to be sewn to each other do not count. Triangles that cross or touch along a
    /// line have their middles elsewhere.
    #[must_use]
    pub fn lying(&self, x: &[Vec3], reach: f64) -> Vec<([u32; 3], [u32; 3])> {
        let lies = |s: usize, t: usize, out: &mut Vec<_>| {
            let (s, t) = (self.features.triangles[s], self.features.triangles[t]);
            if s.iter().any(|&v| self.features.is_one_of(v, &t)) {
                return;
            }
            for (own, other) in [(s, t), (t, s)] {
                let middle = own.iter().map(|&v| x[v as usize]).sum::<Vec3>() / 3.0;
                let on = on_triangle(&middle, &other.map(|v| x[v as usize]));
                if (on.point - middle).norm() < reach {
                    out.push((own, other));
                }
            }
        };
        let mut all = self.meetings(None, &self.still(x), reach, &lies);
        all.sort_unstable();
        all
    }
}

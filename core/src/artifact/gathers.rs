//! Rest shapes of triangles along gathered seams.
//!
//! The folds of a gather are too small for a mesh. They are left out: the longer side of a gathered seam counts as long as the shorter one, and the
//! corners of its triangles are drawn together to that.

use super::{Garment, Point2, SeamKind};

/// The flat corners of every triangle of the garment, metres; those along a gathered seam drawn together.
pub(super) fn corners(garment: &Garment) -> Vec<[Point2; 3]> {
    let mut corners: Vec<[Point2; 3]> =
        garment.triangles.iter().map(|t| t.map(|v| garment.rest[v as usize])).collect();
    let gathered = garment.seams.iter().filter(|s| s.kind == SeamKind::Gathered);
    let mut point: Vec<Option<u32>> = vec![None; garment.positions.len()];
    for pair in gathered.flat_map(|s| &s.pairs) {
        let least = pair.iter().map(|&v| point[v as usize].unwrap_or(v)).min();
        pair.iter().for_each(|&v| point[v as usize] = least);
    }
    if point.iter().all(Option::is_none) {
        return corners;
    }
    let mut sides = Vec::new();
    for (t, v) in garment.triangles.iter().enumerate() {
        for k in 0..3 {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            if let (Some(a), Some(b)) = (point[v[i] as usize], point[v[j] as usize]) {
                sides.push(([a.min(b), a.max(b)], t, [i, j], (corners[t][i] - corners[t][j]).norm()));
            }
        }
    }
    sides.sort_unstable_by_key(|s| (s.0, s.1, s.2));
    for pair in sides.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() == 2) {
        let shorter = pair[0].3.min(pair[1].3);
        for &(_, t, [i, j], length) in pair.iter().filter(|s| s.3 > shorter) {
            let inwards = (corners[t][j] - corners[t][i]) * (0.5 * (1.0 - shorter / length));
            corners[t][i] += inwards;
            corners[t][j] -= inwards;
        }
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testkit::dress;

    #[test]
    fn a_garment_without_gathers_has_the_corners_that_it_is_cut_with() {
        let garment = dress::garment();
        let cut: Vec<[Point2; 3]> =
            garment.triangles.iter().map(|t| t.map(|v| garment.rest[v as usize])).collect();
        assert_eq!(corners(&garment), cut);
    }
}

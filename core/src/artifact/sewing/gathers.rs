//! Rest shapes of triangles along gathered seams.
//!
//! The folds of a gather are too small for a mesh. They are left out: the longer side of a gathered
//! seam counts as long as the shorter one, and the corners of its triangles are drawn together to
//! that.

use crate::artifact::{Garment, Point2, SeamKind};

/// The flat corners of every triangle of the garment, metres, those along a gathered seam drawn
/// together; nothing where no seam gathers, for all are then as they are cut.
pub(crate) fn corners(garment: &Garment) -> Option<Vec<[Point2; 3]>> {
    let gathered = garment.seams.iter().filter(|s| s.kind == SeamKind::Gathered);
    let mut point: Vec<Option<u32>> = vec![None; garment.positions.len()];
    for pair in gathered.flat_map(|s| &s.pairs) {
        let least = pair.iter().map(|&v| point[v as usize].unwrap_or(v)).min();
        pair.iter().for_each(|&v| point[v as usize] = least);
    }
    if point.iter().all(Option::is_none) {
        return None;
    }
    let mut corners: Vec<[Point2; 3]> =
        garment.triangles.iter().map(|t| t.map(|v| garment.rest[v as usize])).collect();
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
    Some(corners)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::artifact::{GarmentSeam, SeamState};
    use crate::testkit::dress;

    #[test]
    fn a_garment_without_gathers_is_as_it_is_cut() {
        let garment = dress::garment();
        assert_eq!(corners(&garment), None);
        assert!(garment.edge_strains().iter().all(|s| *s < 1e-9));
    }

    /// The garment with a front that is twice as large as its back, gathered along one seam.
    fn gathered() -> Garment {
        let mut garment = dress::garment();
        let seam = garment.seams.swap_remove(0);
        garment.seams = vec![GarmentSeam { kind: SeamKind::Gathered, state: SeamState::Closed, ..seam }];
        let front = garment.panels[0].vertices.clone();
        garment.rest[front].iter_mut().for_each(|p| *p *= 2.0);
        garment
    }

    #[test]
    fn the_longer_side_of_a_gathered_seam_counts_as_long_as_the_shorter() {
        let garment = gathered();
        let corners = corners(&garment).unwrap();
        let sewn = |t: &[u32; 3], k: usize| {
            let on = |v: u32| garment.seams[0].pairs.iter().any(|p| p.contains(&v));
            on(t[k]) && on(t[(k + 1) % 3])
        };
        let mut lengths = Vec::new();
        for (t, c) in garment.triangles.iter().zip(&corners) {
            lengths.extend((0..3).filter(|&k| sewn(t, k)).map(|k| (c[k] - c[(k + 1) % 3]).norm()));
        }
        // As many sides on the front as on the back, and all of the back's length.
        let half = lengths.len() / 2;
        assert!(half > 0);
        let back = &lengths[half..];
        assert!(lengths.iter().all(|l| back.iter().any(|b| (b - l).abs() < 1e-12)), "{lengths:?}");
    }

    #[test]
    fn what_is_not_on_the_gathered_seam_keeps_its_size() {
        let (garment, plain) = (gathered(), dress::garment());
        let inner = |g: &Garment| {
            let free = |t: &&[u32; 3]| !t.iter().any(|v| g.seams[0].pairs.iter().any(|p| p.contains(v)));
            g.triangles.iter().position(|t| free(&t))
        };
        let k = inner(&garment).unwrap_or_default();
        let area = |c: &[Point2; 3]| (c[1] - c[0]).perp(&(c[2] - c[0])) / 2.0;
        let cut = plain.triangles[k].map(|v| plain.rest[v as usize]);
        assert!((area(&corners(&garment).unwrap()[k]) - 4.0 * area(&cut)).abs() < 1e-12);
    }
}

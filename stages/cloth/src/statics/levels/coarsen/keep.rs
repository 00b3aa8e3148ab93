//! Which vertices a coarser level keeps: a maximal independent set, corners and pins first, then
//! outlines, then the inside. Cost: O(n).

use super::{CoarseningMesh, Pieces};

/// Cosine of the turn of an outline above which a vertex is a corner: 20 degrees.
const CORNER_COSINE: f64 = 0.94;

/// Which sewn points are kept: no two of them neighbours, except those that must be.
pub(super) fn independent(fine: &Pieces, mesh: &CoarseningMesh) -> Vec<bool> {
    let must: Vec<bool> = (0..fine.points).map(|p| must_keep(p, fine, mesh)).collect();
    let mut keep = must.clone();
    let mut near = vec![false; fine.points];
    let block = |p: usize, near: &mut [bool]| {
        for &v in &mesh.members[p] {
            mesh.neighbours(v).iter().for_each(|&w| near[fine.point[w as usize] as usize] = true);
        }
    };
    (0..fine.points).filter(|&p| must[p]).for_each(|p| block(p, &mut near));
    let outline = |p: &usize| mesh.members[*p].iter().any(|&v| mesh.on_outline[v as usize]);
    let inside = |p: &usize| !outline(p);
    for p in outline_order(fine, mesh, &must).into_iter().chain((0..fine.points).filter(inside)) {
        if !near[p] && !keep[p] {
            keep[p] = true;
            block(p, &mut near);
        }
    }
    keep
}

/// The points of the outlines in their order along them, so that every second one is kept.
fn outline_order(fine: &Pieces, mesh: &CoarseningMesh, must: &[bool]) -> Vec<usize> {
    let mut seen = vec![false; fine.points];
    let mut order = Vec::new();
    let starts = (0..fine.rest.len()).filter(|&v| mesh.on_outline[v]);
    let (first, then): (Vec<usize>, Vec<usize>) = starts.partition(|&v| must[fine.point[v] as usize]);
    for start in first.into_iter().chain(then) {
        let mut at = start;
        loop {
            let p = fine.point[at] as usize;
            if std::mem::replace(&mut seen[p], true) && at != start {
                break;
            }
            order.push(p);
            let open = |w: &&u32| !seen[fine.point[**w as usize] as usize];
            match mesh.outline[at].as_ref().and_then(|ends| ends.iter().find(open)) {
                Some(&next) => at = next as usize,
                None => break,
            }
        }
    }
    order
}

fn must_keep(p: usize, fine: &Pieces, mesh: &CoarseningMesh) -> bool {
    let sewn = |v: u32| mesh.members[fine.point[v as usize] as usize].len();
    mesh.members[p].iter().any(|&v| {
        let i = v as usize;
        if fine.pinned[i] {
            return true;
        }
        if !mesh.on_outline[i] {
            return false;
        }
        let Some([a, b]) = mesh.outline[i] else { return true };
        let (from, to) = (fine.rest[i] - fine.rest[a as usize], fine.rest[b as usize] - fine.rest[i]);
        let turns = from.dot(&to) < CORNER_COSINE * from.norm() * to.norm();
        // The ends of a seam are kept, where its two sides separate.
        turns || sewn(a) != sewn(v) || sewn(b) != sewn(v)
    })
}

//! Seams of the cut garment: new vertices are paired where both sides of a seam run along an edge.

use super::cut::GarmentCut;
use super::edges::Edges;
use std::collections::{BTreeMap, BTreeSet};
use toile_core::artifact::join_pairs;
use toile_core::prelude::*;

/// Edges between two looks at the stop flag.
const CHECK_EVERY: usize = 100_000;

/// A vertex and the edge on the way to it; none where it is the same vertex.
type Way = (u32, Option<usize>);

/// The seams with the pairs of new vertices among the old ones, in order along the seam.
pub(super) fn seams(
    garment: &Garment,
    edges: &Edges,
    cut: &GarmentCut<'_>,
    cx: &Context,
) -> Result<Vec<GarmentSeam>, StageError> {
    let ways = ways(garment, edges, cx)?;
    let sewn = |seam: &GarmentSeam| {
        cx.check()?;
        let pairs = Sides { pairs: &seam.pairs, edges, cut, ways: &ways }.sewn();
        Ok(GarmentSeam { name: seam.name.clone(), kind: seam.kind, pairs, state: seam.state })
    };
    garment.seams.iter().map(sewn).collect()
}

/// From the vertices of seams, the edges to other such vertices and those along the border.
fn ways(garment: &Garment, edges: &Edges, cx: &Context) -> Result<BTreeMap<u32, Vec<Way>>, StageError> {
    let mut ways: BTreeMap<u32, Vec<Way>> =
        garment.seams.iter().flat_map(|s| s.pairs.iter().flatten()).map(|v| (*v, Vec::new())).collect();
    for (e, &[a, b]) in edges.ends.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            cx.check()?;
        }
        if edges.is_border[e] || (ways.contains_key(&a) && ways.contains_key(&b)) {
            for (from, to) in [(a, b), (b, a)] {
                ways.entry(from).and_modify(|onward| onward.push((to, Some(e))));
            }
        }
    }
    Ok(ways)
}

/// Both sides of one seam.
struct Sides<'a> {
    pairs: &'a [[u32; 2]],
    edges: &'a Edges,
    cut: &'a GarmentCut<'a>,
    ways: &'a BTreeMap<u32, Vec<Way>>,
}

impl Sides<'_> {
    /// The pairs of the cut garment.
    fn sewn(&self) -> Vec<[u32; 2]> {
        // Backwards, so that a pair is known by the first place that it has.
        let known: BTreeMap<[u32; 2], usize> =
            self.pairs.iter().enumerate().rev().map(|(i, p)| (*p, i)).collect();
        let (mut sewn, mut done) = (Vec::new(), BTreeSet::new());
        for (i, pair) in self.pairs.iter().enumerate() {
            let own = known[pair];
            sewn.push(pair.map(|v| self.cut.kept[v as usize] as u32));
            // Those on the way to the next pair come last, so that what is in order stays so.
            let mut last = Vec::new();
            for ways in self.from(*pair) {
                let to = ways.map(|w| w.0);
                let new = match known.get(&to) {
                    Some(&j) => self.runs_along(i, to, ways) && done.insert((own.min(j), own.max(j))),
                    None => self.ends_in_tip(ways) && own == i,
                };
                match new {
                    true if self.pairs.get(i + 1) == Some(&to) => last.extend(self.between(*pair, ways)),
                    true => sewn.extend(self.between(*pair, ways)),
                    false => {}
                }
            }
            sewn.append(&mut last);
        }
        sewn
    }

    /// Where an edge leads from a pair, on one side or on both.
    fn from(&self, [a, b]: [u32; 2]) -> impl Iterator<Item = [Way; 2]> {
        let onward = |v: u32| self.ways.get(&v).into_iter().flatten().copied();
        let both = onward(a).flat_map(move |wa| onward(b).map(move |wb| [wa, wb]));
        let first = onward(a).map(move |wa| [wa, (b, None)]);
        both.chain(first).chain(onward(b).map(move |wb| [(a, None), wb]))
    }

    /// The seam follows these edges from its pair `i`: they are borders, or the pairs are
    /// neighbours in it. Elsewhere an edge cuts the corner of the seam.
    fn runs_along(&self, i: usize, to: [u32; 2], ways: [Way; 2]) -> bool {
        let near = |k: Option<usize>| k.and_then(|k| self.pairs.get(k)) == Some(&to);
        near(i.checked_add(1)) || near(i.checked_sub(1)) || self.are_borders(ways)
    }

    /// Both legs of a dart end in one vertex, which is no pair.
    fn ends_in_tip(&self, ways: [Way; 2]) -> bool {
        let [(a, on_a), (b, on_b)] = ways;
        a == b && on_a.is_some() && on_b.is_some() && on_a != on_b && self.are_borders(ways)
    }

    fn are_borders(&self, ways: [Way; 2]) -> bool {
        ways.iter().filter_map(|w| w.1).all(|e| self.edges.is_border[e])
    }

    /// The pairs of new vertices from a pair of the seam to where the edges lead.
    fn between(&self, pair: [u32; 2], ways: [Way; 2]) -> impl Iterator<Item = [u32; 2]> {
        let at = move |side: usize, k: usize| match ways[side].1 {
            Some(edge) => self.cut.along(edge, pair[side], k),
            None => self.cut.kept[pair[side] as usize] as u32,
        };
        (1..self.cut.parts).map(move |k| [at(0, k), at(1, k)]).filter(|p| p[0] != p[1])
    }
}

/// Joins the pairs of closed seams: new vertices lie where the least old one does, or else the
/// least new one.
pub(super) fn join(fine: &mut Garment, cut: &GarmentCut<'_>) {
    let closed = fine.seams.iter().filter(|s| s.state == SeamState::Closed);
    join_pairs(&mut fine.weld, closed.flat_map(|s| &s.pairs));
    let mut place: Vec<usize> = fine.weld.iter().map(|w| *w as usize).collect();
    let mut is_new = vec![true; place.len()];
    for &v in cut.kept.iter().rev() {
        place[fine.weld[v] as usize] = v;
        is_new[v] = false;
    }
    for v in (0..is_new.len()).filter(|v| is_new[*v]) {
        let at = place[fine.weld[v] as usize];
        fine.positions[v] = fine.positions[at];
        fine.velocities[v] = fine.velocities[at];
    }
}

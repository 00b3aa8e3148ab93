//! Boundary loops of panels: chains of sides that one triangle alone has.

use std::collections::BTreeMap;
use toile_core::artifact::{Garment, polygon_area};

/// The loops of a panel, each as its vertices in the way of its triangles.
pub(crate) fn of_panel(garment: &Garment, panel: usize) -> Vec<Vec<u32>> {
    of_triangles(&garment.triangles[garment.panels[panel].triangles.clone()])
}

/// The loops of triangles; the order depends on them alone.
pub(crate) fn of_triangles(triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut sides: Vec<(u32, u32, u32, u32)> = triangles
        .iter()
        .flat_map(|t| (0..3).map(move |k| (t[k], t[(k + 1) % 3])))
        .map(|(a, b)| (a.min(b), a.max(b), a, b))
        .collect();
    sides.sort_unstable();
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for alone in sides.chunk_by(|s, t| (s.0, s.1) == (t.0, t.1)).filter(|c| c.len() == 1) {
        next.entry(alone[0].2).or_default().push(alone[0].3);
    }
    let mut loops = Vec::new();
    while let Some((&first, _)) = next.iter().find(|(_, to)| !to.is_empty()) {
        let (mut ring, mut at) = (Vec::new(), first);
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            ring.push(at);
            at = to;
            if at == first {
                break;
            }
        }
        next.retain(|_, to| !to.is_empty());
        loops.push(ring);
    }
    loops
}

/// The outer loop of a panel: that around the largest flat area, else the longest.
pub(crate) fn outer(garment: &Garment, panel: usize) -> Vec<u32> {
    let size = |ring: &Vec<u32>| {
        let flat: Vec<_> = ring.iter().map(|v| garment.rest[*v as usize]).collect();
        polygon_area(&flat).abs()
    };
    let larger = |a: Vec<u32>, b: Vec<u32>| {
        if (size(&b), b.len()) > (size(&a), a.len()) { b } else { a }
    };
    of_panel(garment, panel).into_iter().reduce(larger).unwrap_or_default()
}

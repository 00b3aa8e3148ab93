//! The parts of a garment: what seams hold together. Parts that started edge to edge and have come
//! apart are a fault, whoever named the seams.
//!
//! Method: panels that a seam or a joined vertex connects are one part. Of two parts, the edges
//! that no seam takes and that started near each other must still be near. Cost: the free edges of
//! two parts times each other.

use std::collections::BTreeSet;
use toile_core::artifact::{Garment, Shortfall, quantile};
use toile_core::prelude::*;

/// Edges that start nearer to each other than this were to be one, metres.
const NEAR: f64 = 0.06;
/// And have come apart where they end farther from each other than this, metres.
const APART: f64 = 0.12;
/// Two parts started edge to edge where this share of the free edge of either did.
const EDGE: f64 = 0.25;

/// For each panel the number of its part, counted from 0 in the order of the panels.
pub(super) fn parts(garment: &Garment) -> Vec<usize> {
    let n = garment.panels.len();
    let panel = |v: u32| garment.panels.iter().position(|p| p.vertices.contains(&(v as usize)));
    let mut part: Vec<usize> = (0..n).collect();
    let mut join = |a: u32, b: u32| {
        if let (Some(a), Some(b)) = (panel(a), panel(b))
            && part[a] != part[b]
        {
            let (from, to) = (part[a].max(part[b]), part[a].min(part[b]));
            part.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
        }
    };
    garment.seams.iter().filter_map(|s| s.pairs.first()).for_each(|p| join(p[0], p[1]));
    let welded = garment.weld.iter().enumerate().filter(|(v, w)| *v != **w as usize);
    // Of the many vertices of a seam one is enough.
    let mut seen = BTreeSet::new();
    for (v, w) in welded {
        if let (Some(a), Some(b)) = (panel(v as u32), panel(*w))
            && a != b
            && seen.insert([a, b])
        {
            join(v as u32, *w);
        }
    }
    part
}

/// The names of the panels of a part: `"front" and "back"`.
pub(super) fn named(garment: &Garment, part: &[usize], k: usize) -> String {
    let names: Vec<String> = garment
        .panels
        .iter()
        .zip(part)
        .filter(|(_, p)| **p == k)
        .map(|(p, _)| format!("\"{}\"", p.name))
        .collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) if names.len() <= 3 => format!("{} and {last}", before.join(", ")),
        Some(_) => format!("{} and {} more", names[..2].join(", "), names.len() - 2),
        None => "nothing".to_owned(),
    }
}

/// The limit that is missed where two parts of a garment have come apart that started edge to edge.
pub(super) fn come_apart(start: &Garment, garment: &Garment) -> Option<Shortfall> {
    if start.positions.len() != garment.positions.len() {
        return None;
    }
    let part = parts(garment);
    let numbers: BTreeSet<usize> = part.iter().copied().collect();
    if numbers.len() < 2 {
        return None;
    }
    let free = |k: usize| free_edge(garment, &part, k);
    let all: Vec<(usize, Vec<u32>)> = numbers.into_iter().map(|k| (k, free(k))).collect();
    let mut worst: Option<(f64, usize, usize)> = None;
    for (i, (a, edge)) in all.iter().enumerate() {
        for (b, other) in &all[i + 1..] {
            let far = apart(start, garment, edge, other).or_else(|| apart(start, garment, other, edge));
            if let Some(far) = far.filter(|far| worst.is_none_or(|w| *far > w.0)) {
                worst = Some((far, *a, *b));
            }
        }
    }
    let (far, a, b) = worst?;
    let message = format!(
        "{} and {} started edge to edge and have come apart by {:.0} cm: no seam joins them; add a seam between them",
        named(garment, &part, a),
        named(garment, &part, b),
        far * 1e2
    );
    Some(Shortfall { code: ErrorCode::StitchingError, message })
}

/// The vertices along edges of a part that no seam takes.
fn free_edge(garment: &Garment, part: &[usize], k: usize) -> Vec<u32> {
    let sewn: BTreeSet<u32> = garment.seams.iter().flat_map(|s| s.pairs.iter().flatten().copied()).collect();
    let mine = garment.panels.iter().zip(part).filter(|(_, p)| **p == k);
    mine.flat_map(|(p, _)| &p.boundary).copied().filter(|v| !sewn.contains(v)).collect()
}

/// How far an edge has come (its median) from another one that a quarter of it started near to;
/// none where it did not, or is still near.
fn apart(start: &Garment, end: &Garment, edge: &[u32], other: &[u32]) -> Option<f64> {
    let distance = |g: &Garment, v: u32| {
        let p = g.positions[v as usize];
        other
            .iter()
            .map(|w| (p - g.positions[*w as usize]).norm_squared())
            .fold(f64::INFINITY, f64::min)
            .sqrt()
    };
    let near: Vec<u32> = edge.iter().copied().filter(|v| distance(start, *v) < NEAR).collect();
    if near.is_empty() || (near.len() as f64) < EDGE * edge.len() as f64 {
        return None;
    }
    let mut now: Vec<f64> = near.iter().map(|v| distance(end, *v)).collect();
    now.sort_by(f64::total_cmp);
    let far = quantile(&now, 0.5);
    (far > APART).then_some(far)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use toile_fixtures::cloth::{ClothGrid, garment, plain};

    /// A band over a skirt, 20 cm wide each, with a centimetre between them.
    fn two() -> Garment {
        let lift = |p: Point2| Point3::new(0.2 * p.x, 0.2 * p.y, 0.0);
        let grid = ClothGrid { columns: 8, rows: 4, flat: Point2::new, lift };
        let mut both = garment(&[("skirt", &grid), ("band", &grid)], &plain(500.0, 50.0, 1e-5));
        let band = both.panels[1].vertices.clone();
        both.positions[band].iter_mut().for_each(|p| p.y += 0.21);
        both
    }

    #[test]
    fn parts_that_started_edge_to_edge_must_end_so() {
        let start = two();
        assert_eq!(parts(&start), [0, 1]);
        assert_eq!(come_apart(&start, &start), None);
        let mut end = start.clone();
        end.positions[end.panels[0].vertices.clone()].iter_mut().for_each(|p| p.y -= 0.6);
        assert_eq!(
            come_apart(&start, &end).unwrap().message,
            "\"skirt\" and \"band\" started edge to edge and have come apart by 61 cm: no seam joins them; add a seam between them"
        );
        // Two that never touched, as a shirt and its hat, may do as they like.
        let mut far = start.clone();
        far.positions[start.panels[1].vertices.clone()].iter_mut().for_each(|p| p.y += 0.5);
        assert_eq!(come_apart(&far, &end), None);
    }

    #[test]
    fn what_a_seam_joins_is_one_part() {
        let mut sewn = two();
        let (top, low) = (sewn.panels[0].vertices.end as u32 - 1, sewn.panels[1].vertices.start as u32);
        sewn.seams.push(GarmentSeam {
            name: "skirt.top + band.low".into(),
            kind: SeamKind::Matched,
            pairs: vec![[top, low]],
            state: SeamState::Closed,
        });
        assert_eq!(parts(&sewn), [0, 0]);
        assert_eq!(named(&sewn, &parts(&sewn), 0), "\"skirt\" and \"band\"");
    }
}

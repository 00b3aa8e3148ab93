//! Checks the start for cloth that intersects or lies in cloth. Cost: O(n log n).

use super::StartError;
use crate::error::ClothError;
use crate::scene::Scene;
use crate::statics::forces::self_contact::{MERGED, SelfContact};
use crate::statics::levels::assemble::cloths;
use crate::statics::levels::pieces::Pieces;
use crate::statics::report::words;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{Vec3, cloth_tree::ClothTree};

/// Share of a panel's area that may lie in cloth at the start: panels that touch along a line or
/// overlap a little can be separated.
const MOST_LYING: f64 = 0.05;

/// An edge and the triangle that it passes through.
type Crossing = ([u32; 2], [u32; 3]);

/// Crossings of a level before it is sewn that no order of layers resolves; empty where they do not
/// matter.
pub(crate) fn crossings_at_start(
    scene: &Scene,
    pieces: &Pieces,
    start: &[Vec3],
) -> Result<Vec<Crossing>, ClothError> {
    if !scene.self_collision {
        return Ok(vec![]);
    }
    let sheet = pieces.open_sheet(&cloths(scene))?;
    let tree = ClothTree::new(sheet.triangles(), start).sewing(pieces.point.clone());
    let layer = |&p: &u32| (p as usize).checked_sub(1).map_or(0, |k| scene.panels[k].layer);
    let self_contact =
        SelfContact { order: pieces.panel.iter().map(layer).collect(), ..SelfContact::default() };
    let found = crossings(&tree, &pieces.panel, start);
    Ok(found.into_iter().filter(|(e, t)| !self_contact.is_ordered(e, t)).collect())
}

/// How far panels are moved to test whether they cross where a vertex of one lies in another, m:
/// more than the rounding of positions.
const NUDGE: f64 = 1e-7;

/// Crossings, with those of panels that pass through each other exactly at vertices or along edges,
/// as panels of one grid do. Such panels cross whichever way they are moved a little, while panels
/// that only touch separate one way.
pub(crate) fn crossings(tree: &ClothTree, panel: &[u32], x: &[Vec3]) -> Vec<Crossing> {
    let found = tree.crossings(x);
    if !found.is_empty() || panel.iter().all(|p| *p == panel[0]) {
        return found;
    }
    // Multiples of irrational numbers, so that any two panels are moved differently.
    let way = |k: u32| Vector3::new(0.819, 0.671, 0.549).map(|r: f64| (r * f64::from(k)).fract() * NUDGE);
    let moved = |side: f64| -> Vec<Vec3> { x.iter().zip(panel).map(|(p, k)| p + way(*k) * side).collect() };
    let panels = |(e, t): &Crossing| sorted([e[0], t[0]].map(|v| panel[v as usize]));
    let mut ahead = tree.crossings(&moved(1.0));
    if !ahead.is_empty() {
        let behind: BTreeSet<[u32; 2]> = tree.crossings(&moved(-1.0)).iter().map(panels).collect();
        ahead.retain(|c| behind.contains(&panels(c)));
    }
    ahead
}

/// The error of crossings at the start, which names the panels; `None` without crossings.
pub(crate) fn crossing(
    scene: &Scene,
    panel: &[u32],
    start: &[Vec3],
    crossings: &[Crossing],
) -> Option<StartError> {
    let mut found: BTreeMap<[u32; 2], (usize, [u32; 2])> = BTreeMap::new();
    for (e, t) in crossings {
        found.entry(sorted([e[0], t[0]].map(|v| panel[v as usize]))).or_insert((0, *e)).0 += 1;
    }
    let (panels, (pairs, e)) = most(&found, |(count, _)| *count as f64)?;
    Some(StartError::Crossing {
        panels: panels.map(|p| words::panel(scene, p)),
        pairs,
        at: (start[e[0] as usize] + start[e[1] as usize]) * 0.5,
        more: found.len() - 1,
    })
}

/// Refuses a panel if a large part of it is so narrow that vertices lie in the opposite edges.
pub(super) fn check_squeezed(
    scene: &Scene,
    pieces: &Pieces,
    start: &[Vec3],
    thickness: f64,
) -> Result<(), StartError> {
    let within = MERGED * thickness;
    let flat = |v: u32| pieces.rest[v as usize].push(0.0);
    let placed = |v: u32| start[v as usize];
    let mut areas = vec![0.0; scene.panels.len() + 1];
    let mut found: BTreeMap<u32, (f64, [u32; 3], [f64; 2])> = BTreeMap::new();
    for t in &pieces.triangles {
        let panel = pieces.panel[t[0] as usize];
        let (area, cut) = area_and_height(&t.map(flat));
        areas[panel as usize] += area;
        let height = area_and_height(&t.map(placed)).1;
        if height < within && cut > within {
            found.entry(panel).or_insert((0.0, *t, [height, cut])).0 += area;
        }
    }
    let much = found.into_iter().find(|(panel, (area, ..))| *area > MOST_LYING * areas[*panel as usize]);
    much.map_or(Ok(()), |(panel, (area, t, [height, cut]))| {
        Err(StartError::Squeezed {
            panel: words::panel(scene, panel),
            share: area / areas[panel as usize],
            at: t.iter().map(|&v| placed(v)).sum::<Vec3>() / 3.0,
            height,
            cut,
        })
    })
}

/// The area of a triangle, m², and its height over its longest side, m.
fn area_and_height([a, b, c]: &[Vec3; 3]) -> (f64, f64) {
    let area = 0.5 * (b - a).cross(&(c - a)).norm();
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    (area, 2.0 * area / longest.max(f64::MIN_POSITIVE))
}

/// Refuses cloth if a large part of it lies in cloth: then neither contact nor collision detection
/// can determine which side each belongs to.
pub(super) fn check_lying(
    scene: &Scene,
    pieces: &Pieces,
    tree: &ClothTree,
    start: &[Vec3],
    thickness: f64,
) -> Result<(), StartError> {
    let within = MERGED * thickness;
    let mut areas = vec![0.0; scene.panels.len() + 1];
    let area = |t: &[u32; 3]| area_and_height(&t.map(|v| start[v as usize])).0;
    let panel = |t: &[u32; 3]| pieces.panel[t[0] as usize];
    pieces.triangles.iter().for_each(|t| areas[panel(t) as usize] += area(t));
    let mut lying = tree.lying(start, within);
    // A triangle counts once for each panel that it lies in.
    lying.dedup_by_key(|(s, t)| (*s, panel(t)));
    let mut found: BTreeMap<[u32; 2], (f64, [u32; 3])> = BTreeMap::new();
    for (s, t) in &lying {
        let [own, other] = [panel(s), panel(t)];
        found.entry([own, other]).or_insert((0.0, *s)).0 += area(s) / areas[own as usize];
    }
    found.retain(|_, (share, _)| *share > MOST_LYING);
    let Some((panels, (share, s))) = most(&found, |(share, _)| *share) else { return Ok(()) };
    let mut pairs: Vec<[u32; 2]> = found.keys().map(|p| sorted(*p)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    Err(StartError::Lying {
        panels: panels.map(|p| words::panel(scene, p)),
        share,
        within,
        thickness,
        at: s.iter().map(|&v| start[v as usize]).sum::<Vec3>() / 3.0,
        more: pairs.len() - 1,
    })
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The most frequent entry; the first one of equals.
fn most<T: Copy>(found: &BTreeMap<[u32; 2], T>, much: impl Fn(&T) -> f64) -> Option<([u32; 2], T)> {
    let more = |best: Option<([u32; 2], T)>, (panels, what): (&[u32; 2], &T)| match best {
        Some(best) if much(&best.1) >= much(what) => Some(best),
        _ => Some((*panels, *what)),
    };
    found.iter().fold(None, more)
}

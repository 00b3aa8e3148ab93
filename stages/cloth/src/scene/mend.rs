//! Repairs the cloth of a scene that was read, and reports what is unusual.
//!
//! Triangles listed twice are dropped. Coincident vertices that are not joined are reported, or
//! joined on request; a panel of separate faces is refused, for it would come apart. Pieces of a
//! panel that nothing sews together are reported. A vertex without a triangle is pinned. Cost: O(n
//! log n).

use super::{Scene, SceneError, Seam};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::components::{groups, links};
use toile_geometry::obj::{JOIN, first_of_each, joined};

/// Triangles of a face by itself: a quad has two.
const FACE: usize = 2;

/// How many vertices a sentence names.
const NAMED: usize = 5;

/// The seam that joins what was welded.
const WELD: &str = "weld";

/// Repairs what can be repaired; returns a sentence for each repair or finding.
pub(super) fn mend(scene: &mut Scene, weld: bool) -> Result<Vec<String>, SceneError> {
    for (second, panel) in scene.panels.iter().enumerate() {
        if let Some(first) = scene.panels[..second].iter().position(|p| p.name == panel.name) {
            return Err(SceneError::PanelTwice { name: panel.name.clone(), first, second });
        }
    }
    let mut told = Vec::new();
    told.extend(drop_doubled(scene));
    told.extend(hold_unused(scene));
    told.extend(coincident(scene, weld)?);
    told.extend(loose(scene));
    Ok(told)
}

/// Drops triangles that name the vertices of an earlier one.
fn drop_doubled(scene: &mut Scene) -> Option<String> {
    let kept = first_of_each(&scene.triangles);
    let dropped: Vec<usize> = (0..scene.triangles.len()).filter(|t| kept.binary_search(t).is_err()).collect();
    let first = *dropped.first()?;
    let before = |t: usize| kept.partition_point(|k| *k < t);
    scene.panels.iter_mut().for_each(|p| p.triangles = before(p.triangles.start)..before(p.triangles.end));
    let t = scene.triangles[first];
    scene.triangles = kept.iter().map(|&t| scene.triangles[t]).collect();
    Some(format!(
        "{} left out: triangle {first} of vertices {}, {} and {}{}",
        counted(dropped.len(), "triangle that is listed twice is", "triangles that are listed twice are"),
        t[0],
        t[1],
        t[2],
        if dropped.len() > 1 { " is the first" } else { "" }
    ))
}

/// Pins vertices that belong to no triangle, unless they are sewn.
fn hold_unused(scene: &mut Scene) -> Option<String> {
    let mut held = vec![false; scene.rest.len()];
    let sewn = scene.seams.iter().flat_map(|s| &s.pairs).flatten();
    scene.triangles.iter().flatten().chain(&scene.pinned).chain(sewn).for_each(|&v| held[v as usize] = true);
    let unused: Vec<u32> = (0..held.len() as u32).filter(|v| !held[*v as usize]).collect();
    if unused.is_empty() {
        return None;
    }
    scene.pinned.extend(&unused);
    scene.pinned.sort_unstable();
    let count = counted(
        unused.len(),
        "vertex belongs to no triangle and stays where it starts",
        "vertices belong to no triangle and stay where they start",
    );
    Some(format!("{count}: {}", listed(&unused)))
}

/// Joins coincident vertices, or reports them.
fn coincident(scene: &mut Scene, weld: bool) -> Result<Option<String>, SceneError> {
    let n = scene.rest.len();
    let mut takes_part = vec![false; n];
    scene.triangles.iter().flatten().for_each(|&v| takes_part[v as usize] = true);
    let flat: Vec<Vector3<f64>> = scene.rest.iter().map(|p| Vector3::new(p.x, p.y, 0.0)).collect();
    let [at, cut] = [&scene.positions, &flat].map(|p| joined(p, &takes_part, JOIN * extent(p, &takes_part)));
    let (sewn, _) = groups(n, scene.seams.iter().flat_map(|s| &s.pairs).copied());
    let panel = |v: u32| scene.panels.iter().position(|p| p.vertices.contains(&(v as usize)));
    let mut first: BTreeMap<(u32, u32, Option<usize>), u32> = BTreeMap::new();
    let (mut unjoined, mut touching): (Vec<[u32; 2]>, Vec<[u32; 2]>) = (vec![], vec![]);
    for v in (0..n as u32).filter(|v| takes_part[*v as usize]) {
        let i = v as usize;
        let one = *first.entry((at[i], cut[i], panel(v))).or_insert(v);
        if sewn[one as usize] != sewn[i] {
            unjoined.push([one, v]);
        } else if one == v && sewn[at[i] as usize] != sewn[i] {
            touching.push([at[i], v]);
        }
    }
    if weld && unjoined.is_empty() {
        return Ok(Some("`weld` has nothing to join: no vertices of a panel lie on each other".into()));
    }
    if weld {
        let told = counted(
            unjoined.len(),
            "vertex is joined to one that it lies on",
            "vertices are joined to others that they lie on",
        );
        scene.seams.push(Seam::new(free_name(scene), unjoined));
        return Ok(Some(told));
    }
    check_faces(scene, &unjoined)?;
    let mut told = Vec::new();
    if let Some([a, v]) = unjoined.first() {
        let count = counted(
            unjoined.len(),
            "vertex lies on another of its panel, flat and at the start, without being joined to it",
            "vertices lie on others of their panels, flat and at the start, without being joined to them",
        );
        told.push(format!("{count} (the first: {v} on {a}); `weld: true` joins them"));
    }
    if let Some([a, v]) = touching.first() {
        let count = counted(
            touching.len(),
            "vertex starts at the place of another without being sewn to it",
            "vertices start at the places of others without being sewn to them",
        );
        told.push(format!("{count} (the first: {v} on {a})"));
    }
    Ok((!told.is_empty()).then(|| told.join("; ")))
}

/// Refuses a panel whose faces mostly lie beside each other without sharing vertices.
fn check_faces(scene: &Scene, unjoined: &[[u32; 2]]) -> Result<(), SceneError> {
    let (piece, count) = pieces(scene);
    let mut triangles = vec![0; count];
    scene.triangles.iter().for_each(|t| triangles[piece[t[0] as usize] as usize] += 1);
    let is_unjoined: BTreeSet<u32> = unjoined.iter().map(|p| p[1]).collect();
    for panel in &scene.panels {
        let own = &scene.triangles[panel.triangles.clone()];
        let by_itself = |t: &&[u32; 3]| triangles[piece[t[0] as usize] as usize] <= FACE;
        let alone: BTreeSet<u32> = own.iter().filter(by_itself).map(|t| piece[t[0] as usize]).collect();
        let coincident = panel.vertices.clone().filter(|v| is_unjoined.contains(&(*v as u32))).count();
        if alone.len() > 1 && 2 * own.iter().filter(by_itself).count() > own.len() && coincident > 0 {
            return Err(SceneError::Unmerged {
                panel: panel.name.clone(),
                faces: alone.len(),
                vertices: panel.vertices.len(),
                coincident,
            });
        }
    }
    Ok(())
}

/// Reports panels that fall into pieces.
fn loose(scene: &Scene) -> Option<String> {
    let seams = scene.seams.iter().flat_map(|s| &s.pairs).copied();
    let sides = links(&scene.triangles);
    let (cloth, _) = groups(scene.rest.len(), sides.chain(seams));
    let apart = |p: &super::Panel| {
        let own = &scene.triangles[p.triangles.clone()];
        own.iter().map(|t| cloth[t[0] as usize]).collect::<BTreeSet<_>>().len()
    };
    let told: Vec<String> = scene
        .panels
        .iter()
        .map(|p| (p, apart(p)))
        .filter(|(_, n)| *n > 1)
        .map(|(p, n)| {
            format!("panel '{}' is {n} pieces that neither triangles nor seams hold together", p.name)
        })
        .collect();
    (!told.is_empty()).then(|| told.join("; "))
}

/// The piece of each vertex, by triangles alone, and how many there are.
fn pieces(scene: &Scene) -> (Vec<u32>, usize) {
    groups(scene.rest.len(), links(&scene.triangles))
}

/// The diagonal of the box around the points that take part.
fn extent(points: &[Vector3<f64>], takes_part: &[bool]) -> f64 {
    let part = points.iter().zip(takes_part).filter(|(_, takes)| **takes).map(|(p, _)| (*p, *p));
    part.reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1))).map_or(0.0, |(low, high)| (high - low).norm())
}

/// `weld`, or `weld 2` where a seam has that name.
fn free_name(scene: &Scene) -> String {
    let is_free = |name: &String| scene.seams.iter().all(|s| s.name != *name);
    let names = std::iter::once(WELD.into()).chain((2..).map(|k| format!("{WELD} {k}")));
    names.take(scene.seams.len() + 1).find(is_free).unwrap_or_else(|| WELD.into())
}

fn counted(n: usize, one: &str, many: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {many}") }
}

fn listed(vertices: &[u32]) -> String {
    let names: Vec<String> = vertices.iter().take(NAMED).map(ToString::to_string).collect();
    let more = if vertices.len() > NAMED { ", ..." } else { "" };
    format!("{}{more}", names.join(", "))
}

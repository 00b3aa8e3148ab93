//! A garment from the mesh of a file alone: its panels, and its texture as their flat shape.

use super::segmentation::Segmentation;
use crate::subject::{PanelTriangles, garment_of};
use std::collections::{BTreeMap, HashMap};
use toile_core::artifact::{Garment, Pattern, Point2, Point3, polygon_area};
use toile_geometry::components::groups;
use toile_output::flat::FileMeshes;

/// Units of texture points, metres.
const UNITS: [f64; 5] = [1.0, 0.1, 0.01, 0.001, 0.0254];

/// Texture points are in a unit where the root of the flat area is that of the cloth within this
/// share.
const LIKE: f64 = 0.1;

/// The garment, and whether its flat shape is known.
pub(super) fn garment(
    meshes: &FileMeshes,
    labels: Option<&Segmentation>,
    pattern: Option<&Pattern>,
) -> (Garment, Result<(), String>) {
    let (of, count) = panels(meshes, labels);
    let names = names(meshes, labels, &of, count);
    let scale = scale(meshes, pattern, count);
    let mut cuts: Vec<PanelTriangles> = names
        .into_iter()
        .map(|name| PanelTriangles { name, triangles: Vec::new(), flat: Vec::new() })
        .collect();
    for (k, panel) in of.iter().enumerate() {
        let cut = &mut cuts[*panel as usize];
        cut.triangles.push(meshes.triangles[k]);
        if let (Ok(scale), Some(corners)) = (&scale, meshes.texture[k]) {
            cut.flat.push(corners.map(|p| Point2::new(p.x * scale.0, p.y * scale.1)));
        }
    }
    (garment_of(&meshes.positions, &cuts), scale.map(|_| ()))
}

/// For each triangle its panel, and how many there are.
fn panels(meshes: &FileMeshes, labels: Option<&Segmentation>) -> (Vec<u32>, usize) {
    let several = |of: &[u32]| of.windows(2).any(|w| w[0] != w[1]);
    let textured = !meshes.is_ours && meshes.texture.iter().all(Option::is_some);
    if textured {
        return islands(meshes);
    }
    if let Some(labels) = labels {
        return labelled(meshes, labels);
    }
    if several(&meshes.groups) || several(&meshes.materials) {
        let of = if several(&meshes.groups) { &meshes.groups } else { &meshes.materials };
        let mut number: BTreeMap<u32, u32> = BTreeMap::new();
        let mut of_first = |g: &u32| {
            let next = number.len() as u32;
            *number.entry(*g).or_insert(next)
        };
        let all = of.iter().map(&mut of_first).collect();
        return (all, number.len());
    }
    let pairs = sides(meshes, |t, k| {
        let (a, b) = (meshes.triangles[t][k], meshes.triangles[t][(k + 1) % 3]);
        [a.min(b), a.max(b), 0, 0, 0, 0].map(u64::from)
    });
    groups(meshes.triangles.len(), pairs.into_iter())
}

/// Islands of the texture: triangles that share a side and both its texture points.
fn islands(meshes: &FileMeshes) -> (Vec<u32>, usize) {
    let point = point_of(&meshes.positions);
    let pairs = sides(meshes, |t, k| {
        let next = (k + 1) % 3;
        let (a, b) = (point[meshes.triangles[t][k] as usize], point[meshes.triangles[t][next] as usize]);
        let texture = meshes.texture[t].unwrap_or_default();
        let at = |c: usize| [texture[c].x, texture[c].y].map(|x| (x + 0.0).to_bits());
        let ((a, p), (b, q)) = if a < b { ((a, at(k)), (b, at(next))) } else { ((b, at(next)), (a, at(k))) };
        [u64::from(a), u64::from(b), p[0], p[1], q[0], q[1]]
    });
    groups(meshes.triangles.len(), pairs.into_iter())
}

/// Panels by the names of vertices; a triangle of which all are sewn belongs to the neighbour that
/// is found first.
fn labelled(meshes: &FileMeshes, labels: &Segmentation) -> (Vec<u32>, usize) {
    let mut number: BTreeMap<&str, u32> = BTreeMap::new();
    let mut of: Vec<Option<u32>> = Vec::with_capacity(meshes.triangles.len());
    for t in &meshes.triangles {
        let next = number.len() as u32;
        of.push(labels.name(t).map(|name| *number.entry(name).or_insert(next)));
    }
    let pairs = sides(meshes, |t, k| {
        let (a, b) = (meshes.triangles[t][k], meshes.triangles[t][(k + 1) % 3]);
        [a.min(b), a.max(b), 0, 0, 0, 0].map(u64::from)
    });
    loop {
        let before = of.clone();
        for [a, b] in &pairs {
            for (one, other) in [(*a as usize, *b as usize), (*b as usize, *a as usize)] {
                if of[one].is_none() {
                    of[one] = before[other];
                }
            }
        }
        if of == before {
            break;
        }
    }
    // What no name reaches is a panel of its own.
    let rest = number.len() as u32;
    let bare = of.iter().any(Option::is_none);
    (of.into_iter().map(|k| k.unwrap_or(rest)).collect(), number.len() + usize::from(bare))
}

/// Vertices by the first at their place.
fn point_of(positions: &[Point3]) -> Vec<u32> {
    let mut first: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
    let least = |(v, p): (usize, &Point3)| {
        *first.entry([p.x, p.y, p.z].map(|c| (c + 0.0).to_bits())).or_insert(v as u32)
    };
    positions.iter().enumerate().map(least).collect()
}

/// Pairs of triangles with a side of one key.
fn sides(meshes: &FileMeshes, key: impl Fn(usize, usize) -> [u64; 6]) -> Vec<[u32; 2]> {
    let all = (0..meshes.triangles.len()).flat_map(|t| [0, 1, 2].map(|k| (t, k)));
    let mut keyed: Vec<([u64; 6], u32)> = all.map(|(t, k)| (key(t, k), t as u32)).collect();
    keyed.sort_unstable();
    keyed.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| [w[0].1, w[1].1]).collect()
}

/// Names by the labels of a panel's vertices, else by the group of its first triangle, else its
/// material, else by number; each once.
fn names(meshes: &FileMeshes, labels: Option<&Segmentation>, of: &[u32], count: usize) -> Vec<String> {
    let mut own: Vec<Vec<usize>> = vec![Vec::new(); count];
    of.iter().enumerate().for_each(|(t, panel)| own[*panel as usize].push(t));
    let label = |k: usize| {
        let triangles = own[k].iter().map(|t| &meshes.triangles[*t]);
        labels.and_then(|l| l.most(triangles)).map(str::to_owned)
    };
    let mut first: Vec<Option<usize>> = vec![None; count];
    for (t, panel) in of.iter().enumerate() {
        first[*panel as usize].get_or_insert(t);
    }
    let called = |t: usize| {
        let name = |list: &[String], of: &[u32]| {
            of.get(t)
                .and_then(|k| list.get(*k as usize))
                .map(|n| n.trim().to_owned())
                .filter(|n| !n.is_empty())
        };
        name(&meshes.names, &meshes.groups).or_else(|| name(&meshes.material_names, &meshes.materials))
    };
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let named = |(k, t): (usize, Option<usize>)| {
        let name = label(k).or_else(|| t.and_then(called)).unwrap_or_else(|| format!("piece_{}", k + 1));
        let times = seen.entry(name.clone()).or_insert(0);
        *times += 1;
        if *times == 1 { name } else { format!("{name}_{times}") }
    };
    first.into_iter().enumerate().map(named).collect()
}

/// What texture points are multiplied by, across and along, to be the flat shape in metres.
fn scale(meshes: &FileMeshes, pattern: Option<&Pattern>, panels: usize) -> Result<(f64, f64), String> {
    if !meshes.texture.iter().all(Option::is_some) {
        return Err(
            "the flat shape is not known: the garment's file has no texture points on all triangles".into()
        );
    }
    let flat = |[a, b, c]: &[Point2; 3]| (b - a).perp(&(c - a)) / 2.0;
    let corners = || meshes.texture.iter().flatten();
    let (whole, size) = (corners().map(flat).sum::<f64>(), corners().map(|t| flat(t).abs()).sum::<f64>());
    let mirrored = |s: f64| if whole < 0.0 { (-s, s) } else { (s, s) };
    let space = |t: &[u32; 3]| {
        let [p, q, r] = t.map(|v| meshes.positions[v as usize]);
        (q - p).cross(&(r - p)).norm() / 2.0
    };
    let cloth: f64 = meshes.triangles.iter().map(space).sum();
    if size <= 0.0 {
        return Err("the flat shape is not known: the texture points have no area".into());
    }
    let ratio = (cloth / size).sqrt();
    if let Some(unit) = UNITS.iter().find(|u| (ratio / **u - 1.0).abs() <= LIKE) {
        return Ok(mirrored(*unit));
    }
    match pattern {
        Some(pattern) if pattern.pieces.len() == panels => {
            let area = |p: &toile_core::artifact::Piece| {
                let holes = p.holes.iter().map(|h| polygon_area(&h.points().0).abs());
                polygon_area(&p.outer.points().0).abs() - holes.sum::<f64>()
            };
            Ok(mirrored((pattern.pieces.iter().map(area).sum::<f64>() / size).sqrt()))
        }
        Some(pattern) => Err(format!(
            "the flat shape is not known: the texture is in no unit of length, and has {panels} islands for {} pieces",
            pattern.pieces.len()
        )),
        None => Err("the flat shape is not known: the texture is in no unit of length; name the pattern with `--pattern`".into()),
    }
}

//! Mends what exporters leave behind: vertices split along the seams of a texture, triangles
//! without area, triangles listed twice, vertices that no face uses.
//!
//! Method: pieces that are closed as they stand are kept to the last bit. Vertices of the others
//! are joined where they lie within [`JOIN`] of the size of each other; then triangles that lost
//! their area go, and one that lies flat between three vertices in a line gives its long side to
//! its neighbour. Cost: O(n), and a sort of the edges.

use super::Mesh;
use super::pieces::{MeshPieces, directed, is_flat};
use crate::Vec3;
use std::collections::{BTreeMap, HashMap};

/// Distance within which vertices are one, as a share of the mesh's diagonal: the sixth digit of an
/// exporter.
pub const JOIN: f64 = 1e-6;

/// How often flat triangles are looked for: each time one of two that lie on each other goes.
const PASSES: usize = 8;

/// What was mended, in numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Vertices that were joined to others.
    pub joined: usize,
    /// Triangles without area that were taken away.
    pub without_area: usize,
    /// Triangles that repeat others.
    pub twice: usize,
    /// Vertices that no face of the file uses.
    pub unused: usize,
    /// Pieces that are open or enclose nothing, beside a larger one that is closed.
    pub open_pieces: usize,
    /// Pieces inside another that face inwards: the inner side of a wall.
    pub inner: usize,
    /// Pieces that faced inwards and were turned.
    pub turned: usize,
}

impl Repairs {
    /// What was mended in words; none where nothing was.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let tell = |n: usize, one: &str, many: &str| match n {
            0 => None,
            1 => Some(format!("1 {one}")),
            n => Some(format!("{n} {many}")),
        };
        let parts = [
            tell(
                self.joined,
                "vertex is joined to one at its place",
                "vertices are joined to others at their places",
            ),
            tell(self.without_area, "triangle without area is removed", "triangles without area are removed"),
            tell(
                self.twice,
                "triangle that is listed twice is removed",
                "triangles that are listed twice are removed",
            ),
            tell(
                self.unused,
                "vertex that no face uses is left out",
                "vertices that no face uses are left out",
            ),
            tell(self.open_pieces, "open piece is left out", "open pieces are left out"),
            tell(self.inner, "inner surface is left out", "inner surfaces are left out"),
            tell(self.turned, "piece is turned to face outwards", "pieces are turned to face outwards"),
        ];
        let told: Vec<String> = parts.into_iter().flatten().collect();
        (!told.is_empty()).then(|| told.join(", "))
    }
}

/// Mends a mesh; what is clean stays as it is, in its order.
#[must_use]
pub fn repair(mut mesh: Mesh) -> (Mesh, Repairs) {
    let mut repairs = Repairs { unused: unused(&mesh), ..Repairs::default() };
    drop_collapsed(&mut mesh, &mut repairs);
    drop_doubled(&mut mesh, &mut repairs);
    let pieces = MeshPieces::new(&mesh);
    let mut is_sound = pieces.closed.clone();
    for t in &mesh.triangles {
        is_sound[pieces.at(t)] &= !is_flat(t.map(|v| mesh.vertices[v as usize]));
    }
    let open = |v: &u32| !is_sound[pieces.of[*v as usize] as usize];
    if mesh.triangles.iter().any(|t| open(&t[0])) {
        let mut is_used = vec![false; mesh.vertices.len()];
        mesh.triangles.iter().flatten().filter(|v| open(v)).for_each(|&v| is_used[v as usize] = true);
        let first = joined(&mesh.vertices, &is_used, JOIN * mesh.size());
        repairs.joined = first.iter().enumerate().filter(|(v, f)| *v != **f as usize).count();
        mesh.triangles.iter_mut().for_each(|t| *t = t.map(|v| first[v as usize]));
        drop_collapsed(&mut mesh, &mut repairs);
        drop_doubled(&mut mesh, &mut repairs);
        unfold(&mut mesh, &mut repairs);
    }
    (without_unused(mesh), repairs)
}

fn is_used(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.vertices.len()];
    mesh.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    used
}

fn unused(mesh: &Mesh) -> usize {
    is_used(mesh).iter().filter(|u| !**u).count()
}

/// The mesh without vertices of no triangle, the others in their order.
pub(super) fn without_unused(mesh: Mesh) -> Mesh {
    let used = is_used(&mesh);
    if !used.contains(&false) {
        return mesh;
    }
    let mut number = vec![0; used.len()];
    let mut vertices = Vec::new();
    for (v, p) in mesh.vertices.iter().enumerate().filter(|(v, _)| used[*v]) {
        number[v] = vertices.len() as u32;
        vertices.push(*p);
    }
    let triangles = mesh.triangles.iter().map(|t| t.map(|v| number[v as usize])).collect();
    Mesh { vertices, triangles }
}

/// Drops triangles that name a vertex twice.
fn drop_collapsed(mesh: &mut Mesh, repairs: &mut Repairs) {
    let before = mesh.triangles.len();
    mesh.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    repairs.without_area += before - mesh.triangles.len();
}

/// Drops triangles that name the same vertices as others: of those that run both ways round, the
/// ones against their neighbours.
fn drop_doubled(mesh: &mut Mesh, repairs: &mut Repairs) {
    let kept = first_of_each(&mesh.triangles);
    repairs.twice += mesh.triangles.len() - kept.len();
    if kept.len() < mesh.triangles.len() {
        mesh.triangles = kept.iter().map(|&t| mesh.triangles[t]).collect();
    }
}

/// The triangles to keep where some are listed twice, in their order.
#[must_use]
pub fn first_of_each(triangles: &[[u32; 3]]) -> Vec<usize> {
    let key = |t: &[u32; 3]| {
        let mut key = *t;
        key.sort_unstable();
        key
    };
    let mut order: Vec<([u32; 3], usize)> = triangles.iter().enumerate().map(|(k, t)| (key(t), k)).collect();
    order.sort_unstable();
    let same = |a: &([u32; 3], usize), b: &([u32; 3], usize)| a.0 == b.0;
    let single = order.chunk_by(same).filter(|g| g.len() == 1).map(|g| triangles[g[0].1]);
    let mut beside: Vec<[u32; 2]> = Vec::new();
    if order.windows(2).any(|w| w[0].0 == w[1].0) {
        beside = directed(&single.collect::<Vec<_>>()).collect();
        beside.sort_unstable();
    }
    let has = |e: [u32; 2]| beside.binary_search(&e).is_ok();
    let fits = |t: &[u32; 3]| {
        let sides = (0..3).map(|k| [t[k], t[(k + 1) % 3]]);
        sides.map(|[a, b]| i32::from(has([b, a])) - i32::from(has([a, b]))).sum::<i32>()
    };
    let best = |group: &[([u32; 3], usize)]| {
        let better = |a: usize, b: usize| if fits(&triangles[b]) > fits(&triangles[a]) { b } else { a };
        group.iter().map(|g| g.1).reduce(better)
    };
    let mut kept: Vec<usize> = order.chunk_by(same).filter_map(best).collect();
    kept.sort_unstable();
    kept
}

/// For each vertex the first of those that lie within `reach` of it, itself where there is none or
/// it takes no part.
///
/// Method: a grid of cells four times as wide, so that few neighbours need a look.
#[must_use]
pub fn joined(points: &[Vec3], takes_part: &[bool], reach: f64) -> Vec<u32> {
    let mut first: Vec<u32> = (0..points.len() as u32).collect();
    if reach <= 0.0 {
        return first;
    }
    let part = || points.iter().zip(takes_part).filter(|(_, takes)| **takes).map(|(p, _)| *p);
    let corner = part().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let cell = |p: Vec3| ((p - corner) / (4.0 * reach)).map(|x| x.floor() as i64);
    // Only looked up, never walked through: its order does not matter.
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for v in (0..points.len()).filter(|v| takes_part[*v]) {
        let p = points[v];
        let (low, high) = (cell(p.add_scalar(-reach)), cell(p.add_scalar(reach)));
        let mut found: Option<u32> = None;
        for i in low.x..=high.x {
            for j in low.y..=high.y {
                for k in low.z..=high.z {
                    let near = cells.get(&[i, j, k]).into_iter().flatten();
                    let near = near.filter(|w| (points[**w as usize] - p).norm() <= reach);
                    found = found.into_iter().chain(near.copied()).min();
                }
            }
        }
        match found {
            Some(w) => first[v] = w,
            None => cells.entry(cell(p).into()).or_default().push(v as u32),
        }
    }
    first
}

/// Takes away triangles whose corners lie in a line: the neighbour across the long side is cut at
/// the corner between.
fn unfold(mesh: &mut Mesh, repairs: &mut Repairs) {
    for _ in 0..PASSES {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.vertices[v as usize]);
        let flat: Vec<usize> =
            (0..mesh.triangles.len()).filter(|&k| is_flat(corners(&mesh.triangles[k]))).collect();
        if flat.is_empty() {
            return;
        }
        let all = mesh.triangles.iter().enumerate();
        let sides: BTreeMap<[u32; 2], usize> =
            all.flat_map(|(k, t)| (0..3).map(move |i| ([t[i], t[(i + 1) % 3]], k))).collect();
        let mut changed = vec![false; mesh.triangles.len()];
        let mut gone = Vec::new();
        for k in flat {
            let t = mesh.triangles[k];
            let length = |i: usize| {
                (mesh.vertices[t[(i + 1) % 3] as usize] - mesh.vertices[t[i] as usize]).norm_squared()
            };
            let long = (0..3).fold(0, |best, i| if length(i) > length(best) { i } else { best });
            let [a, b, c] = [t[long], t[(long + 1) % 3], t[(long + 2) % 3]];
            match sides.get(&[b, a]) {
                _ if changed[k] => {}
                None => {
                    changed[k] = true;
                    gone.push(k);
                }
                Some(&u) if !changed[u] => {
                    let Some(&d) = mesh.triangles[u].iter().find(|v| **v != a && **v != b) else { continue };
                    (mesh.triangles[k], mesh.triangles[u]) = ([c, a, d], [b, c, d]);
                    (changed[k], changed[u]) = (true, true);
                    repairs.without_area += 1;
                }
                Some(_) => {}
            }
        }
        repairs.without_area += gone.len();
        let mut at = 0;
        mesh.triangles.retain(|_| {
            at += 1;
            gone.binary_search(&(at - 1)).is_err()
        });
        drop_doubled(mesh, repairs);
    }
}

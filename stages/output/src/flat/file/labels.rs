//! Where a mesh from a file is cut into pieces: one label for each side of each edge; sides of
//! equal labels stay together.

use super::raw::{Mended, NO_POINT};
use std::collections::BTreeMap;
use toile_core::prelude::*;
use toile_flatten::islands::weld_uv;

/// What says where one piece ends and the next begins.
#[choice]
#[derive(Copy, Eq)]
pub enum PiecesBy {
    /// Texture islands where all triangles have texture points, else groups where there are two or
    /// more, else materials, else marked seams, else parts.
    Auto,
    /// Islands of the texture: the mesh is cut where the two sides of an edge have different
    /// texture points.
    Uv,
    /// Groups and objects (`g`, `o`; in a GLB each node).
    Groups,
    /// Materials (`usemtl`).
    Materials,
    /// Edges that are marked as lines (`l`; in a GLB line primitives). A line may end inside a
    /// piece: a dart.
    Seams,
    /// Components connected by the file's own vertices.
    Parts,
}

impl PiecesBy {
    /// What separates the pieces, in words.
    pub(in crate::flat) fn words(self) -> &'static str {
        match self {
            PiecesBy::Auto | PiecesBy::Parts => "the parts of the mesh",
            PiecesBy::Uv => "the islands of the texture",
            PiecesBy::Groups => "the groups and objects",
            PiecesBy::Materials => "the materials",
            PiecesBy::Seams => "the marked lines",
        }
    }
}

impl PiecesBy {
    /// What is meant for this mesh.
    ///
    /// Errors: what is requested does not stand in the file.
    pub(in crate::flat) fn resolved(self, mended: &Mended) -> Result<Self, StageError> {
        let mesh = &mended.mesh;
        let missing = |what: &str, instead: &str| {
            let e = StageError::invalid(format!("the file has no {what} to separate the pieces by"));
            Err(e.hint(format!("{instead}, or write another word for `pieces`, such as `Auto`")).at("pieces"))
        };
        let has_uv = mesh.corners.iter().flatten().all(|c| *c != NO_POINT);
        let several = |of: &[u32]| of.windows(2).any(|w| w[0] != w[1]);
        match self {
            // Its own files have a mesh a panel; their texture may be a cloth that runs on over a
            // seam or a dart.
            PiecesBy::Auto if mesh.is_ours && mesh.has_own_vertices => Ok(PiecesBy::Parts),
            PiecesBy::Auto if has_uv => Ok(PiecesBy::Uv),
            PiecesBy::Auto if several(&mesh.groups) => Ok(PiecesBy::Groups),
            PiecesBy::Auto if several(&mesh.materials) => Ok(PiecesBy::Materials),
            PiecesBy::Auto if !mesh.lines.is_empty() => Ok(PiecesBy::Seams),
            PiecesBy::Auto => Ok(PiecesBy::Parts),
            PiecesBy::Uv if !has_uv => missing("texture points on all triangles", "unwrap it"),
            PiecesBy::Groups if !several(&mesh.groups) => missing("second group", "give each piece a group"),
            PiecesBy::Materials if !several(&mesh.materials) => {
                missing("second material", "give each piece a material")
            }
            PiecesBy::Seams if mesh.lines.is_empty() => missing("lines", "mark the seams as edges"),
            by => Ok(by),
        }
    }
}

/// A label that no other side has.
const ALONE: u32 = u32::MAX;

/// The labels of all half-edges, and at how many edges of three triangles or more a piece had to be
/// cut.
pub(in crate::flat) fn labels(mended: &Mended, by: PiecesBy) -> (Vec<[u32; 2]>, usize) {
    let mesh = &mended.mesh;
    let by_corners = |corners: &[[u32; 3]]| of_corners(&mesh.triangles, corners);
    let by_triangles = |of: &[u32]| of.iter().flat_map(|g| [[*g, 0]; 3]).collect::<Vec<_>>();
    let mut labels = match by {
        PiecesBy::Uv => by_corners(&joined_points(mended)),
        PiecesBy::Parts | PiecesBy::Auto => by_corners(&mended.own),
        PiecesBy::Groups => by_triangles(&mesh.groups),
        PiecesBy::Materials => by_triangles(&mesh.materials),
        PiecesBy::Seams => by_triangles(&vec![0; mesh.triangles.len()]),
    };
    if by == PiecesBy::Seams {
        cut_along(&mesh.triangles, &mesh.lines, &mut labels);
    }
    let cut = part_crowded(&mesh.triangles, &mut labels);
    (labels, cut)
}

/// Texture points by the first at their place: most programs repeat them at every corner. In a file
/// of this program panels share none.
fn joined_points(mended: &Mended) -> Vec<[u32; 3]> {
    let mesh = &mended.mesh;
    let first = weld_uv(&mesh.uv, 0.0);
    let mut of_panel: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut of = |c: u32, group: u32| {
        let point = first.get(c as usize).copied().unwrap_or(c);
        let next = of_panel.len() as u32;
        if mesh.is_ours { *of_panel.entry((point, group)).or_insert(next) } else { point }
    };
    mesh.corners.iter().zip(&mesh.groups).map(|(t, group)| t.map(|c| of(c, *group))).collect()
}

/// The labels of half-edges by what stands at their ends, in the order of the vertices, so that
/// both sides compare alike.
pub(in crate::flat) fn of_corners(triangles: &[[u32; 3]], corners: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let label = |(t, c): (&[u32; 3], &[u32; 3])| {
        [0, 1, 2].map(|k| {
            let next = (k + 1) % 3;
            if t[k] < t[next] { [c[k], c[next]] } else { [c[next], c[k]] }
        })
    };
    triangles.iter().zip(corners).flat_map(label).collect()
}

fn key(t: &[u32; 3], k: usize) -> [u32; 2] {
    let (a, b) = (t[k], t[(k + 1) % 3]);
    [a.min(b), a.max(b)]
}

/// Gives each side of these edges a label of its own; returns none where the mesh has no such edge.
pub(in crate::flat) fn cut_along(triangles: &[[u32; 3]], edges: &[[u32; 2]], labels: &mut [[u32; 2]]) {
    let mut marked: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    marked.sort_unstable();
    for (h, label) in labels.iter_mut().enumerate() {
        if marked.binary_search(&key(&triangles[h / 3], h % 3)).is_ok() {
            *label = [h as u32, ALONE];
        }
    }
}

/// Gives the sides of edges at which three or more would stay together labels of their own; returns
/// how many edges.
fn part_crowded(triangles: &[[u32; 3]], labels: &mut [[u32; 2]]) -> usize {
    let mut sides: Vec<([u32; 2], [u32; 2], u32)> =
        (0..labels.len()).map(|h| (key(&triangles[h / 3], h % 3), labels[h], h as u32)).collect();
    sides.sort_unstable();
    let mut count = 0;
    for group in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|g| g.len() > 2) {
        count += 1;
        group.iter().for_each(|s| labels[s.2 as usize] = [s.2, ALONE]);
    }
    count
}

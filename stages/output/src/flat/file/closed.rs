//! Parts of a mesh that are closed all around: bodies, buttons, and cloth that was exported with
//! its thickness.
//!
//! Method: triangles that share joined vertices form one part; it is closed where its triangles run
//! along each edge as often one way as the other. The volume of a closed part (divergence theorem)
//! over half of its area is the mean distance between its two sides: some millimetres for cloth
//! with a thickness, centimetres for a body. Cost: a sort of the edges. Limit: a part whose
//! triangles face at random counts as open.

use super::raw::RawMesh;
use toile_geometry::components::{groups, links};

/// Cloth is no thicker than this, metres.
const THICKEST: f64 = 0.01;
/// Cloth is at least so many times as large as it is thick.
const SLENDER: f64 = 20.0;

/// A connected component of a mesh.
#[derive(Debug, Clone)]
pub(in crate::flat) struct Whole {
    /// Its triangles.
    pub(in crate::flat) triangles: Vec<u32>,
    /// The name of most of its triangles; may be empty.
    pub(in crate::flat) name: String,
    /// The diagonal of its box, metres.
    pub(in crate::flat) size: f64,
    /// The mean distance between its two sides, metres; none of an open one.
    pub(in crate::flat) depth: Option<f64>,
}

impl Whole {
    pub(in crate::flat) fn is_closed(&self) -> bool {
        self.depth.is_some()
    }

    /// How thick a sheet of cloth with two sides and rims is; none of all else.
    pub(in crate::flat) fn thickness(&self) -> Option<f64> {
        self.depth.filter(|d| *d <= THICKEST && self.size >= SLENDER * d)
    }
}

/// The connected components, in the order of their first triangles.
pub(in crate::flat) fn wholes(mesh: &RawMesh) -> Vec<Whole> {
    let (of, count) = groups(mesh.positions.len(), links(&mesh.triangles));
    let mut triangles: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        triangles[of[corners[0] as usize] as usize].push(t as u32);
    }
    triangles.retain(|t| !t.is_empty());
    triangles.sort_by_key(|t| t[0]);
    triangles.into_iter().map(|t| whole(mesh, t)).collect()
}

fn whole(mesh: &RawMesh, triangles: Vec<u32>) -> Whole {
    let corners = |t: &u32| mesh.triangles[*t as usize].map(|v| mesh.positions[v as usize]);
    let first = corners(&triangles[0])[0];
    let (lo, hi) =
        triangles.iter().flat_map(&corners).fold((first, first), |(lo, hi), p| (lo.inf(&p), hi.sup(&p)));
    // From its own middle, so that a part far from the origin keeps its digits.
    let middle = nalgebra::center(&lo, &hi);
    let (mut area, mut volume) = (0.0, 0.0);
    for t in &triangles {
        let [a, b, c] = corners(t).map(|p| p - middle);
        area += (b - a).cross(&(c - a)).norm() / 2.0;
        volume += a.dot(&b.cross(&c)) / 6.0;
    }
    let is_closed = is_closed(triangles.iter().map(|t| mesh.triangles[*t as usize]));
    let depth = (is_closed && area > 0.0).then(|| 2.0 * f64::abs(volume) / area);
    Whole { name: name(mesh, &triangles), size: (hi - lo).norm(), depth, triangles }
}

/// Whether triangles run along each edge as often one way as the other.
fn is_closed(triangles: impl Iterator<Item = [u32; 3]>) -> bool {
    let sides = triangles.flat_map(|t| [0, 1, 2].map(|k| (t[k], t[(k + 1) % 3])));
    let mut edges: Vec<(u32, u32, i64)> =
        sides.map(|(a, b)| (a.min(b), a.max(b), if a < b { 1 } else { -1 })).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|e| e.iter().map(|e| e.2).sum::<i64>() == 0)
}

/// What most of these triangles are called.
fn name(mesh: &RawMesh, triangles: &[u32]) -> String {
    let mut names: Vec<&str> = triangles.iter().map(|t| mesh.called(*t as usize)).collect();
    names.sort_unstable();
    let runs = names.chunk_by(|a, b| a == b);
    runs.fold(("", 0), |best, run| if run.len() > best.1 { (run[0], run.len()) } else { best }).0.to_owned()
}

/// Names for people, each once and at most three of them: `"front", "back" and 2 more`; what has no
/// name is counted.
pub(in crate::flat) fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const NAMED: usize = 3;
    let (mut shown, mut more): (Vec<String>, usize) = (Vec::new(), 0);
    for name in names {
        let quoted = format!("\"{name}\"");
        if name.is_empty() || shown.len() >= NAMED && !shown.contains(&quoted) {
            more += 1;
        } else if !shown.contains(&quoted) {
            shown.push(quoted);
        }
    }
    match (shown.split_last(), more) {
        (None, 1) => "a part without a name".to_owned(),
        (None, n) => format!("{n} parts without a name"),
        (Some((last, [])), 0) => last.clone(),
        (Some((last, before)), 0) => format!("{} and {last}", before.join(", ")),
        (Some(_), n) => format!("{} and {n} more", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::prelude::*;

    /// A tube of that radius, its wall so thick, closed by rims; or a single layer.
    fn tube(radius: f64, wall: Option<f64>) -> RawMesh {
        let (around, rows) = (24_u32, 6_u32);
        let mut mesh = RawMesh { group_names: vec!["skirt".into()], ..RawMesh::default() };
        let radii: Vec<f64> = std::iter::once(radius).chain(wall.map(|w| radius - w)).collect();
        for r in &radii {
            for row in 0..=rows {
                for k in 0..around {
                    let angle = f64::from(k) / f64::from(around) * std::f64::consts::TAU;
                    let y = 0.6 * f64::from(row) / f64::from(rows);
                    mesh.positions.push(Point3::new(r * angle.cos(), y, -r * angle.sin()));
                }
            }
        }
        let at = |layer: u32, row: u32, k: u32| layer * (rows + 1) * around + row * around + k % around;
        let mut quad = |a, b, c, d| mesh.triangles.extend([[a, b, c], [a, c, d]]);
        for k in 0..around {
            for row in 0..rows {
                quad(at(0, row, k), at(0, row, k + 1), at(0, row + 1, k + 1), at(0, row + 1, k));
                if wall.is_some() {
                    quad(at(1, row, k + 1), at(1, row, k), at(1, row + 1, k), at(1, row + 1, k + 1));
                }
            }
            if wall.is_some() {
                quad(at(0, rows, k), at(0, rows, k + 1), at(1, rows, k + 1), at(1, rows, k));
                quad(at(1, 0, k), at(1, 0, k + 1), at(0, 0, k + 1), at(0, 0, k));
            }
        }
        mesh.groups = vec![0; mesh.triangles.len()];
        mesh
    }

    #[test]
    fn cloth_with_a_thickness_is_told_from_a_body_and_from_a_single_layer() {
        let only =
            |mesh: &RawMesh| wholes(mesh).pop().map(|w| (w.name.clone(), w.is_closed(), w.thickness()));
        assert_eq!(only(&tube(0.2, None)), Some(("skirt".to_owned(), false, None)));
        let (_, closed, thickness) = only(&tube(0.2, Some(0.003))).unwrap_or_default();
        assert!(closed && (thickness.unwrap_or(0.0) - 0.003).abs() < 1e-4, "{thickness:?}");
        // A wall of five centimetres is none of cloth.
        assert_eq!(only(&tube(0.2, Some(0.05))), Some(("skirt".to_owned(), true, None)));
    }

    #[test]
    fn names_are_listed_once_and_at_most_three() {
        assert_eq!(list(["a", "b", "a"].into_iter()), "\"a\" and \"b\"");
        assert_eq!(list(["a", "b", "c", "d", "e"].into_iter()), "\"a\", \"b\", \"c\" and 2 more");
        assert_eq!(list(["", ""].into_iter()), "2 parts without a name");
    }
}

//! The skin of a [`ScalarField`] as an even, closed triangle mesh: surface nets (Gibson, 1998) with
//! one vertex for each sheet of skin in a cell (dual marching cubes, Nielson 2004),
//! [refined](crate::skin::refine) where the field asks for shorter edges, with rounds of
//! tangential smoothing, each followed by a Newton step back onto the skin.
//!
//! The field is symmetric about x = 0: one half is meshed, with a column of cells astride the
//! plane, and mirrored, so that the mesh is symmetric to the last bit and costs half.
//!
//! Cost: one look-up a grid point near the skin and about four a vertex and round; slabs and
//! vertices in parallel. Limit: parts thinner than two cells are lost, and parts closer than two
//! cells may share edges of four triangles, which the caller must refuse.

use crate::skin::field::ScalarField;
use crate::skin::refine::{LEVELS, flip, refined};
use crate::skin::topology::SkinMesh;
use crate::skin::untangle::untangle;
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_core::artifact::{Point3, Vector3};

/// Rounds of smoothing before the mesh is refined, and after.
const ROUNDS: [usize; 2] = [2, 3];
/// Where the mesh is finer than this share of a cell, sheets of skin lie near each other and may
/// cross.
const FINE: f64 = 0.8;
/// Share of the way to the neighbours' centre that a vertex moves in a round.
const RELAXATION: f64 = 0.6;
/// Points along the side of a block whose middle is asked first.
const BLOCK: usize = 4;
/// A block is far from the skin where its middle's value is so many times the distance to its
/// corners: values are distances to first order only.
const FAR: f64 = 1.7;

/// The box that holds the half of the solid with x >= 0, and the size of a cell, metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CellGrid {
    /// Upper x, lower and upper y, lower and upper z.
    pub bounds: [f64; 5],
    /// Edge of a cell.
    pub cell: f64,
}

impl CellGrid {
    fn counts(&self) -> [usize; 3] {
        let [x1, y0, y1, z0, z1] = self.bounds;
        [x1, y1 - y0, z1 - z0].map(|l| (l / self.cell).ceil() as usize + 2)
    }

    /// The first column of samples lies half a cell beyond the plane, so that its cells straddle
    /// it.
    fn point(&self, [i, j, k]: [usize; 3]) -> Point3 {
        let [_, y0, _, z0, _] = self.bounds;
        Point3::new(
            (i as f64 - 0.5) * self.cell,
            y0 + (j as f64 - 0.5) * self.cell,
            z0 + (k as f64 - 0.5) * self.cell,
        )
    }
}

/// Meshes the skin of a field that is symmetric about x = 0.
pub(crate) fn mesh(field: &impl ScalarField, grid: &CellGrid) -> SkinMesh {
    let (points, quads) = Samples::take(field, grid).nets(grid);
    let points = relocate(&points, |i| field.onto_skin(points[i], 2, grid.cell));
    let triangles = quads.iter().flat_map(|q| split(&points, *q)).collect();
    let mut skin = even(field, grid, (points, triangles), ROUNDS[0]);
    for _ in 0..LEVELS {
        skin = refined(skin, |p| field.fineness(p) * grid.cell, |p| field.onto_skin(p, 1, grid.cell));
    }
    let (points, triangles) = even(field, grid, skin, ROUNDS[1]);
    let mut points = relocate(&points, |i| field.onto_skin(points[i], 2, grid.cell));
    let around = neighbours(points.len(), &triangles);
    untangle(&mut points, &triangles, &around, |p| field.fineness(p) < FINE);
    mirror(points, triangles)
}

/// Rounds of smoothing and of turning edges.
fn even(
    field: &impl ScalarField,
    grid: &CellGrid,
    (mut points, mut triangles): SkinMesh,
    rounds: usize,
) -> SkinMesh {
    for _ in 0..rounds {
        flip(&points, &mut triangles);
        let (around, normals) = (neighbours(points.len(), &triangles), normals(&points, &triangles));
        points = relocate(&points, |i| {
            let to = points[i] + pull(&points, &around[i], i, &normals[i]) * RELAXATION;
            field.onto_skin(to, 1, grid.cell)
        });
    }
    flip(&points, &mut triangles);
    (points, triangles)
}

/// Moves every vertex; those of the plane of symmetry stay in it.
fn relocate(points: &[Point3], to: impl Fn(usize) -> Point3 + Sync) -> Vec<Point3> {
    let flat = |i: usize, p: Point3| if points[i].x == 0.0 { Point3::new(0.0, p.y, p.z) } else { p };
    (0..points.len()).into_par_iter().map(|i| flat(i, to(i))).collect()
}

/// The way to the middle of the neighbours, along the skin.
fn pull(points: &[Point3], neighbours: &[u32], i: usize, n: &Vector3) -> Vector3 {
    let p = points[i];
    let (mut sum, mut weights) = (Vector3::zeros(), 0.0);
    for &m in neighbours {
        // Seen from the plane of symmetry a neighbour off the plane stands for its image as well.
        let w = if p.x == 0.0 && points[m as usize].x != 0.0 { 2.0 } else { 1.0 };
        sum += (points[m as usize] - p) * w;
        weights += w;
    }
    let pull = sum / f64::max(weights, 1.0);
    pull - n * pull.dot(n)
}

fn normals(points: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let mut normals = vec![Vector3::zeros(); points.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        let n = (b - a).cross(&(c - a));
        t.iter().for_each(|&v| normals[v as usize] += n);
    }
    // Half a figure: at the plane of symmetry the image's triangles are missing.
    let flat = |(n, p): (Vector3, &Point3)| if p.x == 0.0 { Vector3::new(0.0, n.y, n.z) } else { n };
    normals.into_iter().zip(points).map(|n| flat(n).try_normalize(0.0).unwrap_or_default()).collect()
}

fn neighbours(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::with_capacity(14); vertices];
    for t in triangles {
        for k in 0..3 {
            around[t[k] as usize].extend([t[(k + 1) % 3], t[(k + 2) % 3]]);
        }
    }
    around.par_iter_mut().for_each(|n| {
        n.sort_unstable();
        n.dedup();
    });
    around
}

/// Field values at the grid's points.
struct Samples {
    counts: [usize; 3],
    values: Vec<f64>,
}

impl Samples {
    /// Blocks of points that lie far from the skin get their middle's value.
    fn take(field: &impl ScalarField, grid: &CellGrid) -> Self {
        let counts = grid.counts();
        let layers: Vec<usize> = (0..counts[1]).step_by(BLOCK).collect();
        let layer = |&j: &usize| Self::layer(field, grid, counts, j);
        let values = layers.par_iter().map(layer).collect::<Vec<_>>().concat();
        Samples { counts, values }
    }

    /// The values of up to [`BLOCK`] slabs from `j0` on.
    fn layer(field: &impl ScalarField, grid: &CellGrid, [nx, ny, nz]: [usize; 3], j0: usize) -> Vec<f64> {
        let rows = BLOCK.min(ny - j0);
        let mut values = vec![0.0; rows * nx * nz];
        let half = 0.5 * (BLOCK - 1) as f64 * grid.cell;
        let far = FAR * 3.0_f64.sqrt() * half;
        for (i0, k0) in (0..nx).step_by(BLOCK).flat_map(|i| (0..nz).step_by(BLOCK).map(move |k| (i, k))) {
            let middle = field.coarse(grid.point([i0, j0, k0]) + Vector3::from([half; 3]));
            for (j, i) in (0..rows).flat_map(|j| (i0..nx.min(i0 + BLOCK)).map(move |i| (j, i))) {
                for k in k0..nz.min(k0 + BLOCK) {
                    let near = || field.coarse(grid.point([i, j0 + j, k]));
                    values[(j * nx + i) * nz + k] = if middle.abs() > far { middle } else { near() };
                }
            }
        }
        values
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> f64 {
        let [nx, _, nz] = self.counts;
        self.values[(j * nx + i) * nz + k]
    }

    fn inside(&self, at: [usize; 3]) -> bool {
        self.at(at) < 0.0
    }

    /// One vertex for each sheet of skin in a cell, one quad for each edge that the skin crosses.
    fn nets(&self, grid: &CellGrid) -> (Vec<Point3>, Vec<[u32; 4]>) {
        let [nx, ny, nz] = self.counts;
        let cells =
            (0..ny - 1).flat_map(|j| (0..nx - 1).flat_map(move |i| (0..nz - 1).map(move |k| [i, j, k])));
        let (mut points, mut quads, mut index) = (Vec::new(), Vec::new(), BTreeMap::new());
        for cell in cells {
            let signs = CORNERS.map(|c| self.inside(plus(cell, c)));
            if signs.iter().all(|s| *s == signs[0]) {
                continue;
            }
            index.insert(cell, self.cell_vertices(grid, cell, &mut points));
            self.cell_quads(cell, &index, &mut quads);
        }
        (points, quads)
    }

    /// Adds a vertex for each sheet, at the mean of its crossings with the cell's edges; returns
    /// the vertex of each edge.
    fn cell_vertices(&self, grid: &CellGrid, cell: [usize; 3], points: &mut Vec<Point3>) -> [u32; 12] {
        let sheets = self.sheets(cell);
        let mut vertices = [u32::MAX; 12];
        for sheet in 0..12 {
            let edges: Vec<usize> = (0..12).filter(|&e| sheets[e] == Some(sheet)).collect();
            if edges.is_empty() {
                continue;
            }
            edges.iter().for_each(|&e| vertices[e] = points.len() as u32);
            let sum: Vector3 = edges.iter().map(|&e| self.crossing(grid, cell, e)).sum();
            let mean = Point3::from(sum / edges.len() as f64);
            points.push(if cell[0] == 0 { Point3::new(0.0, mean.y, mean.z) } else { mean });
        }
        vertices
    }

    fn crossing(&self, grid: &CellGrid, cell: [usize; 3], edge: usize) -> Vector3 {
        let (from, to) = edge_ends(cell, edge);
        let (a, b) = (self.at(from), self.at(to));
        grid.point(from).coords.lerp(&grid.point(to).coords, a / (a - b))
    }

    /// Numbers the sheets: each crossed edge gets the least edge that the skin links it to across
    /// the cell's faces. Both cells of a face see the same links, so sheets never meet in an edge
    /// that one cell joins and the other parts (dual marching cubes, Nielson 2004).
    fn sheets(&self, cell: [usize; 3]) -> [Option<usize>; 12] {
        let crossed = |e: usize| {
            let (from, to) = edge_ends(cell, e);
            self.inside(from) != self.inside(to)
        };
        let mut sheets: [Option<usize>; 12] = std::array::from_fn(|e| crossed(e).then_some(e));
        for (normal, side) in (0..3).flat_map(|n| [(n, 0), (n, 1)]) {
            for (a, b) in self.face_links(cell, normal, side, &sheets).into_iter().flatten() {
                let (low, high) = (sheets[a].min(sheets[b]), sheets[a].max(sheets[b]));
                sheets.iter_mut().filter(|s| **s == high).for_each(|s| *s = low);
            }
        }
        sheets
    }

    /// The pairs of edges that the skin links across a face.
    fn face_links(
        &self,
        cell: [usize; 3],
        normal: usize,
        side: usize,
        sheets: &[Option<usize>; 12],
    ) -> [Option<(usize, usize)>; 2] {
        let (u, v) = ((normal + 1) % 3, (normal + 2) % 3);
        let at = |a: usize, b: usize| {
            let mut offset = [0; 3];
            (offset[normal], offset[u], offset[v]) = (side, a, b);
            offset
        };
        let ring = [edge_id(u, at(0, 0)), edge_id(v, at(1, 0)), edge_id(u, at(0, 1)), edge_id(v, at(0, 0))];
        let crossed: Vec<usize> = ring.into_iter().filter(|&e| sheets[e].is_some()).collect();
        match crossed[..] {
            [a, b] => [Some((a, b)), None],
            [a, b, c, d] => {
                let corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)].map(|o| plus(cell, o));
                let middle_inside = corners.iter().map(|&c| self.at(c)).sum::<f64>() < 0.0;
                // The first corner lies between the last edge and the first.
                let cut_first = self.inside(corners[0]) != middle_inside;
                if cut_first { [Some((d, a)), Some((b, c))] } else { [Some((a, b)), Some((c, d))] }
            }
            _ => [None, None],
        }
    }

    /// Quads around the three edges that leave the cell's least corner; their other cells were met
    /// before. Edges that cross the plane of symmetry or lie beyond it belong to the mirror image.
    fn cell_quads(
        &self,
        cell: [usize; 3],
        index: &BTreeMap<[usize; 3], [u32; 12]>,
        quads: &mut Vec<[u32; 4]>,
    ) {
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let (_, end) = edge_ends(cell, edge_id(axis, [0; 3]));
            let mine = cell[u] > 0 && cell[v] > 0 && cell[0] > 0;
            if !mine || self.inside(cell) == self.inside(end) {
                continue;
            }
            let vertex = |du: usize, dv: usize| {
                let (mut c, mut offset) = (cell, [0; 3]);
                (c[u], c[v]) = (c[u] - du, c[v] - dv);
                (offset[u], offset[v]) = (du, dv);
                index.get(&c).map(|vertices| vertices[edge_id(axis, offset)])
            };
            if let [Some(a), Some(b), Some(c), Some(d)] =
                [vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)]
            {
                quads.push(if self.inside(cell) { [a, b, c, d] } else { [d, c, b, a] });
            }
        }
    }
}

const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];

fn plus(a: [usize; 3], b: [usize; 3]) -> [usize; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The number within its cell of the edge along `axis` that starts at the corner `offset`.
fn edge_id(axis: usize, offset: [usize; 3]) -> usize {
    axis * 4 + offset[(axis + 1) % 3] + 2 * offset[(axis + 2) % 3]
}

/// Start and end of a cell's edge.
fn edge_ends(cell: [usize; 3], edge: usize) -> ([usize; 3], [usize; 3]) {
    let (axis, mut from) = (edge / 4, cell);
    from[(axis + 1) % 3] += edge % 2;
    from[(axis + 2) % 3] += edge / 2 % 2;
    let mut to = from;
    to[axis] += 1;
    (from, to)
}

/// Splits a quad along its shorter diagonal.
fn split(points: &[Point3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let length = |u: u32, v: u32| (points[u as usize] - points[v as usize]).norm_squared();
    if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// Adds the image in the plane x = 0, sharing the vertices of the plane.
fn mirror(mut points: Vec<Point3>, mut triangles: Vec<[u32; 3]>) -> SkinMesh {
    let half = points.len();
    let mut image = Vec::with_capacity(half);
    for i in 0..half {
        let p = points[i];
        image.push(if p.x == 0.0 { i } else { points.len() } as u32);
        if p.x != 0.0 {
            points.push(Point3::new(-p.x, p.y, p.z));
        }
    }
    let mirrored: Vec<[u32; 3]> =
        triangles.iter().map(|&[a, b, c]| [a, c, b].map(|i| image[i as usize])).collect();
    triangles.extend(mirrored);
    (points, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin::topology::MeshTopology;

    struct Ball(f64);
    impl ScalarField for Ball {
        fn value(&self, p: Point3) -> f64 {
            p.coords.norm() - self.0
        }
    }

    #[test]
    fn a_ball_is_closed_even_and_round() {
        let grid = CellGrid { bounds: [1.1, -1.1, 1.1, -1.1, 1.1], cell: 0.13 };
        let (points, triangles) = mesh(&Ball(1.0), &grid);
        let topology = MeshTopology::of(points.len(), &triangles);
        assert!(topology.is_closed(), "{topology:?}");
        assert_eq!((topology.components, topology.euler()), (1, 2));
        assert!(points.iter().all(|p| (p.coords.norm() - 1.0).abs() < 1e-9));
        let six = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| points[i as usize].coords);
            a.dot(&b.cross(&c))
        };
        let volume: f64 = triangles.iter().map(|&t| six(t) / 6.0).sum();
        let exact = 4.0 / 3.0 * std::f64::consts::PI;
        assert!((volume / exact - 1.0).abs() < 0.02, "{volume}");
    }
}

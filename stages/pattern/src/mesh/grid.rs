//! A regular grid laid over the panel, after a thesis on garment modelling from photos (2012).
//!
//! Method: the outline is divided first and never touched again. Grid lines run along warp and
//! weft, spaced so that the panel's box is a whole number of cells. Each line is cut by the outline
//! into inside runs, even-odd; two neighbouring runs are zipped left to right into the cells both
//! of them hold. Crossings that crowd the outline are merged into it: of the two the outline's
//! vertex cannot move, so the least-energy place of the merged vertex is the outline's. The band
//! that is left between grid and outline is triangulated by constrained Delaunay and its angles
//! mended (see `refine`). Cost: linear in the triangles, n log n in the outline's vertices. Limits:
//! the grid is uniform; only the band follows a finely divided edge.

use super::assemble::{Meshed, mesh_outline};
use super::divide::Division;
use super::lattice::Lattice;
use super::refine::improve;
use super::triangulate::triangulate;
use super::trimesh::TriMesh;
use toile_core::prelude::*;
use toile_core::{Context, StageError};

/// A crossing nearer to the outline than this share of the edge length is merged into it. Less
/// makes needles, more makes a wide band that loses the grid's regularity.
const LEAST_DISTANCE: f64 = 0.5;

/// A cell with a segment this near to its sides (in edge lengths) belongs to the band: the point of
/// a notch can be clear of all crossings and still sit close to the middle of a side.
const CELL_MARGIN: f64 = 0.35;

/// Angles in the band are mended up to this (degrees): well above the 15 that are promised, low
/// enough to need few vertices that are not grid crossings.
const BAND_ANGLE: f64 = 27.0;

/// Lays a regular grid over the panel and joins it to the outline with a band of triangles.
///
/// Inner vertices stand at the crossings of lines along warp and weft, so that structural springs
/// run along the threads and shear springs along the diagonals. Named edges are divided as their
/// gauges say, so that two edges that are sewn together get equal counts. Darts, pleats and folds
/// lie on mesh edges.
#[stage(
    role = Mesher,
    source = "thesis on 3D garment modelling from photos, 2012",
    example = "GridMesher(edge: \"12 mm\")",
    contracts(Deterministic, ThreadInvariant, BoundaryPreserving, RefusesEmpty, Cancellable)
)]
pub struct GridMesher {
    /// Target length of the triangles' edges; a smaller one gives finer folds and takes longer.
    #[param(default = Length::mm(12.0), min = 0.0001, max = 1.0, trades, finer = "less")]
    pub(crate) edge: Length,
}

#[stage]
impl GridMesher {
    pub(crate) fn run(&self, outline: &Outline, cx: &Context) -> Result<Panel, StageError> {
        let h = self.edge.metres();
        mesh_outline(outline, h, cx, |division| grid_mesh(outline, division, h, cx))
    }
}

/// Vertices and triangles of a divided outline: regular inside, a mended band along the outline.
pub(crate) fn grid_mesh(
    outline: &Outline,
    division: &Division,
    h: f64,
    cx: &Context,
) -> Result<Meshed, StageError> {
    let lattice = grid_lattice(outline, h);
    let kept = kept_crossings(&lattice, division, h);
    let cells = full_cells(&lattice, division, &kept, h);
    cx.check()?;
    let first = division.points.len() as u32;
    let mut number = vec![u32::MAX; kept.len()];
    let mut points = division.points.clone();
    for (k, _) in kept.iter().enumerate().filter(|(_, kept)| **kept) {
        number[k] = points.len() as u32;
        points.push(lattice.point(k % lattice.columns, k / lattice.columns));
    }
    let mut triangles = zipped_rows(&lattice, &cells, &number);
    let border = border_of_cells(&lattice, &cells, &number);
    let gridded = in_triangles(&triangles, points.len());
    let mut band = band_mesh(division, &points, &gridded, &border, first)?;
    cx.check()?;
    improve(&mut band.mesh, BAND_ANGLE.to_radians(), cx)?;
    band.merge_into(&mut points, &mut triangles);
    Ok(Meshed { points, triangles })
}

/// Grid lines on all four sides of the outline's box, at most `h` apart.
fn grid_lattice(outline: &Outline, h: f64) -> Lattice {
    let (low, high) = outline.bounds();
    let span = high - low;
    let cells = |length: f64| ((length / h - 1e-9).ceil() as usize).max(1);
    let (nx, ny) = (cells(span.x), cells(span.y));
    Lattice { low, dx: span.x / nx as f64, dy: span.y / ny as f64, columns: nx + 1, rows: ny + 1, shift: 0.0 }
}

/// Crossings inside the outline and clear of every segment.
fn kept_crossings(lattice: &Lattice, division: &Division, h: f64) -> Vec<bool> {
    let mut kept = lattice.inside(&division.points, &division.loop_segments());
    lattice.near(&division.points, &division.segments(), LEAST_DISTANCE * h, |k| kept[k] = false);
    kept
}

/// Cells whose four crossings are kept and that no segment comes near.
fn full_cells(lattice: &Lattice, division: &Division, kept: &[bool], h: f64) -> Vec<bool> {
    let mut cells = lattice.touched_cells(&division.points, &division.segments(), CELL_MARGIN * h);
    let n = lattice.columns;
    for (k, cell) in cells.iter_mut().enumerate() {
        let inner = k % n + 1 < n && k / n + 1 < lattice.rows;
        *cell = inner && !*cell && [k, k + 1, k + n, k + n + 1].iter().all(|&c| kept[c]);
    }
    cells
}

/// Two triangles a cell, row by row from left to right. Diagonals alternate like a chequer board,
/// so that the mesh shears alike both ways.
fn zipped_rows(lattice: &Lattice, cells: &[bool], number: &[u32]) -> Vec<[u32; 3]> {
    let n = lattice.columns;
    let mut triangles = Vec::with_capacity(2 * cells.len());
    for (k, _) in cells.iter().enumerate().filter(|(_, full)| **full) {
        let [a, b, c, d] = [k, k + 1, k + n + 1, k + n].map(|c| number[c]);
        match (k % n + k / n) % 2 {
            0 => triangles.extend([[a, b, c], [a, c, d]]),
            _ => triangles.extend([[a, b, d], [b, c, d]]),
        }
    }
    triangles
}

/// Sides between a full cell and one that is not, with the latter on their left.
fn border_of_cells(lattice: &Lattice, cells: &[bool], number: &[u32]) -> Vec<[u32; 2]> {
    let n = lattice.columns;
    let full = |k: Option<usize>| k.is_some_and(|k| cells[k]);
    let mut border = Vec::new();
    for (k, _) in cells.iter().enumerate().filter(|(_, full)| **full) {
        let sides = [
            (k.checked_sub(n), k + 1, k),
            (Some(k + 1), k + n + 1, k + 1),
            (Some(k + n), k + n, k + n + 1),
            (k.checked_sub(1), k, k + n),
        ];
        border.extend(sides.iter().filter(|s| !full(s.0)).map(|s| [number[s.1], number[s.2]]));
    }
    border
}

fn in_triangles(triangles: &[[u32; 3]], vertices: usize) -> Vec<bool> {
    let mut used = vec![false; vertices];
    triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    used
}

/// The band between grid and outline, with its own vertex numbers.
struct GridBand {
    mesh: TriMesh,
    /// The panel's vertex of each of the band's first vertices.
    global: Vec<u32>,
}

fn band_mesh(
    division: &Division,
    points: &[Point2],
    gridded: &[bool],
    border: &[[u32; 2]],
    first: u32,
) -> Result<GridBand, StageError> {
    let mut on_border = vec![false; points.len()];
    border.iter().flatten().for_each(|&v| on_border[v as usize] = true);
    let in_band = |v: &u32| *v < first || on_border[*v as usize] || !gridded[*v as usize];
    let global: Vec<u32> = (0..points.len() as u32).filter(in_band).collect();
    let mut local = vec![u32::MAX; points.len()];
    global.iter().enumerate().for_each(|(k, &v)| local[v as usize] = k as u32);
    let free = global.iter().map(|&v| v >= first && !gridded[v as usize]).collect();
    let band_points = global.iter().map(|&v| points[v as usize]).collect();
    let to_local = |s: &[u32; 2]| s.map(|v| local[v as usize]);
    let loops: Vec<[u32; 2]> = division.loop_segments().iter().chain(border).map(to_local).collect();
    let lines: Vec<[u32; 2]> = division.chain_segments().iter().map(to_local).collect();
    Ok(GridBand { mesh: triangulate(band_points, free, &loops, &lines)?, global })
}

impl GridBand {
    /// Adds the band's vertices and triangles to those of the grid.
    fn merge_into(&mut self, points: &mut Vec<Point2>, triangles: &mut Vec<[u32; 3]>) {
        for (k, p) in self.mesh.points.iter().enumerate() {
            match self.global.get(k) {
                Some(&v) => points[v as usize] = *p,
                None => {
                    self.global.push(points.len() as u32);
                    points.push(*p);
                }
            }
        }
        let living = self.mesh.living().map(|t| self.mesh.tris[t as usize]);
        triangles.extend(living.map(|t| t.map(|v| self.global[v as usize])));
    }
}

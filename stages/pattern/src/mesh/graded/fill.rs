//! Fills a divided outline with triangles of given sizes.
//!
//! Method: the corners of a quadtree's cells stand inside; the constrained Delaunay triangulation
//! of these and the outline's vertices is mended where angles fall short (see `refine`), and the
//! diagonals of squares alternate. Angles are at least 26.6 degrees where a cell meets two of half
//! its side, 45 among equal cells; along the outline the figure `least_angle` shows it. Cost: n log
//! n. Limits: segments are never split.

use super::super::assemble::Meshed;
use super::super::divide::Division;
use super::super::refine::improve;
use super::super::triangulate::triangulate;
use super::super::trimesh::TriMesh;
use super::field::SizeField;
use super::quadtree::Quadtree;
use toile_core::artifact::{Outline, Point2};
use toile_core::{Context, StageError};

/// Angles are mended up to this, degrees: just below what a quadtree has by itself.
const ANGLE: f64 = 26.0;

/// Sides that differ by less than this share are equal.
const EQUAL: f64 = 1e-6;

/// Vertices and triangles of a divided outline, as long as the field asks.
pub(crate) fn fill(
    outline: &Outline,
    division: &Division,
    field: &SizeField,
    cx: &Context,
) -> Result<Meshed, StageError> {
    let tree = Quadtree::new(outline.bounds(), field);
    cx.check()?;
    let mut points = division.points.clone();
    points.extend(tree.seeds(division, field, cx)?);
    let free = (0..points.len()).map(|v| v >= division.points.len()).collect();
    cx.check()?;
    let mut mesh = triangulate(points, free, &division.loop_segments(), &division.chain_segments())?;
    cx.check()?;
    improve(&mut mesh, ANGLE.to_radians(), cx)?;
    alternate(&mut mesh, &tree);
    let triangles = mesh.living().map(|t| mesh.tris[t as usize]).collect();
    Ok(Meshed { points: mesh.points, triangles })
}

/// Turns the diagonals of squares so that they alternate: the mesh then shears alike both ways.
fn alternate(mesh: &mut TriMesh, tree: &Quadtree) {
    for t in mesh.living().collect::<Vec<_>>() {
        for k in 0..3 {
            let Some(quad) = mesh.quad(t, k) else { continue };
            if turned(quad, tree) {
                mesh.flip(t, k);
                break;
            }
        }
    }
}

/// Whether the diagonal from the second to the fourth corner of a rectangle along the threads runs
/// the wrong way.
fn turned([a, b, c, d]: [Point2; 4], tree: &Quadtree) -> bool {
    let (low, high) = (a.inf(&b).inf(&c).inf(&d), a.sup(&b).sup(&c).sup(&d));
    let size = high - low;
    let at = |p: Point2| [p.x - low.x, p.y - low.y].map(|x| x.abs() < EQUAL * size.max());
    let off = |p: Point2| [high.x - p.x, high.y - p.y].map(|x| x.abs() < EQUAL * size.max());
    let is_corner = |p: Point2| (0..2).all(|k| at(p)[k] || off(p)[k]);
    if ![a, b, c, d].into_iter().all(is_corner) || at(b)[0] == at(d)[0] || at(b)[1] == at(d)[1] {
        return false;
    }
    let rises = at(b)[0] == at(b)[1];
    tree.rises(low, size.x).is_some_and(|wanted| wanted != rises)
}

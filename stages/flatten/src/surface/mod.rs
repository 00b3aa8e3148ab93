//! A checked surface: one connected, oriented, manifold piece with at least one boundary loop.
//!
//! Checks, in order: lists not empty, places finite, indices in range, areas above zero, at most
//! two triangles an edge, one component, two sides, a boundary, no handles. Repairs, each counted:
//! triangles that run against the others are turned (the majority stays), vertices where only the
//! tips of triangles touch are split, vertices without triangles are left out. Cost: one sort of
//! the 3 t edges of t triangles, else linear. Limit: 2^30 triangles or vertices.

mod boundary;
mod components;
mod edges;
mod fans;
mod orientation;
#[cfg(test)]
mod tests;

use boundary::boundary_loops;
pub(crate) use components::{component_count, components};
pub use edges::FREE;
pub(crate) use edges::OppositeEdges;
use edges::opposites;
pub(crate) use edges::{edge_key, sorted_edges};
pub(crate) use fans::corner_vertices;
use orientation::orient;
pub(crate) use orientation::{orient_all, turn_marked};

use crate::error::SurfaceError;
use nalgebra::{Point3, Vector2, Vector3};

/// Most vertices or triangles: three corners each must have a 32-bit number.
pub const MOST: usize = 1 << 30;

/// A triangle lower than this share of its longest edge counts as one without area: its angles are
/// rounding noise.
pub const LEAST_QUALITY: f64 = 1e-10;

/// Coordinates beyond this are refused: squares of squares of them must not overflow.
pub const FARTHEST: f64 = 1e60;

/// One piece: connected, oriented, manifold, with a boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceSurface {
    positions: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    sources: Vec<u32>,
    opposite: Vec<u32>,
    loops: Vec<Vec<u32>>,
    repairs: SurfaceRepairs,
    /// Triangles, ascending, that were cut otherwise than they lie, with two edges from their first
    /// corner as cut.
    cut: Vec<(u32, [Vector2<f64>; 2])>,
}

/// What was mended on the way in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SurfaceRepairs {
    /// Triangles turned to agree with the majority.
    pub turned: usize,
    /// Vertices added where only tips of triangles touched.
    pub split: usize,
    /// Vertices left out because no triangle names them.
    pub unused: usize,
}

impl PieceSurface {
    /// Checks and repairs a mesh; triangles keep their numbers, vertices keep theirs unless some
    /// were split or left out.
    ///
    /// `positions` in any unit of length; `triangles` counter-clockwise seen from the right side of
    /// the fabric.
    ///
    /// # Errors
    /// Every [`SurfaceError`] but those of lists and seams: the first fault in the order of the
    /// module's head.
    pub fn new(positions: Vec<Point3<f64>>, mut triangles: Vec<[u32; 3]>) -> Result<Self, SurfaceError> {
        check(&positions, &triangles)?;
        let mut opposite = opposites(&triangles)?;
        let components = components(&opposite);
        if let Some(triangle) = components.iter().position(|&c| c == 1) {
            return Err(SurfaceError::Disconnected { count: component_count(&components), triangle });
        }
        let turned = orient(&mut triangles, &mut opposite)?;
        if !opposite.contains(&FREE) {
            return Err(SurfaceError::Closed { triangle: 0 });
        }
        let corners = corner_vertices(&triangles, &opposite, positions.len());
        let mut loops = boundary_loops(&corners.triangles, &opposite, corners.sources.len());
        let euler = corners.sources.len() as i64 - edge_count(&opposite) as i64 + triangles.len() as i64;
        let handles = (2 - loops.len() as i64 - euler) / 2;
        if handles > 0 {
            return Err(SurfaceError::Handles { count: handles as usize });
        }
        let repairs = SurfaceRepairs { turned, split: corners.split, unused: corners.unused };
        let positions: Vec<_> = corners.sources.iter().map(|&v| positions[v as usize]).collect();
        loops.sort_by(|a, b| loop_length(&positions, b).total_cmp(&loop_length(&positions, a)));
        Ok(Self {
            positions,
            triangles: corners.triangles,
            sources: corners.sources,
            opposite,
            loops,
            repairs,
            cut: Vec::new(),
        })
    }

    /// The same with triangles counted that were turned before.
    pub(crate) fn with_turned(mut self, turned: usize) -> Self {
        self.repairs.turned += turned;
        self
    }

    /// The vertices, in the caller's unit.
    #[must_use]
    pub fn positions(&self) -> &[Point3<f64>] {
        &self.positions
    }

    /// The triangles, in the caller's order, counter-clockwise from the right side.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// For each vertex of the surface the caller's vertex that it stands for.
    #[must_use]
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// For half-edge `3 t + k` (from corner k of triangle t to the next) the half-edge of the other
    /// triangle there, or [`FREE`].
    #[must_use]
    pub fn opposite(&self) -> &[u32] {
        &self.opposite
    }

    /// The boundary loops, each counter-clockwise about the surface, the longest (in 3D) first; the
    /// others are holes.
    #[must_use]
    pub fn loops(&self) -> &[Vec<u32>] {
        &self.loops
    }

    /// What was mended.
    #[must_use]
    pub fn repairs(&self) -> SurfaceRepairs {
        self.repairs
    }

    /// Area vector of a triangle: along the outward normal, as long as its area.
    #[must_use]
    pub fn area_vector(&self, triangle: usize) -> Vector3<f64> {
        area_vector(&self.positions, self.triangles[triangle])
    }

    /// The whole area, in square units of the caller's length.
    #[must_use]
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| self.area_vector(t).norm()).sum()
    }

    /// The surface with triangles that were cut otherwise than they lie, such as those that a
    /// gather draws together: for each the edges from corner 0 to 1 and from 0 to 2 as they were
    /// cut, in the plane of the triangle (x along its first edge in space, y to the left of that).
    /// Flatteners and strains take these for its true shape; area and outline in space stay those
    /// of the places.
    ///
    /// # Errors
    /// [`SurfaceError::Degenerate`] for edges that span no area or are turned over, and for
    /// triangles that there are none of.
    pub fn with_cut_shapes(
        mut self,
        mut shapes: Vec<(u32, [Vector2<f64>; 2])>,
    ) -> Result<Self, SurfaceError> {
        shapes.sort_by_key(|s| s.0);
        shapes.dedup_by_key(|s| s.0);
        for (triangle, [a, b]) in &shapes {
            let longest = a.norm_squared().max(b.norm_squared()).max((b - a).norm_squared());
            let quality = a.perp(b) / longest.max(f64::MIN_POSITIVE);
            let sound =
                quality > LEAST_QUALITY && longest < FARTHEST && (*triangle as usize) < self.triangles.len();
            if !sound {
                return Err(SurfaceError::Degenerate { triangle: *triangle as usize, quality });
            }
        }
        self.cut = shapes;
        Ok(self)
    }

    /// The edges of a triangle as it was cut, if that is not as it lies.
    pub(crate) fn cut_shape(&self, triangle: usize) -> Option<[Vector2<f64>; 2]> {
        let found = self.cut.binary_search_by_key(&(triangle as u32), |s| s.0).ok()?;
        Some(self.cut[found].1)
    }

    /// The surface with its vertices elsewhere, one place for each; its triangles are the same.
    ///
    /// # Errors
    /// [`SurfaceError::LengthMismatch`], [`SurfaceError::NotFinite`] and
    /// [`SurfaceError::Degenerate`].
    pub fn with_positions(&self, positions: Vec<Point3<f64>>) -> Result<Self, SurfaceError> {
        if positions.len() != self.positions.len() {
            let (found, wanted) = (positions.len(), self.positions.len());
            return Err(SurfaceError::LengthMismatch { what: "positions", found, wanted });
        }
        check(&positions, &self.triangles)?;
        Ok(Self { positions, ..self.clone() })
    }
}

pub(crate) fn area_vector(positions: &[Point3<f64>], corners: [u32; 3]) -> Vector3<f64> {
    let [a, b, c] = corners.map(|v| positions[v as usize]);
    (b - a).cross(&(c - a)) / 2.0
}

/// Everything that one vertex or one triangle can have wrong.
pub(crate) fn check(positions: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<(), SurfaceError> {
    check_counts(positions.len(), triangles)?;
    let finite = |p: &Point3<f64>| p.iter().all(|x| x.abs() < FARTHEST);
    if let Some(vertex) = positions.iter().position(|p| !finite(p)) {
        return Err(SurfaceError::NotFinite { vertex });
    }
    for (triangle, &corners) in triangles.iter().enumerate() {
        let quality = quality(positions, corners);
        if quality <= LEAST_QUALITY || quality.is_nan() {
            return Err(SurfaceError::Degenerate { triangle, quality });
        }
    }
    Ok(())
}

fn check_counts(vertices: usize, triangles: &[[u32; 3]]) -> Result<(), SurfaceError> {
    if triangles.is_empty() {
        return Err(SurfaceError::Empty);
    }
    for (what, count) in [("vertices", vertices), ("triangles", triangles.len())] {
        if count > MOST {
            return Err(SurfaceError::TooLarge { what, count, limit: MOST });
        }
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
            return Err(SurfaceError::IndexOutOfRange { triangle, vertex, vertices });
        }
    }
    Ok(())
}

/// Height over the longest edge: 0.87 for an equilateral triangle, 0 for none.
fn quality(positions: &[Point3<f64>], corners: [u32; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| positions[v as usize]);
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    2.0 * area_vector(positions, corners).norm() / longest.max(f64::MIN_POSITIVE)
}

fn loop_length(positions: &[Point3<f64>], vertices: &[u32]) -> f64 {
    let next = vertices.iter().cycle().skip(1);
    vertices.iter().zip(next).map(|(&a, &b)| (positions[b as usize] - positions[a as usize]).norm()).sum()
}

fn edge_count(opposite: &[u32]) -> usize {
    let free = opposite.iter().filter(|&&o| o == FREE).count();
    free + (opposite.len() - free) / 2
}

//! A sheet of cloth at rest: triangles with flat rest shapes, edges with their neighbours, masses.
//!
//! Every triangle carries its own rest coordinates (metres, warp along y), so panels with different
//! frames, and vertices that two panels share after sewing, need nothing special. Masses are lumped
//! by area: a third of each triangle to each corner. Building is linear in the triangles;
//! everything is checked here, so that the models downstream need not check again.

mod topology;

#[cfg(test)]
mod tests;

use nalgebra::{Matrix2, Vector2, Vector3};

pub use topology::{Edge, Side};

use self::topology::Facing;
use crate::error::{ClothError, check_parameter};

/// Rest-shape quality (1 equilateral, 0 no area) below which a triangle is refused. A right
/// triangle of aspect 1 : 1000 has 3.5e-3 and is fine; lower would let strains drown in rounding,
/// higher would refuse honest slivers.
pub const LEAST_QUALITY: f64 = 1e-5;

/// An edge longer than this is most likely millimetres read as metres.
pub const LARGEST_PLAUSIBLE_EDGE: f64 = 1.0;

/// A mesh of triangles with flat rest shapes.
#[derive(Debug, Clone)]
pub struct Sheet {
    triangles: Vec<[u32; 3]>,
    rest: Vec<[Vector2<f64>; 3]>,
    inverse_rest: Vec<Matrix2<f64>>,
    areas: Vec<f64>,
    edges: Vec<Edge>,
    triangle_edges: Vec<[u32; 3]>,
    masses: Vec<f64>,
}

impl Sheet {
    /// A sheet whose panels lie in one rest plane: `rest_uv[v]` in metres, triangles
    /// counter-clockwise there, `density` in kg/m².
    ///
    /// # Errors
    /// See [`Sheet::new`].
    pub fn flat(rest_uv: &[Vector2<f64>], triangles: &[[u32; 3]], density: f64) -> Result<Self, ClothError> {
        topology::check_indices(triangles, rest_uv.len())?;
        let corners = triangles.iter().map(|t| t.map(|v| rest_uv[v as usize])).collect();
        Self::new(rest_uv.len(), triangles.to_vec(), corners, density)
    }

    /// A sheet with a rest shape of its own for every triangle.
    ///
    /// # Errors
    /// `EmptyScene`, `VertexOutOfRange`, `NonFiniteInput`, `InvalidParameter` (density),
    /// `ZeroLengthEdge`, `DegenerateTriangle`, `InvertedTriangle`, `NonManifoldEdge`.
    pub fn new(
        vertex_count: usize,
        triangles: Vec<[u32; 3]>,
        rest: Vec<[Vector2<f64>; 3]>,
        density: f64,
    ) -> Result<Self, ClothError> {
        Self::facing(vertex_count, triangles, rest, density, Facing::Alike)
    }

    /// The same of sewn panels: a seam may join the right side of one to the wrong side of the
    /// other, which is then an edge like any other.
    ///
    /// # Errors
    /// See [`Sheet::new`].
    pub fn sewn(
        vertex_count: usize,
        triangles: Vec<[u32; 3]>,
        rest: Vec<[Vector2<f64>; 3]>,
        density: f64,
    ) -> Result<Self, ClothError> {
        Self::facing(vertex_count, triangles, rest, density, Facing::Any)
    }

    fn facing(
        vertex_count: usize,
        triangles: Vec<[u32; 3]>,
        rest: Vec<[Vector2<f64>; 3]>,
        density: f64,
        facing: Facing,
    ) -> Result<Self, ClothError> {
        check_parameter("density", density, |d| d > 0.0, "above 0 kg/m^2")?;
        if triangles.is_empty() {
            return Err(ClothError::EmptyScene);
        }
        topology::check_indices(&triangles, vertex_count)?;
        for (index, corners) in rest.iter().enumerate() {
            check_corners(index, &triangles[index], corners)?;
        }
        let (edges, triangle_edges) = topology::edges(&triangles, &rest, facing)?;
        let areas: Vec<f64> = rest.iter().map(signed_area).collect();
        let masses = lump(vertex_count, &triangles, &areas, density);
        let inverse_rest = rest.iter().map(inverse).collect();
        Ok(Self { triangles, rest, inverse_rest, areas, edges, triangle_edges, masses })
    }

    /// The same sheet with a density of its own for every triangle, kg/m².
    ///
    /// # Errors
    /// `InvalidParameter` for one that is not above 0.
    pub fn weighing(mut self, density: impl Fn(usize) -> f64) -> Result<Self, ClothError> {
        let weights: Vec<f64> = (0..self.areas.len()).map(|t| density(t) * self.areas[t]).collect();
        for (t, w) in weights.iter().enumerate() {
            check_parameter("density", density(t), |_| *w > 0.0, "above 0 kg/m^2")?;
        }
        self.masses = lump(self.masses.len(), &self.triangles, &weights, 1.0);
        Ok(self)
    }

    /// How many vertices there are, used by a triangle or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.masses.len()
    }

    /// The ends and rest length of every edge, once each where a seam of more than two sheets has
    /// it as several.
    pub fn distinct_edges(&self) -> impl Iterator<Item = ([u32; 2], f64)> + '_ {
        let ends = |e: &Edge| [e.vertices[0].min(e.vertices[1]), e.vertices[0].max(e.vertices[1])];
        let is_new = move |k: usize| k == 0 || ends(&self.edges[k]) != ends(&self.edges[k - 1]);
        let edges = self.edges.iter().enumerate().filter(move |(k, _)| is_new(*k));
        edges.map(|(_, e)| (e.vertices, e.rest_length))
    }

    /// Vertices of each triangle, counter-clockwise in the rest shape.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Rest corners of each triangle in its own flat frame, metres, warp along y.
    #[must_use]
    pub fn rest(&self) -> &[[Vector2<f64>; 3]] {
        &self.rest
    }

    /// Inverse of `[b - a, c - a]` of each triangle: turns edge vectors in space into the
    /// deformation gradient.
    #[must_use]
    pub fn inverse_rest(&self) -> &[Matrix2<f64>] {
        &self.inverse_rest
    }

    /// The root of its area, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.areas().iter().sum::<f64>().sqrt()
    }

    /// Rest areas in m².
    #[must_use]
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// Every edge once, sorted by its lower, then its higher vertex.
    #[must_use]
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The edges of each triangle: entry `k` lies opposite corner `k`.
    #[must_use]
    pub fn triangle_edges(&self) -> &[[u32; 3]] {
        &self.triangle_edges
    }

    /// Lumped masses in kg; 0 for a vertex that no triangle uses.
    #[must_use]
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// The longest edge if it is implausibly long for cloth: most likely a unit mistake.
    #[must_use]
    pub fn suspicious_size(&self) -> Option<f64> {
        let longest = self.edges.iter().map(|e| e.rest_length).fold(0.0, f64::max);
        (longest > LARGEST_PLAUSIBLE_EDGE).then_some(longest)
    }

    /// Deformation gradient (3 x 2) of triangle `t` at positions `x`: columns are the images of the
    /// rest x and y axes.
    #[must_use]
    pub fn deformation(&self, t: usize, x: &[Vector3<f64>]) -> nalgebra::Matrix3x2<f64> {
        let [a, b, c] = self.triangles[t].map(|v| x[v as usize]);
        nalgebra::Matrix3x2::from_columns(&[b - a, c - a]) * self.inverse_rest[t]
    }

    /// Greatest excess of a triangle over the strain limits of weft and warp: the triangle, its
    /// strain along that yarn and the limit.
    #[must_use]
    pub fn over(&self, x: &[Vector3<f64>], limits: [f64; 2]) -> Option<(usize, f64, f64)> {
        let mut worst: Option<(usize, f64, f64)> = None;
        for t in 0..self.triangles.len() {
            let f = self.deformation(t, x);
            for (k, limit) in limits.into_iter().enumerate() {
                let strain = f.column(k).norm() - 1.0;
                if strain > limit && worst.is_none_or(|(_, s, l)| strain / limit > s / l) {
                    worst = Some((t, strain, limit));
                }
            }
        }
        worst
    }

    /// Refuses a state in which some triangle is stretched beyond `limit` (engineering strain).
    ///
    /// # Errors
    /// [`ClothError::StrainLimitExceeded`] with the worst triangle.
    pub fn check_strain(&self, x: &[Vector3<f64>], limit: f64) -> Result<(), ClothError> {
        let (index, strain) = self.greatest_strain(x);
        if strain <= limit { Ok(()) } else { Err(ClothError::StrainLimitExceeded { index, strain, limit }) }
    }

    /// Greatest engineering strain over all triangles and directions, with the triangle.
    #[must_use]
    pub fn greatest_strain(&self, x: &[Vector3<f64>]) -> (usize, f64) {
        (0..self.triangles.len())
            .map(|t| (t, largest_stretch(&self.deformation(t, x)) - 1.0))
            .fold((0, f64::NEG_INFINITY), |best, s| if s.1 > best.1 { s } else { best })
    }
}

/// Positions that are all finite, or the first that is not.
///
/// # Errors
/// [`ClothError::NonFiniteInput`].
pub fn check_finite(field: &'static str, x: &[Vector3<f64>]) -> Result<(), ClothError> {
    match x.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        Some(index) => Err(ClothError::NonFiniteInput { field, index }),
        None => Ok(()),
    }
}

/// Shape quality of a triangle with these side lengths squared summing to `sum` and this area: 1
/// equilateral, 0 flat.
#[must_use]
pub fn quality(corners: &[Vector2<f64>; 3]) -> f64 {
    let sum: f64 = (0..3).map(|k| (corners[(k + 1) % 3] - corners[k]).norm_squared()).sum();
    if sum > 0.0 { 4.0 * 3.0_f64.sqrt() * signed_area(corners).abs() / sum } else { 0.0 }
}

fn largest_stretch(f: &nalgebra::Matrix3x2<f64>) -> f64 {
    let c = f.transpose() * f;
    let (mean, half) = (0.5 * (c[(0, 0)] + c[(1, 1)]), 0.5 * (c[(0, 0)] - c[(1, 1)]));
    (mean + half.hypot(c[(0, 1)])).sqrt()
}

fn check_corners(index: usize, t: &[u32; 3], corners: &[Vector2<f64>; 3]) -> Result<(), ClothError> {
    if !corners.iter().all(|c| c.iter().all(|v| v.is_finite())) {
        return Err(ClothError::NonFiniteInput { field: "rest", index });
    }
    for k in 0..3 {
        let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
        if (corners[(k + 1) % 3] - corners[k]).norm() == 0.0 {
            return Err(ClothError::ZeroLengthEdge { a: a.min(b), b: a.max(b) });
        }
    }
    let quality = quality(corners);
    if quality < LEAST_QUALITY {
        return Err(ClothError::DegenerateTriangle { index, quality });
    }
    if signed_area(corners) < 0.0 { Err(ClothError::InvertedTriangle { index }) } else { Ok(()) }
}

fn signed_area([a, b, c]: &[Vector2<f64>; 3]) -> f64 {
    0.5 * (b - a).perp(&(c - a))
}

fn inverse([a, b, c]: &[Vector2<f64>; 3]) -> Matrix2<f64> {
    let (e, f) = (b - a, c - a);
    Matrix2::new(f.y, -f.x, -e.y, e.x) / e.perp(&f)
}

fn lump(vertex_count: usize, triangles: &[[u32; 3]], areas: &[f64], density: f64) -> Vec<f64> {
    let mut masses = vec![0.0; vertex_count];
    for (t, area) in triangles.iter().zip(areas) {
        for &v in t {
            masses[v as usize] += density * area / 3.0;
        }
    }
    masses
}

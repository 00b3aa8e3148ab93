//! The distance-to-mean-plane smoothing of a surface in space.
//!
//! Method: see `plane`. Inner vertices take the mean plane of their neighbours; border vertices the
//! mean line of the two before and the two behind, and move along the border's normal in the
//! surface. Cost: linear in the triangles, a round; one 3 by 3 eigenproblem per vertex. Limits:
//! corners of the border (above 30 degrees) and vertices within two places of one stay.

use super::topology::Neighbours;
use nalgebra::Matrix3;
use toile_core::artifact::{Point3, Vector3};

/// A border vertex where the border turns more than this (degrees) is a corner.
const CORNER: f64 = 30.0;

/// What to smooth by [`smooth_to_planes`], and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneSmoothing {
    /// Share of the way that a vertex goes in a round, 0 to 0.8.
    pub lambda: f64,
    /// Number of rounds.
    pub rounds: usize,
    /// True where border vertices stay.
    pub hold_border: bool,
}

/// A mean plane (or line, on the border): unit normal, and the vertex's signed distance.
#[derive(Debug, Clone, Copy)]
struct Mean {
    normal: Vector3,
    distance: f64,
    on_border: bool,
}

/// Smooths a surface by the distances of its vertices to their mean planes. Returns the new
/// positions, metres; triangles must be wound alike.
pub fn smooth_to_planes(positions: &[Point3], triangles: &[[u32; 3]], how: PlaneSmoothing) -> Vec<Point3> {
    let neighbours = Neighbours::new(positions.len(), triangles);
    let border = Border::new(positions.len(), triangles);
    let mut points = positions.to_vec();
    for _ in 0..how.rounds {
        let normals = vertex_normals(&points, triangles);
        let mean = |v: usize| match border.is_on(v) {
            true if how.hold_border => None,
            true => border.mean_line(&points, v, normals[v]),
            false => mean_plane(&points, neighbours.of(v), v, normals[v]),
        };
        let means: Vec<Option<Mean>> = (0..points.len()).map(mean).collect();
        let next = |v: usize| points[v] + plane_move(&points, &means, neighbours.of(v), v) * how.lambda;
        points = (0..points.len()).map(next).collect();
    }
    points
}

/// `n (dbar - d)`, over the neighbours whose distances are of the same kind.
fn plane_move(points: &[Point3], means: &[Option<Mean>], ring: &[u32], v: usize) -> Vector3 {
    let Some(own) = means[v] else { return Vector3::zeros() };
    let (mut sum, mut weight) = (0.0, 0.0);
    for &w in ring {
        let Some(other) = means[w as usize].filter(|m| m.on_border == own.on_border) else { continue };
        let share = 1.0 / (points[w as usize] - points[v]).norm().max(f64::MIN_POSITIVE);
        sum += share * other.distance;
        weight += share;
    }
    if weight > 0.0 { own.normal * (sum / weight - own.distance) } else { Vector3::zeros() }
}

/// Centre and covariance of points.
fn spread(points: &[Point3], ring: &[u32]) -> (Vector3, Matrix3<f64>) {
    let at = |w: &u32| points[*w as usize].coords;
    let centre = ring.iter().map(at).sum::<Vector3>() / ring.len() as f64;
    let matrix = ring.iter().map(|w| at(w) - centre).map(|u| u * u.transpose()).sum();
    (centre, matrix)
}

/// The mean plane of a vertex's neighbours, its normal to the side of the surface's.
fn mean_plane(points: &[Point3], ring: &[u32], v: usize, side: Vector3) -> Option<Mean> {
    if ring.len() < 3 {
        return None;
    }
    let (centre, matrix) = spread(points, ring);
    let eigen = matrix.symmetric_eigen();
    let normal: Vector3 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let normal = normal * normal.dot(&side).signum();
    Some(Mean { normal, distance: (points[v].coords - centre).dot(&normal), on_border: false })
}

/// Area-weighted vertex normals.
fn vertex_normals(points: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let mut normals = vec![Vector3::zeros(); points.len()];
    for t in triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        let n = (b - a).cross(&(c - a));
        t.iter().for_each(|&v| normals[v as usize] += n);
    }
    normals
}

/// The border's vertices and their neighbours along it.
struct Border {
    next: Vec<Option<u32>>,
    previous: Vec<Option<u32>>,
    on: Vec<bool>,
}

impl Border {
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut sides: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * triangles.len());
        for t in triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                sides.push((a.min(b), a.max(b), a < b));
            }
        }
        sides.sort_unstable();
        let mut border =
            Border { next: vec![None; vertices], previous: vec![None; vertices], on: vec![false; vertices] };
        for pair in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            if let [(low, high, forward)] = *pair {
                let (a, b) = if forward { (low, high) } else { (high, low) };
                border.next[a as usize] = Some(b);
                border.previous[b as usize] = Some(a);
                border.on[a as usize] = true;
                border.on[b as usize] = true;
            }
        }
        border
    }

    fn is_on(&self, v: usize) -> bool {
        self.on[v]
    }

    /// The four neighbours along the border, but `None` near its corners.
    fn ring(&self, points: &[Point3], v: usize) -> Option<[u32; 4]> {
        let (before, behind) = (self.previous[v]?, self.next[v]?);
        let ring = [self.previous[before as usize]?, before, behind, self.next[behind as usize]?];
        let path = [ring[0], ring[1], v as u32, ring[2], ring[3]].map(|w| points[w as usize]);
        let turn = |w: &[Point3]| (w[1] - w[0]).angle(&(w[2] - w[1]));
        path.windows(3).all(|w| turn(w) <= CORNER.to_radians()).then_some(ring)
    }

    /// The mean line of the neighbours along the border; its normal lies in the surface, outward.
    fn mean_line(&self, points: &[Point3], v: usize, surface: Vector3) -> Option<Mean> {
        let ring = self.ring(points, v)?;
        let (centre, matrix) = spread(points, &ring);
        let eigen = matrix.symmetric_eigen();
        let along: Vector3 = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into();
        let forward = points[ring[3] as usize] - points[ring[0] as usize];
        let normal = (along * along.dot(&forward).signum()).cross(&surface).try_normalize(0.0)?;
        Some(Mean { normal, distance: (points[v].coords - centre).dot(&normal), on_border: true })
    }
}

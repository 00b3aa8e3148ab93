//! A triangle and the three triangles around it at rest, unfolded: how a curvature of the sheet
//! shows in the three fold angles.
//!
//! Lifted by a quadratic surface of curvature (kxx, kyy, kxy), the small fold angle over edge k is
//! `rows[k] . curvature`, exactly. Three angles so give the curvature (the quadratic through six
//! vertices; Grinspun, Gingold, Reisman, Zorin, 2006), and with it the energy
//! `A curvature . D curvature / 2` as a quadratic form of the angles. Where an edge has no
//! neighbour its angle is left to itself: the curvature of least energy that shows the known
//! angles, which is a free edge without moment.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::flap::leaf;
use crate::fabric::Rigidity;
use crate::mesh::Sheet;
use toile_geometry::Vec3;

/// Six vertices near a conic leave a curvature that hardly shows in the angles; its compliance
/// counts at least this share of the largest, or such a triangle would lock. Irregular meshes of
/// garments stay above 0.02.
const LEAST_COMPLIANCE: f64 = 1e-3;
/// The softer direction counts at least this share of the stiffer.
const LEAST_RIGIDITY: f64 = 1e-6;

/// What lies beyond an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// Nothing.
    Free,
    /// A triangle, by its index and the corner opposite the edge.
    Triangle { index: u32, corner: u8 },
    /// A clamp: the direction in which the sheet would go on, of unit length.
    Held(Vec3),
}

/// The rest state of one triangle and its folds. Edge k lies opposite corner k.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    /// Corners, then the tips beyond the three edges; corner k again where there is none.
    pub vertices: [u32; 6],
    /// Beyond each edge.
    pub beyond: [Beyond; 3],
    /// Small fold angle over edge k = `weights[k] . lifts`, 1/m.
    pub weights: [[f64; 6]; 3],
    /// Small fold angle over edge k by curvature (kxx, kyy, kxy), m.
    pub rows: [Vector3<f64>; 3],
    /// m².
    pub area: f64,
}

/// All triangles of a sheet; `held` gives the direction beyond a clamped boundary edge.
pub(super) fn patches(sheet: &Sheet, held: impl Fn([u32; 2]) -> Option<Vec3>) -> Vec<Patch> {
    let beyond = |t: usize, k: usize| {
        let edge = &sheet.edges()[sheet.triangle_edges()[t][k] as usize];
        match edge.sides.1 {
            None => held(edge.vertices).map_or(Beyond::Free, |out| Beyond::Held(out.normalize())),
            Some(right) => {
                let other = if edge.sides.0.triangle as usize == t { right } else { edge.sides.0 };
                Beyond::Triangle { index: other.triangle, corner: other.corner }
            }
        }
    };
    (0..sheet.triangles().len())
        .map(|t| Patch::new(sheet, t, std::array::from_fn(|k| beyond(t, k))))
        .collect()
}

impl Patch {
    pub(super) fn new(sheet: &Sheet, t: usize, beyond: [Beyond; 3]) -> Self {
        let corners = sheet.triangles()[t];
        let mut patch = Self {
            vertices: std::array::from_fn(|k| corners[k % 3]),
            beyond,
            weights: [[0.0; 6]; 3],
            rows: [Vector3::zeros(); 3],
            area: sheet.areas()[t],
        };
        (0..3).for_each(|k| patch.fold(sheet, t, k));
        patch
    }

    fn fold(&mut self, sheet: &Sheet, t: usize, k: usize) {
        let rest = &sheet.rest()[t];
        let centre = (rest[0] + rest[1] + rest[2]) / 3.0;
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (a, b, p) = (rest[i] - centre, rest[j] - centre, rest[k] - centre);
        let own = leaf(sheet, t, k);
        let w = &mut self.weights[k];
        (w[i], w[j], w[k]) = (-(1.0 - own.along) / own.height, -own.along / own.height, 1.0 / own.height);
        let mut row = bend(&a) * w[i] + bend(&b) * w[j] + bend(&p) * w[k];
        match self.beyond[k] {
            Beyond::Free => (*w, row) = ([0.0; 6], Vector3::zeros()),
            // The surface keeps its own slope at the middle of the edge.
            Beyond::Held(_) => {
                let (n, m) = (own.across, 0.5 * (a + b));
                row += Vector3::new(n.x * m.x, n.y * m.y, n.x * m.y + n.y * m.x);
            }
            Beyond::Triangle { index, corner } => {
                let other = leaf(sheet, index as usize, corner as usize);
                // It runs through the edge backwards.
                let (at_a, at_b) = (-other.along / other.height, -(1.0 - other.along) / other.height);
                let tip = b + (a - b) * other.along + own.across * other.height;
                row += bend(&a) * at_a + bend(&b) * at_b + bend(&tip) / other.height;
                (w[i], w[j], w[3 + k]) = (w[i] + at_a, w[j] + at_b, 1.0 / other.height);
                self.vertices[3 + k] = sheet.triangles()[index as usize][corner as usize];
            }
        }
        self.rows[k] = row;
    }

    /// Stiffness between the three angles for a rigidity `d` of (kxx, kyy, kxy): energy =
    /// `angles . K angles / 2`.
    pub(super) fn stiffness(&self, d: &Matrix3<f64>) -> Matrix3<f64> {
        let Some(inverse) = d.try_inverse() else { return Matrix3::zeros() };
        let b = Matrix3::from_rows(&self.rows.map(|r| r.transpose()));
        let compliance = b * inverse * b.transpose();
        let scale = compliance.diagonal().map(|c| if c > 0.0 { c.sqrt().recip() } else { 0.0 });
        let scaled = Matrix3::from_fn(|i, j| compliance[(i, j)] * scale[i] * scale[j]);
        let eigen = nalgebra::SymmetricEigen::new(0.5 * (scaled + scaled.transpose()));
        let stiff = eigen.eigenvalues.map(|e| e.max(LEAST_COMPLIANCE).recip());
        let k = eigen.eigenvectors * Matrix3::from_diagonal(&stiff) * eigen.eigenvectors.transpose();
        Matrix3::from_fn(|i, j| self.area * k[(i, j)] * scale[i] * scale[j])
    }
}

/// Lift of each unit curvature at a place.
fn bend(p: &Vector2<f64>) -> Vector3<f64> {
    Vector3::new(0.5 * p.x * p.x, 0.5 * p.y * p.y, p.x * p.y)
}

impl Rigidity {
    /// By (kxx, kyy, kxy), Poisson's ratio 0, twist so that a cylinder along (x, y) has
    /// `weft x² + warp y²`.
    pub(super) fn tensor(&self) -> Matrix3<f64> {
        let least = LEAST_RIGIDITY * self.warp.max(self.weft);
        let (weft, warp) = (self.weft.max(least), self.warp.max(least));
        Matrix3::from_diagonal(&Vector3::new(weft, warp, weft + warp))
    }
}

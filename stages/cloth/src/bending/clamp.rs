//! A held slope along a boundary edge, beside lone hinges: the sheet is continued beyond the edge by its own mirror image in a fixed plane.
//!
//! The mirrored half takes half the energy of a fold of twice the angle, so `E = k theta² / 2` with `k = f D |e|² / A`, theta the
//! angle between the edge's triangle and the plane. Pinning a second row of vertices in place of this makes the
//! sheet half a triangle too long; the mirror image does not.

use nalgebra::Matrix3;

use super::Rigidity;
use super::angle::{Leaf, angle};
use super::flap::leaf;
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

#[derive(Debug, Clone, Copy)]
struct Held {
    vertices: [u32; 3],
    outward: Vec3,
    stiffness: f64,
}

/// Boundary edges with a held slope; pin their vertices as well.
#[derive(Debug, Clone)]
pub struct Clamp {
    held: Vec<Held>,
}

impl Clamp {
    /// Clamps every boundary edge whose two vertices are `chosen`; `outward` is the direction in which the sheet would go on
    /// beyond the edge, `factor` the calibration of the bending model beside it.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(
        sheet: &Sheet,
        rigidity: &Rigidity,
        factor: f64,
        chosen: impl Fn(u32) -> bool,
        outward: impl Fn(u32) -> Vec3,
    ) -> Result<Assembled<3, Self>, ClothError> {
        rigidity.check()?;
        let edges = sheet.edges().iter().filter(|e| e.is_boundary() && e.vertices.iter().all(|&v| chosen(v)));
        let held = edges.map(|e| {
            let side = e.sides.0;
            let d = rigidity.along(&leaf(sheet, side.triangle as usize, side.corner as usize).across);
            let area = sheet.areas()[side.triangle as usize];
            Held {
                vertices: [e.vertices[0], e.vertices[1], side.opposite],
                outward: outward(e.vertices[0]),
                stiffness: factor * d * e.rest_length * e.rest_length / area,
            }
        });
        Ok(Assembled(Self { held: held.collect() }))
    }
}

impl Held {
    fn angle(&self, x: &[Vec3; 3]) -> f64 {
        angle(&x[0], &x[1], &x[2], &(x[0] + self.outward))
    }

    /// The plane is fixed in space: its tip moves with the edge, so its own turning must be taken back.
    fn leaves(&self, x: &[Vec3; 3]) -> (Leaf, Leaf) {
        (Leaf::new(&x[0], &x[1], &x[2], false), Leaf::new(&x[0], &x[1], &(x[0] + self.outward), true))
    }

    fn gradient(&self, x: &[Vec3; 3]) -> [Vec3; 3] {
        let (l, r) = self.leaves(x);
        let (l, r) = (l.gradient(), r.gradient());
        [l[0] + r[0] + r[2], l[1] + r[1], l[2]]
    }
}

impl Element<3> for Clamp {
    fn name(&self) -> &'static str {
        "clamped edge"
    }

    fn count(&self) -> usize {
        self.held.len()
    }

    fn vertices(&self, e: usize) -> [u32; 3] {
        self.held[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 3]) -> f64 {
        0.5 * self.held[e].stiffness * self.held[e].angle(x).powi(2)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let moment = self.held[e].stiffness * self.held[e].angle(x);
        self.held[e].gradient(x).map(|g| g * moment)
    }

    fn hessian(&self, e: usize, x: &[Vec3; 3], projection: Projection) -> [[Matrix3<f64>; 3]; 3] {
        let (held, g) = (&self.held[e], self.held[e].gradient(x));
        let mut h =
            std::array::from_fn(|i| std::array::from_fn(|j| g[i] * g[j].transpose() * held.stiffness));
        if projection == Projection::Exact {
            let moment = held.stiffness * held.angle(x);
            let (left, right) = held.leaves(x);
            let (l, r) = (left.hessian(), right.hessian());
            // The right tip moves with the edge's start.
            let at = [0, 1, 0];
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += l[i][j] * moment;
                    h[at[i]][at[j]] += r[i][j] * moment;
                }
            }
        }
        h
    }
}

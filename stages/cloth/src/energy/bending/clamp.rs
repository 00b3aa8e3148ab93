//! A held slope along a boundary edge: the sheet is continued beyond the edge by its own mirror
//! image in a fixed plane.
//!
//! The mirrored half takes half the energy of a fold of twice the angle, so `E = k theta² / 2` with
//! `k = f D |e|² / A`, theta the angle between the edge's triangle and the plane, f the calibration
//! of the hinges. Pinning a second row of vertices in place of this makes the sheet half a triangle
//! too long; the mirror image does not. [`super::Hinge`] has clamps of its own.

use super::angle::{Leaf, angle};
use super::flap::leaf;
use crate::energy::{Assembled, Blocks, Cloth, Element, Projection, Subset, Vec3, add_block_of};
use nalgebra::Matrix3;

#[derive(Debug, Clone, Copy)]
struct ClampedTriangle {
    nodes: [u32; 3],
    outward: Vec3,
    stiffness: f64,
}

/// Boundary edges with a held slope; their nodes must be pinned as well.
#[derive(Debug, Clone)]
pub struct ClampedEdge {
    held: Vec<ClampedTriangle>,
}

impl ClampedEdge {
    /// The edges that the cloth's clamp holds.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<3, Self> {
        let (sheet, factor) = (cloth.sheet, cloth.calibration().factor);
        let edges = sheet.edges().iter().filter(|e| e.is_boundary());
        let held = edges.filter_map(|e| {
            let (side, outward) = (e.sides.0, cloth.beyond(e.vertices)?);
            let t = side.triangle as usize;
            let d = cloth.rigidity(t).along(&leaf(sheet, t, side.corner as usize).across);
            let stiffness = factor * d * e.rest_length * e.rest_length / sheet.areas()[t];
            Some(ClampedTriangle { nodes: [e.vertices[0], e.vertices[1], side.opposite], outward, stiffness })
        });
        Assembled(Self { held: held.collect() })
    }
}

impl ClampedTriangle {
    fn angle(&self, x: &[Vec3; 3]) -> f64 {
        angle(&x[0], &x[1], &x[2], &(x[0] + self.outward))
    }

    /// The plane is fixed in space, but its tip moves with the edge: the turning that this causes
    /// is subtracted.
    fn leaves(&self, x: &[Vec3; 3]) -> (Leaf, Leaf) {
        (Leaf::new(&x[0], &x[1], &x[2], false), Leaf::new(&x[0], &x[1], &(x[0] + self.outward), true))
    }

    fn gradient(&self, x: &[Vec3; 3]) -> [Vec3; 3] {
        let (l, r) = self.leaves(x);
        let (l, r) = (l.gradient(), r.gradient());
        [l[0] + r[0] + r[2], l[1] + r[1], l[2]]
    }
}

impl Element<3> for ClampedEdge {
    type State = Blocks<3>;

    fn name(&self) -> &'static str {
        "clamped edge"
    }

    fn count(&self) -> usize {
        self.held.len()
    }

    fn nodes(&self, e: usize) -> [u32; 3] {
        self.held[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 3]) -> f64 {
        0.5 * self.held[e].stiffness * self.held[e].angle(x).powi(2)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let moment = self.held[e].stiffness * self.held[e].angle(x);
        self.held[e].gradient(x).map(|g| g * moment)
    }

    fn state(&self, e: usize, x: &[Vec3; 3], form: Projection) -> Blocks<3> {
        let (held, g) = (&self.held[e], self.held[e].gradient(x));
        let mut h =
            std::array::from_fn(|i| std::array::from_fn(|j| g[i] * g[j].transpose() * held.stiffness));
        if form == Projection::Exact {
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
    fn add_block(&self, _: usize, state: &Blocks<3>, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        add_block_of(state, row, column, sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let held =
            |&e: &usize| ClampedTriangle { nodes: subset.renumbered(self.held[e].nodes), ..self.held[e] };
        Self { held: elements.iter().map(held).collect() }
    }

    fn scale_bending(&mut self, by: f64) {
        self.held.iter_mut().for_each(|h| h.stiffness *= by);
    }
}

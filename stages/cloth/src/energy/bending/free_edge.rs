//! Takes the quadratic hinges' false Poisson's ratio out of free edges, as a quadratic form.
//!
//! Hinges on equilateral triangles bend with Poisson's ratio -1/3: a narrow strip, free to curl
//! across, is 11 % too soft, although a plate is right. The part of the bending energy that carries
//! the ratio is `-(1 - nu) D` times the integral of Gaussian curvature, and by Gauss and Bonnet
//! that integral is the sum of the corner angles along the border, up to a constant. So raising the
//! ratio to 0 charges that sum. To second order in the lifts of a flat sheet an angle theta between
//! sides of lengths l1 and l2 grows by `(-a b + cos(theta) (a.a + b.b) / 2) / sin(theta)`, a and b
//! the lifts along the sides over their lengths. As in the hinge, the lift is replaced by the
//! position in space: over a closed border the form is zero for every affine image of the rest
//! shape, so it neither moves nor stretches a flat sheet, and its matrix never changes. Alone it is
//! indefinite; with the hinges it is the bending energy of a plate of Poisson's ratio 0.

use crate::energy::{Assembled, Cloth, Element, Projection, Subset, Vec3};
use nalgebra::Matrix3;

/// One corner at a border node.
#[derive(Debug, Clone, Copy)]
struct Corner {
    /// Apex, then the other two.
    nodes: [u32; 3],
    /// One over the lengths of the two sides, 1/m.
    inverse: [f64; 2],
    /// Stiffness of each side with itself and with the other, N m.
    own: f64,
    mixed: f64,
}

/// The corners at all free border nodes.
#[derive(Debug, Clone)]
pub struct FreeEdge {
    corners: Vec<Corner>,
}

impl FreeEdge {
    /// For quadratic hinges of the same cloth. Where a border node is fixed its Gauss-Bonnet sum is
    /// held as well, and it is left out.
    #[must_use]
    pub fn new(cloth: &Cloth<'_>) -> Assembled<3, Self> {
        let (sheet, calibration) = (cloth.sheet, cloth.calibration());
        let moment = |t: usize| {
            let bend = cloth.rigidity(t);
            -calibration.poisson * calibration.factor * 0.5 * (bend.warp + bend.weft)
        };
        let is_fixed = |v: u32| cloth.fixed.get(v as usize).is_some_and(|f| *f);
        let mut on_border = vec![false; sheet.vertex_count()];
        for e in sheet.edges().iter().filter(|e| e.is_boundary()) {
            e.vertices.iter().for_each(|&v| on_border[v as usize] = !is_fixed(v));
        }
        let mut corners = Vec::new();
        for (t, (nodes, rest)) in sheet.triangles().iter().zip(sheet.rest()).enumerate() {
            for k in (0..3).filter(|&k| on_border[nodes[k] as usize]) {
                let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                let (u, v) = (rest[i] - rest[k], rest[j] - rest[k]);
                let product = u.norm() * v.norm();
                let (cosine, sine) = (u.dot(&v) / product, u.perp(&v) / product);
                corners.push(Corner {
                    nodes: [nodes[k], nodes[i], nodes[j]],
                    inverse: [1.0 / u.norm(), 1.0 / v.norm()],
                    own: moment(t) * cosine / sine,
                    mixed: -moment(t) / sine,
                });
            }
        }
        Assembled(Self { corners })
    }
}

impl Corner {
    fn slopes(&self, [apex, i, j]: &[Vec3; 3]) -> [Vec3; 2] {
        [(i - apex) * self.inverse[0], (j - apex) * self.inverse[1]]
    }

    /// The entry of the matrix by these two of its nodes.
    fn entry(&self, row: usize, column: usize) -> f64 {
        let [p, q] = self.inverse;
        let (ii, jj, ij) = (self.own * p * p, self.own * q * q, self.mixed * p * q);
        match (row.min(column), row.max(column)) {
            (0, 0) => ii + jj + 2.0 * ij,
            (1, 1) => ii,
            (2, 2) => jj,
            (0, 1) => -ii - ij,
            (0, 2) => -jj - ij,
            _ => ij,
        }
    }
}

impl Element<3> for FreeEdge {
    type State = ();

    fn name(&self) -> &'static str {
        "free edges"
    }

    fn count(&self) -> usize {
        self.corners.len()
    }

    fn nodes(&self, e: usize) -> [u32; 3] {
        self.corners[e].nodes
    }

    fn value(&self, e: usize, x: &[Vec3; 3]) -> f64 {
        let corner = &self.corners[e];
        let [a, b] = corner.slopes(x);
        0.5 * corner.own * (a.norm_squared() + b.norm_squared()) + corner.mixed * a.dot(&b)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let corner = &self.corners[e];
        let [a, b] = corner.slopes(x);
        let (ga, gb) = (
            (a * corner.own + b * corner.mixed) * corner.inverse[0],
            (b * corner.own + a * corner.mixed) * corner.inverse[1],
        );
        [-(ga + gb), ga, gb]
    }

    fn state(&self, _: usize, _: &[Vec3; 3], _: Projection) {}

    fn add_block(&self, e: usize, (): &(), row: usize, column: usize, sum: &mut Matrix3<f64>) {
        let k = self.corners[e].entry(row, column);
        (0..3).for_each(|c| sum[(c, c)] += k);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let corner =
            |&e: &usize| Corner { nodes: subset.renumbered(self.corners[e].nodes), ..self.corners[e] };
        Self { corners: elements.iter().map(corner).collect() }
    }

    fn is_constant(&self) -> bool {
        true
    }

    fn scale_bending(&mut self, by: f64) {
        for c in &mut self.corners {
            c.own *= by;
            c.mixed *= by;
        }
    }
}

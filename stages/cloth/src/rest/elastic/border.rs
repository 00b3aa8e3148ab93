//! The free edges' correction of the hinges' Poisson's ratio, as a quadratic form.
//!
//! `bending::FreeEdge` charges the sum of the corner angles along the border. To second order in the lifts of a flat sheet an angle
//! theta between sides of lengths l1 and l2 grows by `(-a b + cos(theta) (a.a + b.b) / 2) / sin(theta)`, a and b the lifts along the sides over their
//! lengths. As in the quadratic hinge, the lift is replaced by the position in space: over a closed border the form is zero for
//! every affine image of the rest shape (Gauss, Bonnet), so it neither moves nor stretches a flat sheet, and its matrix never changes.
//! Alone it is indefinite; with the hinges it is the bending energy of a plate of Poisson's ratio 0.

use crate::mesh::Sheet;
use crate::rest::part::Cut;
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// One corner at a border vertex.
#[derive(Debug, Clone)]
pub(super) struct Border {
    /// Apex, then the other two.
    nodes: [u32; 3],
    /// One over the lengths of the two sides, 1/m.
    inverse: [f64; 2],
    /// Stiffness of each side with itself and with the other, N m.
    own: f64,
    mixed: f64,
}

/// The corners at all border vertices; `moment(t)` is what a radian costs in triangle `t`, J.
pub(super) fn borders(sheet: &Sheet, moment: impl Fn(usize) -> f64) -> Vec<Border> {
    let mut on_border = vec![false; sheet.vertex_count()];
    for e in sheet.edges().iter().filter(|e| e.is_boundary()) {
        e.vertices.iter().for_each(|&v| on_border[v as usize] = true);
    }
    let mut borders = Vec::new();
    for (t, (nodes, rest)) in sheet.triangles().iter().zip(sheet.rest()).enumerate() {
        for k in (0..3).filter(|&k| on_border[nodes[k] as usize]) {
            let [i, j] = [(k + 1) % 3, (k + 2) % 3];
            let (u, v) = (rest[i] - rest[k], rest[j] - rest[k]);
            let product = u.norm() * v.norm();
            let (cosine, sine) = (u.dot(&v) / product, u.perp(&v) / product);
            borders.push(Border {
                nodes: [nodes[k], nodes[i], nodes[j]],
                inverse: [1.0 / u.norm(), 1.0 / v.norm()],
                own: moment(t) * cosine / sine,
                mixed: -moment(t) / sine,
            });
        }
    }
    borders
}

impl Border {
    pub(super) fn stiffen(&mut self, by: f64) {
        self.own *= by;
        self.mixed *= by;
    }

    /// It among the nodes of a part, if an awake one is among its own.
    pub(super) fn part(&self, cut: &Cut) -> Option<Self> {
        cut.wakes(&self.nodes).then(|| Self { nodes: cut.renamed(self.nodes), ..self.clone() })
    }

    fn slopes(&self, x: &[Vec3]) -> [Vec3; 2] {
        let [apex, i, j] = self.nodes.map(|n| x[n as usize]);
        [(i - apex) * self.inverse[0], (j - apex) * self.inverse[1]]
    }

    pub(super) fn value(&self, x: &[Vec3]) -> f64 {
        let [a, b] = self.slopes(x);
        0.5 * self.own * (a.norm_squared() + b.norm_squared()) + self.mixed * a.dot(&b)
    }

    pub(super) fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let [a, b] = self.slopes(x);
        let (ga, gb) = (
            (a * self.own + b * self.mixed) * self.inverse[0],
            (b * self.own + a * self.mixed) * self.inverse[1],
        );
        let [apex, i, j] = self.nodes.map(|n| n as usize);
        gradient[apex] -= ga + gb;
        gradient[i] += ga;
        gradient[j] += gb;
    }

    /// Hands each entry of the matrix below and on the diagonal to `add`.
    pub(super) fn add_to(&self, mut add: impl FnMut(u32, u32, f64)) {
        let [p, q] = self.inverse;
        let (ii, jj, ij) = (self.own * p * p, self.own * q * q, self.mixed * p * q);
        let [apex, i, j] = self.nodes;
        add(apex, apex, ii + jj + 2.0 * ij);
        add(i, i, ii);
        add(j, j, jj);
        add(apex, i, -ii - ij);
        add(apex, j, -jj - ij);
        add(i, j, ij);
    }
}

//! Constant-strain triangles: from a law of the metric to forces on the corners.
//!
//! The images u and v of the rest axes are linear in the corners (linear shape functions). A law
//! gives the energy per rest area by their squares and their product, the second Piola-Kirchhoff
//! stress S and its tangent C by Green's strain, `E11 = (u.u - 1) / 2` and its like. The second
//! derivative falls into a part of C and a part of S that are each made positive semi-definite on
//! their own: C by the law, S by clamping its two principal values at zero, which costs two square
//! roots (the tension field of Choi and Ko, 2002, put into Newton's matrix). A stress that the last
//! step predicted stands in for that of the new places, whose strain has an error of second order
//! times a great stiffness (the mixed form of Magisano, Leonetti, Garcea, 2017).

use crate::energy::{Assembled, Element, Projection, Subset, Vec3};
use crate::mesh::Sheet;
use nalgebra::{Matrix2, Matrix3, Vector2};
use rayon::prelude::*;

/// Elements of one task.
const TASK: usize = 2048;

/// Stress and tangent by (weft, warp, shear) strain, N/m; the third strain is u.v, twice Green's
/// shear strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// S11, S22, S12.
    pub stress: [f64; 3],
    /// Tangent: 11, 22, 33, 12, 13, 23.
    pub tangent: [f64; 6],
}

/// A hyperelastic law of a sheet, by `[u.u, v.v, u.v]`, u and v the images of the rest x axis
/// (weft) and y axis (warp).
pub trait Law: Clone + Send + Sync + 'static {
    /// Its name in reports.
    fn name(&self) -> &'static str;

    /// Energy per rest area, J/m².
    fn density(&self, metric: [f64; 3]) -> f64;

    /// Second Piola-Kirchhoff stress, N/m.
    fn stress(&self, metric: [f64; 3]) -> [f64; 3];

    /// Stress and its tangent: the exact one, or a positive semi-definite one near it.
    fn response(&self, metric: [f64; 3], exact: bool) -> Response;
}

#[derive(Debug, Clone)]
struct Triangle {
    nodes: [u32; 3],
    /// Which law.
    law: u32,
    /// Derivative of u and v by each corner.
    shape: [Vector2<f64>; 3],
    area: f64,
}

/// Linear triangles, each with one of some laws.
#[derive(Debug, Clone)]
pub struct Triangles<L> {
    laws: Vec<L>,
    triangles: Vec<Triangle>,
    /// Stress of each triangle as the last step predicted it: weft, warp, shear, N/m. Empty before
    /// the first.
    predicted: Vec<[f64; 3]>,
}

/// A deformed triangle: the images of the rest axes, and how its stress changes, times its area.
#[derive(Debug, Clone, Copy)]
pub struct Deformed {
    u: Vec3,
    v: Vec3,
    /// N: entries 11, 22, 33, 12, 13, 23.
    tangent: [f64; 6],
    /// N.
    stress: Matrix2<f64>,
}

impl<L: Law> Triangles<L> {
    /// The membrane of a sheet with one law.
    #[must_use]
    pub fn new(sheet: &Sheet, law: L) -> Assembled<3, Self> {
        Self::with(sheet, vec![law], |_| 0)
    }

    /// The same where triangle `t` has `laws[of(t)]`.
    #[must_use]
    pub fn with(sheet: &Sheet, laws: Vec<L>, of: impl Fn(usize) -> usize) -> Assembled<3, Self> {
        let triangle = |t: usize| {
            let inverse = sheet.inverse_rest()[t];
            let (b, c) = (inverse.row(0).transpose(), inverse.row(1).transpose());
            let law = of(t) as u32;
            Triangle { nodes: sheet.triangles()[t], law, shape: [-b - c, b, c], area: sheet.areas()[t] }
        };
        let triangles = (0..sheet.triangles().len()).map(triangle).collect();
        Assembled(Self { laws, triangles, predicted: Vec::new() })
    }

    #[inline]
    fn law(&self, t: usize) -> &L {
        &self.laws[self.triangles[t].law as usize]
    }
}

impl Triangle {
    /// The images of the rest x and y axes.
    #[inline]
    fn columns(&self, [a, b, c]: &[Vec3; 3]) -> (Vec3, Vec3) {
        let [sa, sb, sc] = &self.shape;
        (a * sa.x + b * sb.x + c * sc.x, a * sa.y + b * sb.y + c * sc.y)
    }

    /// The stress after `moves` if strain were linear in them.
    fn predict(&self, law: &impl Law, x: &[Vec3], moves: &[Vec3]) -> [f64; 3] {
        let (u, v) = self.columns(&self.nodes.map(|i| x[i as usize]));
        let (du, dv) = self.columns(&self.nodes.map(|i| moves[i as usize]));
        let Response { stress: [su, sv, ss], tangent: [c11, c22, c33, c12, c13, c23] } =
            law.response(metric(&u, &v), false);
        let (eu, ev, es) = (u.dot(&du), v.dot(&dv), u.dot(&dv) + v.dot(&du));
        [
            su + c11 * eu + c12 * ev + c13 * es,
            sv + c12 * eu + c22 * ev + c23 * es,
            ss + c13 * eu + c23 * ev + c33 * es,
        ]
    }
}

impl<L: Law> Element<3> for Triangles<L> {
    type State = Deformed;

    fn name(&self) -> &'static str {
        self.laws.first().map_or("membrane", Law::name)
    }

    fn count(&self) -> usize {
        self.triangles.len()
    }

    #[inline]
    fn nodes(&self, t: usize) -> [u32; 3] {
        self.triangles[t].nodes
    }

    fn value(&self, t: usize, x: &[Vec3; 3]) -> f64 {
        let (u, v) = self.triangles[t].columns(x);
        self.triangles[t].area * self.law(t).density(metric(&u, &v))
    }

    fn gradient(&self, t: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let triangle = &self.triangles[t];
        let (u, v) = triangle.columns(x);
        let [su, sv, ss] = self.law(t).stress(metric(&u, &v)).map(|s| s * triangle.area);
        let (pu, pv) = (u * su + v * ss, v * sv + u * ss);
        triangle.shape.map(|b| pu * b.x + pv * b.y)
    }

    fn state(&self, t: usize, x: &[Vec3; 3], form: Projection) -> Deformed {
        let area = self.triangles[t].area;
        let (u, v) = self.triangles[t].columns(x);
        let response = self.law(t).response(metric(&u, &v), form == Projection::Exact);
        let stress = self.predicted.get(t).copied().unwrap_or(response.stress);
        let compression = form.compression();
        let mixed = tension(stress) * (1.0 - compression) + square(stress) * compression;
        Deformed { u, v, tangent: response.tangent.map(|c| c * area), stress: mixed * area }
    }

    #[inline]
    fn add_block(&self, t: usize, state: &Deformed, row: usize, column: usize, sum: &mut Matrix3<f64>) {
        let shape = &self.triangles[t].shape;
        state.add_block(&shape[row], &shape[column], sum);
    }

    fn part(&self, elements: &[usize], subset: &Subset) -> Self {
        let triangle = |&t: &usize| {
            let whole = &self.triangles[t];
            Triangle { nodes: subset.renumbered(whole.nodes), ..whole.clone() }
        };
        Self {
            laws: self.laws.clone(),
            triangles: elements.iter().map(triangle).collect(),
            predicted: elements.iter().filter_map(|&t| self.predicted.get(t)).copied().collect(),
        }
    }

    fn predict(&mut self, x: &[Vec3], moves: &[Vec3]) {
        let Self { triangles, laws, predicted } = self;
        predicted.resize(triangles.len(), [0.0; 3]);
        let predict = |(p, t): (&mut [f64; 3], &Triangle)| *p = t.predict(&laws[t.law as usize], x, moves);
        predicted.par_iter_mut().zip(&*triangles).with_min_len(TASK).for_each(predict);
    }

    fn merge(&mut self, elements: &[usize], part: &Self) {
        if self.predicted.len() == self.triangles.len() {
            elements.iter().zip(&part.predicted).for_each(|(&t, new)| self.predicted[t] = *new);
        }
    }
}

impl Deformed {
    /// Adds the block of two corners, of which `p` and `q` are the derivatives of the deformation
    /// gradient's columns.
    #[inline]
    fn add_block(&self, p: &Vector2<f64>, q: &Vector2<f64>, sum: &mut Matrix3<f64>) {
        let [c11, c22, c33, c12, c13, c23] = self.tangent;
        // How the two stretches and the shear change with the corners.
        let rows = [self.u * p.x, self.v * p.y, self.u * p.y + self.v * p.x];
        let [e, f, g] = [self.u * q.x, self.v * q.y, self.u * q.y + self.v * q.x];
        let stresses =
            [e * c11 + f * c12 + g * c13, e * c12 + f * c22 + g * c23, e * c13 + f * c23 + g * c33];
        let geometric = p.dot(&(self.stress * q));
        for c in 0..3 {
            let column = rows[0] * stresses[0][c] + rows[1] * stresses[1][c] + rows[2] * stresses[2][c];
            (0..3).for_each(|r| sum[(r, c)] += column[r]);
            sum[(c, c)] += geometric;
        }
    }
}

/// The squares and the product of the images of the rest x and y axes.
#[inline]
fn metric(u: &Vec3, v: &Vec3) -> [f64; 3] {
    [u.norm_squared(), v.norm_squared(), u.dot(v)]
}

/// The stress as a matrix.
fn square([u, v, s]: [f64; 3]) -> Matrix2<f64> {
    Matrix2::new(u, s, s, v)
}

/// The stress with its compressive part taken away.
fn tension([u, v, s]: [f64; 3]) -> Matrix2<f64> {
    let (mean, half) = (0.5 * (u + v), (0.5 * (u - v)).hypot(s));
    let (low, high) = (mean - half, mean + half);
    if low >= 0.0 {
        return Matrix2::new(u, s, s, v);
    }
    if high <= 0.0 || half == 0.0 {
        return Matrix2::zeros();
    }
    // The projector on the direction of the greater principal stress.
    Matrix2::new(u - low, s, s, v - low) * (high / (high - low))
}

//! The sheet's own resistance, in the form the rest solver wants: one pass for the gradient and a positive semi-definite
//! matrix.
//!
//! Membrane: St Venant-Kirchhoff triangles with a warp, a weft and a shear modulus; the part of the second derivative that
//! the stress makes is projected by clamping the two principal stresses at zero, which costs two square roots a triangle
//! (the tension field of Choi and Ko 2002 put into Newton's matrix). Bending: the quadratic isometric model (Bergou et al.
//! 2006), whose matrix never changes. Cost O(triangles).

use super::pattern::{Pattern, Slot, add_at};
use crate::mesh::Sheet;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rayon::prelude::*;

type Vec3 = Vector3<f64>;

/// What the membrane and the bending resist with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// Tensile stiffness along the rest x axis (weft), N/m.
    pub weft: f64,
    /// Tensile stiffness along the rest y axis (warp), N/m.
    pub warp: f64,
    /// Shear stiffness, N/m per unit of shear angle.
    pub shear: f64,
    /// Bending stiffness, N m.
    pub bend: f64,
}

#[derive(Debug, Clone)]
struct Triangle {
    nodes: [u32; 3],
    /// Derivative of the deformation gradient's two columns by each corner.
    shape: [Vector2<f64>; 3],
    area: f64,
}

#[derive(Debug, Clone)]
struct Hinge {
    nodes: [u32; 4],
    /// Cotangent weights; their sum is zero.
    weights: [f64; 4],
    stiffness: f64,
}

/// The elastic energy of a sheet.
#[derive(Debug, Clone)]
pub struct Elastic {
    stiffness: Stiffness,
    triangles: Vec<Triangle>,
    hinges: Vec<Hinge>,
    slots: Vec<[Slot; 6]>,
    bending: Vec<(u32, f64)>,
    /// Stress of each triangle as the last step foretold it: weft, warp, shear, N/m.
    foretold: Vec<[f64; 3]>,
}

/// Elements that one task evaluates.
const CHUNK: usize = 512;

/// The pairs of corners of a triangle, row before column.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

impl Elastic {
    /// Prepares the sheet's elements.
    #[must_use]
    pub fn new(sheet: &Sheet, stiffness: Stiffness) -> Self {
        let triangles = (0..sheet.triangles().len()).map(|t| triangle(sheet, t)).collect();
        let hinges = sheet.edges().iter().filter_map(|e| hinge(sheet, e, stiffness.bend)).collect();
        Self { stiffness, triangles, hinges, slots: Vec::new(), bending: Vec::new(), foretold: Vec::new() }
    }

    /// The groups of nodes that it couples.
    pub fn couplings(&self) -> impl Iterator<Item = &[u32]> {
        self.triangles.iter().map(|t| &t.nodes[..]).chain(self.hinges.iter().map(|h| &h.nodes[..]))
    }

    /// Looks up where its blocks go. The pattern must hold its couplings.
    pub fn bind(&mut self, pattern: &Pattern) {
        let none = Slot { index: 0, flipped: false };
        let at = |i: u32, j: u32| pattern.slot(i, j).unwrap_or(none);
        self.slots = self.triangles.iter().map(|t| PAIRS.map(|(a, b)| at(t.nodes[a], t.nodes[b]))).collect();
        let mut bending = vec![0.0; pattern.blocks()];
        for h in &self.hinges {
            for a in 0..4 {
                for b in 0..=a {
                    bending[at(h.nodes[a], h.nodes[b]).index as usize] +=
                        h.stiffness * h.weights[a] * h.weights[b];
                }
            }
        }
        self.bending =
            bending.into_iter().enumerate().filter(|(_, k)| *k != 0.0).map(|(i, k)| (i as u32, k)).collect();
    }

    /// Remembers the stress that the linear model foretells for `moves` from `x`.
    pub fn foretell(&mut self, x: &[Vec3], moves: &[Vec3]) {
        let s = self.stiffness;
        self.foretold =
            self.triangles.par_iter().with_min_len(CHUNK).map(|t| t.foretell(&s, x, moves)).collect();
    }

    /// Energy, J.
    #[must_use]
    pub fn value(&self, x: &[Vec3]) -> f64 {
        let s = &self.stiffness;
        let membrane = |t: &Triangle| {
            let (u, v) = t.columns(x);
            let (eu, ev, shear) = strain(&u, &v);
            0.5 * t.area * (s.weft * eu * eu + s.warp * ev * ev + s.shear * shear * shear)
        };
        let bending = |h: &Hinge| 0.5 * h.stiffness * h.curvature(x).norm_squared();
        sum(&self.triangles, membrane) + sum(&self.hinges, bending)
    }

    /// Adds the derivative of the energy, N.
    pub fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let s = &self.stiffness;
        let forces = |t: &Triangle| {
            let (u, v) = t.columns(x);
            let (eu, ev, shear) = strain(&u, &v);
            let (tu, tv, ts) = (s.weft * eu * t.area, s.warp * ev * t.area, s.shear * shear * t.area);
            let (pu, pv) = (u * tu + v * ts, v * tv + u * ts);
            t.shape.map(|b| pu * b.x + pv * b.y)
        };
        let membrane: Vec<[Vec3; 3]> = self.triangles.par_iter().with_min_len(CHUNK).map(forces).collect();
        for (t, f) in self.triangles.iter().zip(&membrane) {
            t.nodes.iter().zip(f).for_each(|(&i, f)| gradient[i as usize] += f);
        }
        let moments: Vec<Vec3> =
            self.hinges.par_iter().with_min_len(CHUNK).map(|h| h.curvature(x) * h.stiffness).collect();
        for (h, moment) in self.hinges.iter().zip(&moments) {
            h.nodes.iter().zip(&h.weights).for_each(|(&i, w)| gradient[i as usize] += moment * *w);
        }
    }

    /// Adds the second derivative with the foretold stress, N/m; positive semi-definite without `compression`.
    pub fn add_matrix(&self, x: &[Vec3], compression: bool, values: &mut [Matrix3<f64>]) {
        let blocks = |(k, t): (usize, &Triangle)| {
            let stress = self.foretold.get(k).copied().unwrap_or_else(|| t.stress(&self.stiffness, x));
            t.blocks(&self.stiffness, if compression { square(stress) } else { tension(stress) }, x)
        };
        let blocks: Vec<[Matrix3<f64>; 6]> =
            self.triangles.par_iter().enumerate().with_min_len(CHUNK).map(blocks).collect();
        for (blocks, slots) in blocks.iter().zip(&self.slots) {
            blocks.iter().zip(slots).for_each(|(block, slot)| add_at(values, *slot, block));
        }
        for &(slot, k) in &self.bending {
            let block = &mut values[slot as usize];
            (0..3).for_each(|c| block[(c, c)] += k);
        }
    }
}

/// A sum in chunks of fixed size: the same bits for any number of threads.
fn sum<T: Sync>(of: &[T], f: impl Fn(&T) -> f64 + Sync) -> f64 {
    let parts: Vec<f64> = of.par_chunks(CHUNK).map(|c| c.iter().map(&f).sum()).collect();
    parts.iter().sum()
}

impl Triangle {
    /// The images of the rest x and y axes.
    fn columns(&self, x: &[Vec3]) -> (Vec3, Vec3) {
        let [a, b, c] = self.nodes.map(|i| x[i as usize]);
        let [sa, sb, sc] = &self.shape;
        (a * sa.x + b * sb.x + c * sc.x, a * sa.y + b * sb.y + c * sc.y)
    }

    fn stress(&self, s: &Stiffness, x: &[Vec3]) -> [f64; 3] {
        let (u, v) = self.columns(x);
        let (eu, ev, shear) = strain(&u, &v);
        [s.weft * eu, s.warp * ev, s.shear * shear]
    }

    /// The stress after `moves` if strain were linear in them.
    fn foretell(&self, s: &Stiffness, x: &[Vec3], moves: &[Vec3]) -> [f64; 3] {
        let (u, v) = self.columns(x);
        let (du, dv) = self.columns(moves);
        let (eu, ev, shear) = strain(&u, &v);
        [s.weft * (eu + u.dot(&du)), s.warp * (ev + v.dot(&dv)), s.shear * (shear + u.dot(&dv) + v.dot(&du))]
    }

    fn blocks(&self, s: &Stiffness, stress: Matrix2<f64>, x: &[Vec3]) -> [Matrix3<f64>; 6] {
        let (u, v) = self.columns(x);
        let (uu, vv, uv) = (u * u.transpose(), v * v.transpose(), u * v.transpose());
        let a = (uu * s.weft + vv * s.shear) * self.area;
        let d = (vv * s.warp + uu * s.shear) * self.area;
        let b = uv.transpose() * (s.shear * self.area);
        let bt = b.transpose();
        PAIRS.map(|(i, j)| {
            let (p, q) = (&self.shape[i], &self.shape[j]);
            let mut block = a * (p.x * q.x) + d * (p.y * q.y) + b * (p.x * q.y) + bt * (p.y * q.x);
            let geometric = self.area * p.dot(&(stress * q));
            (0..3).for_each(|c| block[(c, c)] += geometric);
            block
        })
    }
}

impl Hinge {
    fn curvature(&self, x: &[Vec3]) -> Vec3 {
        self.nodes.iter().zip(&self.weights).map(|(&i, w)| x[i as usize] * *w).sum()
    }
}

/// Green strain along u, along v, and twice the one between.
fn strain(u: &Vec3, v: &Vec3) -> (f64, f64, f64) {
    (0.5 * (u.norm_squared() - 1.0), 0.5 * (v.norm_squared() - 1.0), u.dot(v))
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

fn triangle(sheet: &Sheet, t: usize) -> Triangle {
    let inverse = sheet.inverse_rest()[t];
    let (b, c) = (inverse.row(0).transpose(), inverse.row(1).transpose());
    Triangle { nodes: sheet.triangles()[t], shape: [-b - c, b, c], area: sheet.areas()[t] }
}

fn hinge(sheet: &Sheet, edge: &crate::mesh::Edge, bend: f64) -> Option<Hinge> {
    let other = edge.sides.1?;
    let [i, j] = edge.vertices;
    let cotangents = |side: &crate::mesh::Side| {
        let t = side.triangle as usize;
        let cot = |node: u32| {
            let k = sheet.triangles()[t].iter().position(|&n| n == node).unwrap_or(0);
            let r = &sheet.rest()[t];
            let (p, q) = (r[(k + 1) % 3] - r[k], r[(k + 2) % 3] - r[k]);
            p.dot(&q) / p.perp(&q)
        };
        (cot(i), cot(j), sheet.areas()[t])
    };
    let ((ai, aj, a), (bi, bj, b)) = (cotangents(&edge.sides.0), cotangents(&other));
    Some(Hinge {
        nodes: [i, j, edge.sides.0.opposite, other.opposite],
        weights: [aj + bj, ai + bi, -ai - aj, -bi - bj],
        stiffness: 3.0 * bend / (a + b),
    })
}

#[cfg(test)]
mod tests;

//! Structural and shear springs: warp, weft and shear of every triangle.
//!
//! Method: a triangle that is stretched evenly maps one metre of weft onto the vector `U` and one
//! metre of warp onto `V`, both weighted sums of its corners. Three springs act in it: along `U`
//! and `V` with the fabric's tensile curves, and between them with its shear curve (Volino,
//! Magnenat-Thalmann, Faure 2009, "A simple approach to nonlinear tensile stiffness for accurate
//! cloth simulation"). Stiffness is per metre of cloth, so it does not depend on the mesh, its
//! edges' directions or lengths, where springs on mesh edges (Van Gelder 1998) cannot give the
//! soft shear of woven cloth. Cost: about 60 multiplications and two roots a triangle.
//! Limit: warp and weft are not coupled (Poisson ratio 0).

use super::law::Law;
use nalgebra::{Vector2, Vector3};
use toile_core::artifact::{Fabric, Point2, Point3};

/// The laws of one fabric.
#[derive(Debug, Clone)]
pub struct Material {
    /// Along the pattern's y.
    pub warp: Law,
    /// Along the pattern's x.
    pub weft: Law,
    /// Shear angle.
    pub shear: Law,
}

impl Material {
    /// A fabric's laws with no slope above `cut` N/m.
    pub fn new(fabric: &Fabric, cut: f64) -> Self {
        let law = |curve| Law::new(curve, cut);
        Material { warp: law(&fabric.warp), weft: law(&fabric.weft), shear: law(&fabric.shear) }
    }
}

/// The springs of one triangle.
#[derive(Debug, Clone, Copy)]
pub struct Membrane {
    /// Its nodes.
    pub nodes: [u32; 3],
    /// Index of its material.
    pub material: u32,
    /// `U = sum weft[i] x[i]`, 1/m.
    weft: [f64; 3],
    /// `V = sum warp[i] x[i]`, 1/m.
    warp: [f64; 3],
    /// Flat area, m2.
    pub area: f64,
}

/// Weft and warp as they lie in space.
struct Threads {
    u: Vector3<f64>,
    v: Vector3<f64>,
    u_length: f64,
    v_length: f64,
    /// Cosine of the angle between them: the sine of the shear angle.
    shear: f64,
}

impl Membrane {
    /// The springs of a triangle with this flat shape, whose area must not be zero.
    pub fn new(nodes: [u32; 3], rest: [Point2; 3], material: u32) -> Self {
        let [a, b, c] = rest;
        let twice = (b - a).perp(&(c - a));
        let weft = [b.y - c.y, c.y - a.y, a.y - b.y].map(|y| y / twice);
        let warp = [c.x - b.x, a.x - c.x, b.x - a.x].map(|x| x / twice);
        Membrane { nodes, material, weft, warp, area: twice.abs() / 2.0 }
    }

    #[inline]
    fn threads(&self, x: &[Point3]) -> Threads {
        let [a, b, c] = self.nodes.map(|i| x[i as usize].coords);
        let u = a * self.weft[0] + b * self.weft[1] + c * self.weft[2];
        let v = a * self.warp[0] + b * self.warp[1] + c * self.warp[2];
        // A triangle crushed to a line has no thread direction; the floor only keeps 0/0 away.
        let (u_length, v_length) = (u.norm().max(1e-9), v.norm().max(1e-9));
        let (u, v) = (u / u_length, v / v_length);
        Threads { u, v, u_length, v_length, shear: u.dot(&v) }
    }

    /// Adds its forces to its nodes; returns its greater tensile strain.
    #[inline]
    pub fn add_forces(&self, material: &Material, x: &[Point3], forces: &mut [Vector3<f64>]) -> f64 {
        let t = self.threads(x);
        let (along_u, along_v) = (t.u_length - 1.0, t.v_length - 1.0);
        let tau = material.shear.odd_force(t.shear) * self.area;
        let pull_u = t.u * (material.weft.force(along_u) * self.area)
            + (t.v - t.u * t.shear) * (tau / t.u_length.max(0.1));
        let pull_v = t.v * (material.warp.force(along_v) * self.area)
            + (t.u - t.v * t.shear) * (tau / t.v_length.max(0.1));
        for k in 0..3 {
            forces[self.nodes[k] as usize] -= pull_u * self.weft[k] + pull_v * self.warp[k];
        }
        along_u.max(along_v)
    }

    /// Stored energy, J.
    pub fn energy(&self, material: &Material, x: &[Point3]) -> f64 {
        let t = self.threads(x);
        let tensile = material.weft.energy(t.u_length - 1.0) + material.warp.energy(t.v_length - 1.0);
        self.area * (tensile + material.shear.energy(t.shear.abs()))
    }

    /// Adds what its springs, lying flat and each at its steepest slope, make of a small displacement.
    pub fn add_flat_stiffness(&self, material: &Material, x: &[Vector2<f64>], y: &mut [Vector2<f64>]) {
        let sum = |w: &[f64; 3]| (0..3).fold(Vector2::zeros(), |s, k| s + x[self.nodes[k] as usize] * w[k]);
        let (u, v) = (sum(&self.weft), sum(&self.warp));
        let tau = (u.y + v.x) * material.shear.steepest() * self.area;
        let along_u = Vector2::new(u.x * material.weft.steepest() * self.area, tau);
        let along_v = Vector2::new(tau, v.y * material.warp.steepest() * self.area);
        for k in 0..3 {
            y[self.nodes[k] as usize] += along_u * self.weft[k] + along_v * self.warp[k];
        }
    }

    /// A bound on the greatest eigenvalue of its stiffness matrix, N/m.
    pub fn stiffness_bound(&self, material: &Material) -> f64 {
        let square = |w: &[f64; 3]| w.iter().map(|x| x * x).sum::<f64>();
        let (u, v) = (square(&self.weft), square(&self.warp));
        let tensile = (material.weft.steepest() * u).max(material.warp.steepest() * v);
        self.area * (tensile + material.shear.steepest() * (u + v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::artifact::Curve;

    fn linear(warp: f64, weft: f64, shear: f64) -> Material {
        let law = |k| Law::new(&Curve::linear(k), f64::INFINITY);
        Material { warp: law(warp), weft: law(weft), shear: law(shear) }
    }

    fn skew() -> [Point2; 3] {
        [Point2::new(0.0, 0.0), Point2::new(0.012, 0.003), Point2::new(-0.002, 0.01)]
    }

    fn stretched(rest: [Point2; 3], weft: f64, warp: f64) -> Vec<Point3> {
        rest.iter().map(|p| Point3::new(p.x * weft, p.y * warp, 0.3)).collect()
    }

    #[test]
    fn energy_of_an_even_stretch_is_that_of_the_sheet() {
        let (m, k) = (Membrane::new([0, 1, 2], skew(), 0), linear(900.0, 400.0, 30.0));
        let x = stretched(skew(), 1.02, 1.01);
        let sheet = (400.0 * 0.02f64.powi(2) + 900.0 * 0.01f64.powi(2)) / 2.0 * m.area;
        assert!((m.energy(&k, &x) / sheet - 1.0).abs() < 1e-9);
    }

    #[test]
    fn forces_are_the_slope_of_the_energy_and_sum_to_nothing() {
        let (m, k) = (Membrane::new([0, 1, 2], skew(), 0), linear(900.0, 400.0, 30.0));
        let mut x = stretched(skew(), 1.03, 0.98);
        x[2] += Vector3::new(0.001, 0.0005, 0.002);
        let mut f = vec![Vector3::zeros(); 3];
        m.add_forces(&k, &x, &mut f);
        assert!((f[0] + f[1] + f[2]).norm() < 1e-12);
        for i in 0..3 {
            for axis in 0..3 {
                let at = |h: f64| {
                    let mut moved = x.clone();
                    moved[i][axis] += h;
                    m.energy(&k, &moved)
                };
                let slope = (at(1e-8) - at(-1e-8)) / 2e-8;
                assert!((f[i][axis] + slope).abs() < 1e-5 * f[i].norm().max(1e-3), "{i} {axis}");
            }
        }
    }
}

//! Takes the lone hinge's false Poisson's ratio out of free edges.
//!
//! Lone hinges on equilateral triangles bend with Poisson's ratio -1/3: a narrow strip, free to curl across, is 11 % too soft, although a
//! plate is right. The part of the bending energy that carries the ratio is `-(1 - nu) D` times the integral of Gaussian curvature, and
//! by Gauss and Bonnet that integral is the sum of the corner angles along the border, up to a constant. So raising the
//! ratio from `nu_mesh` to 0 is the energy `-D f nu_mesh (sum of border angles)`: exact, local to the border, and without
//! any force on a flat sheet. Cost: one angle a border corner. Its Hessian is indefinite and left out of the positive form.

use nalgebra::Matrix3;

use super::Rigidity;
use super::calibrate::Calibration;
use crate::error::ClothError;
use crate::force::{Assembled, Element, Projection, Vec3};
use crate::mesh::Sheet;

/// A normal is taken at least this long (share of the product of the sides).
const LEAST_SINE: f64 = 1e-9;

#[derive(Debug, Clone, Copy)]
struct Corner {
    /// Apex on the border, then the other two, counter-clockwise.
    vertices: [u32; 3],
    rest: f64,
    moment: f64,
}

/// Border corners of a sheet.
#[derive(Debug, Clone)]
pub struct FreeEdge {
    corners: Vec<Corner>,
}

impl FreeEdge {
    /// For hinges calibrated on this sheet; the result bends with Poisson's ratio 0. Only border vertices that `free` picks are
    /// treated: where a border is held, its Gauss-Bonnet sum is held as well.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for a negative rigidity.
    pub fn new(
        sheet: &Sheet,
        rigidity: &Rigidity,
        free: impl Fn(usize) -> bool,
    ) -> Result<Assembled<3, Self>, ClothError> {
        rigidity.check()?;
        let calibration = Calibration::of(sheet);
        let moment = -calibration.poisson * calibration.factor * 0.5 * (rigidity.warp + rigidity.weft);
        let mut on_border = vec![false; sheet.vertex_count()];
        for e in sheet.edges().iter().filter(|e| e.is_boundary()) {
            e.vertices.iter().for_each(|&v| on_border[v as usize] = free(v as usize));
        }
        let mut corners = Vec::new();
        for (t, rest) in sheet.triangles().iter().zip(sheet.rest()) {
            for k in (0..3).filter(|&k| on_border[t[k] as usize]) {
                let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                let (u, v) = (rest[i] - rest[k], rest[j] - rest[k]);
                let vertices = [t[k], t[i], t[j]];
                corners.push(Corner { vertices, rest: u.perp(&v).atan2(u.dot(&v)), moment });
            }
        }
        Ok(Assembled(Self { corners }))
    }
}

/// The two sides and the unit normal at an apex.
struct Apex {
    u: Vec3,
    v: Vec3,
    normal: Vec3,
    twice_area: f64,
}

impl Apex {
    fn new(x: &[Vec3; 3]) -> Self {
        let (u, v) = (x[1] - x[0], x[2] - x[0]);
        let n = u.cross(&v);
        let twice_area = n.norm().max(LEAST_SINE * u.norm() * v.norm()).max(f64::MIN_POSITIVE);
        Self { u, v, normal: n / twice_area, twice_area }
    }

    fn angle(&self) -> f64 {
        self.u.cross(&self.v).norm().atan2(self.u.dot(&self.v))
    }

    /// Derivative by u and v.
    fn gradient(&self) -> [Vec3; 2] {
        let across = |s: &Vec3| self.normal.cross(s) / s.norm_squared().max(f64::MIN_POSITIVE);
        [-across(&self.u), across(&self.v)]
    }

    /// Second derivative by u and v.
    fn hessian(&self) -> [[Matrix3<f64>; 2]; 2] {
        let (u, v, n) = (&self.u, &self.v, &self.normal);
        let flat = (Matrix3::identity() - n * n.transpose()) / self.twice_area;
        let (n_by_u, n_by_v) = (-flat * v.cross_matrix(), flat * u.cross_matrix());
        let own = |s: &Vec3, n_by_s: &Matrix3<f64>| {
            let s2 = s.norm_squared().max(f64::MIN_POSITIVE);
            (n.cross_matrix() - s.cross_matrix() * n_by_s) / s2
                - n.cross(s) * s.transpose() * (2.0 / (s2 * s2))
        };
        let mixed = u.cross_matrix() * n_by_v / u.norm_squared().max(f64::MIN_POSITIVE);
        [[-own(u, &n_by_u), mixed], [mixed.transpose(), own(v, &n_by_v)]]
    }
}

impl Element<3> for FreeEdge {
    fn name(&self) -> &'static str {
        "free edges"
    }

    fn count(&self) -> usize {
        self.corners.len()
    }

    fn vertices(&self, e: usize) -> [u32; 3] {
        self.corners[e].vertices
    }

    fn value(&self, e: usize, x: &[Vec3; 3]) -> f64 {
        self.corners[e].moment * (Apex::new(x).angle() - self.corners[e].rest)
    }

    fn gradient(&self, e: usize, x: &[Vec3; 3]) -> [Vec3; 3] {
        let [u, v] = Apex::new(x).gradient().map(|g| g * self.corners[e].moment);
        [-u - v, u, v]
    }

    fn hessian(&self, e: usize, x: &[Vec3; 3], projection: Projection) -> [[Matrix3<f64>; 3]; 3] {
        if projection == Projection::PositiveSemiDefinite {
            return [[Matrix3::zeros(); 3]; 3];
        }
        let h = Apex::new(x).hessian();
        let m = self.corners[e].moment;
        let [uu, uv, vu, vv] = [h[0][0] * m, h[0][1] * m, h[1][0] * m, h[1][1] * m];
        [[uu + uv + vu + vv, -uu - vu, -uv - vv], [-uu - uv, uu, uv], [-vu - vv, vu, vv]]
    }
}

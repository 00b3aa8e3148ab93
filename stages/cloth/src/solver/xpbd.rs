//! Extended position-based dynamics with small steps (Macklin, Mueller, Chentanez, 2016; Macklin et
//! al., 2019).
//!
//! Each triangle is one constraint of three strains (weft, warp, shear angle) with the 3 x 3
//! compliance of the fabric, and each inner edge one of its fold angle with that of the hinge.
//! There is one Gauss-Seidel sweep a small step. In the limit of small steps it solves the same
//! equations as finite elements in their linear range. At a given cost it is too soft, most of all
//! in long, stiff pieces, because a sweep carries a force only along the order of the vertices. It
//! is always stable. Cost: one 3 x 3 solve per triangle and step, no matrix. The model's energies
//! are not used; its masses, gravity, drag, air, pins and obstacles are.

use nalgebra::Matrix3;

use super::{Model, Report, Solver, State};
use crate::energy::bending::{Fold, folds_of};
use crate::energy::membrane::Woven;
use crate::energy::{Vec3, carried, mobility};
use crate::error::{ClothError, check_parameter};
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;

struct StrainTerm {
    vertices: [u32; 3],
    /// Rest gradients of the shape functions of the second and third corner.
    shape: [nalgebra::Vector2<f64>; 2],
    area: f64,
}

/// The solver, with the constraints of one sheet.
pub struct Xpbd {
    /// Time that one call advances, s.
    pub dt: f64,
    /// Small steps in it.
    pub substeps: usize,
    strains: Vec<StrainTerm>,
    /// Strains per tension, m/N.
    compliance: Matrix3<f64>,
    hinges: Vec<Fold>,
}

impl Xpbd {
    /// For a sheet of this fabric.
    ///
    /// # Errors
    /// Every error of [`Fabric::check`]; [`ClothError::InvalidParameter`] for a sheet with no
    /// stiffness at all in some direction.
    pub fn new(sheet: &Sheet, fabric: &Fabric, dt: f64, substeps: usize) -> Result<Self, ClothError> {
        let woven = Woven::new(fabric)?;
        let stiffness = woven.linear_stiffness();
        let inverse = stiffness.try_inverse().ok_or(ClothError::InvalidParameter {
            name: "stiffness",
            value: stiffness.determinant(),
            range: "above 0 N/m along warp, weft and in shear",
        })?;
        let strains = (0..sheet.triangles().len()).map(|t| {
            let m = sheet.inverse_rest()[t];
            let (g1, g2) = (m.row(0).transpose(), m.row(1).transpose());
            StrainTerm { vertices: sheet.triangles()[t], shape: [g1, g2], area: sheet.areas()[t] }
        });
        Ok(Self {
            dt,
            substeps,
            strains: strains.collect(),
            compliance: inverse,
            hinges: folds_of(sheet, &Rigidity::of(fabric))?,
        })
    }

    /// One sweep over all constraints.
    fn project<W: Mobility>(&self, x: &mut [Vec3], inverse_mass: &[W], h: f64) {
        for s in &self.strains {
            s.project(&self.compliance, x, inverse_mass, h);
        }
        for hinge in &self.hinges {
            project_hinge(hinge, x, inverse_mass, h);
        }
    }

    fn substep(&self, model: &Model, state: &mut State, inverse_mass: &[f64], h: f64) {
        let start = state.x.clone();
        let keep = 1.0 / (1.0 + model.drag * h);
        let half = model.gravity * (0.5 * h);
        // The middle of the step: free fall is then exact.
        let coasting: Vec<Vec3> = state.v.iter().map(|v| v * keep + half).collect();
        match &model.air {
            None => {
                advance_free(&mut state.x, &coasting, inverse_mass, h);
                self.project(&mut state.x, inverse_mass, h);
            }
            Some(air) => {
                // Drag depends on the velocity of the last step, half a step of gravity behind the
                // present one.
                let last: Vec<Vec3> = state.v.iter().map(|v| v - half).collect();
                let drag_tensors = air.drag_tensors(&state.x, &last);
                let answers = mobilities(model, &drag_tensors, h);
                let blown = |v: usize| carried(&coasting[v], &air.air.wind, &answers[v], &drag_tensors[v], h);
                let blown: Vec<Vec3> = (0..coasting.len()).map(blown).collect();
                advance_free(&mut state.x, &blown, inverse_mass, h);
                self.project(&mut state.x, &answers, h);
            }
        }
        for v in 0..start.len() {
            if inverse_mass[v] == 0.0 {
                (state.x[v], state.v[v]) = (start[v], Vec3::zeros());
                continue;
            }
            let mut velocity = (state.x[v] - start[v]) / h;
            for obstacle in &model.obstacles {
                velocity = obstacle.stop(&start[v], &velocity, h);
            }
            state.x[v] = start[v] + velocity * h;
            state.v[v] = velocity + model.gravity * (0.5 * h);
        }
    }
}

/// The change of velocity of a vertex per impulse, 1/kg: by its mass alone, or with drag.
trait Mobility: Copy {
    /// `a W b`.
    fn between(self, a: &Vec3, b: &Vec3) -> f64;
    /// `W a by`.
    fn to(self, a: &Vec3, by: f64) -> Vec3;
}

impl Mobility for f64 {
    fn between(self, a: &Vec3, b: &Vec3) -> f64 {
        self * a.dot(b)
    }

    fn to(self, a: &Vec3, by: f64) -> Vec3 {
        a * (by * self)
    }
}

impl Mobility for Matrix3<f64> {
    fn between(self, a: &Vec3, b: &Vec3) -> f64 {
        a.dot(&(self * b))
    }

    fn to(self, a: &Vec3, by: f64) -> Vec3 {
        self * a * by
    }
}

fn advance_free(x: &mut [Vec3], velocities: &[Vec3], inverse_mass: &[f64], h: f64) {
    for (v, _) in inverse_mass.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        x[v] += velocities[v] * h;
    }
}

fn mobilities(model: &Model, drag_tensors: &[Matrix3<f64>], h: f64) -> Vec<Matrix3<f64>> {
    let of = |(v, drag): (usize, &Matrix3<f64>)| match model.fixed[v] {
        true => Matrix3::zeros(),
        false => mobility(model.masses[v], drag, h),
    };
    drag_tensors.iter().enumerate().map(of).collect()
}

impl StrainTerm {
    fn project<W: Mobility>(&self, compliance: &Matrix3<f64>, x: &mut [Vec3], inverse_mass: &[W], h: f64) {
        let vertices = self.vertices.map(|v| v as usize);
        let shape = [-self.shape[0] - self.shape[1], self.shape[0], self.shape[1]];
        let p = vertices.map(|v| x[v]);
        let f: [Vec3; 2] = std::array::from_fn(|k| (0..3).map(|c| p[c] * shape[c][k]).sum());
        let (strain, by_column) = Woven::strains(&f);
        // Row r of the Jacobian at corner c.
        let jacobian: [[Vec3; 3]; 3] = std::array::from_fn(|r| {
            std::array::from_fn(|c| by_column[r][0] * shape[c].x + by_column[r][1] * shape[c].y)
        });
        let w = vertices.map(|v| inverse_mass[v]);
        let system = Matrix3::from_fn(|r, s| {
            (0..3).map(|c| w[c].between(&jacobian[r][c], &jacobian[s][c])).sum::<f64>()
                + compliance[(r, s)] / (self.area * h * h)
        });
        let Some(pull) = system.cholesky().map(|c| c.solve(&-strain)) else { return };
        for c in 0..3 {
            let d: Vec3 = (0..3).map(|r| jacobian[r][c] * pull[r]).sum();
            x[vertices[c]] += w[c].to(&d, 1.0);
        }
    }
}

fn project_hinge<W: Mobility>(hinge: &Fold, x: &mut [Vec3], inverse_mass: &[W], h: f64) {
    if hinge.stiffness <= 0.0 {
        return;
    }
    let vertices = hinge.nodes.map(|v| v as usize);
    let (angle, gradient) = hinge.angle(&vertices.map(|v| x[v]));
    let sum: f64 = (0..4).map(|k| inverse_mass[vertices[k]].between(&gradient[k], &gradient[k])).sum();
    let pull = -angle / (sum + 1.0 / (hinge.stiffness * h * h));
    for k in 0..4 {
        x[vertices[k]] += inverse_mass[vertices[k]].to(&gradient[k], pull);
    }
}

impl Solver for Xpbd {
    fn name(&self) -> &'static str {
        "XPBD"
    }

    /// # Errors
    /// Those of input; [`ClothError::Diverged`] for NaN.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError> {
        check_parameter("dt", self.dt, |dt| dt > 0.0, "above 0 s")?;
        check_parameter("substeps", self.substeps as f64, |n| n >= 1.0, "1 or more")?;
        model.check(state)?;
        let inverse_mass: Vec<f64> =
            model.masses.iter().zip(&model.fixed).map(|(m, f)| if *f { 0.0 } else { 1.0 / m }).collect();
        for _ in 0..self.substeps {
            model.stopper.check()?;
            self.substep(model, state, &inverse_mass, self.dt / self.substeps as f64);
        }
        crate::mesh::check_finite("positions", &state.x)
            .map_err(|_| ClothError::Diverged { what: "position", step: self.substeps })?;
        state.time += self.dt;
        Ok(Report { advanced: self.dt, iterations: self.substeps, residual: 0.0, converged: true })
    }
}

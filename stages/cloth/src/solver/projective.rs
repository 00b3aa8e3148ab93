//! Projective dynamics (Bouaziz, Martin, Liu, Kavan, Pauly, 2014): implicit Euler by alternating
//! local and global steps.
//!
//! Local: each triangle's deformation is taken to the nearest rotation. Global: one linear system
//! with one number per vertex pair; its matrix never changes, so it is factored once. Membrane `k A
//! |F - R|² / 2` (isotropic, Poisson's ratio 0, force linear in the stretch), bending quadratic.
//! Every iteration lowers the energy, most of all the first few; convergence is slower for stiffer
//! sheets and longer steps. `iterations` trades accuracy for time. The energies of the model are
//! not used; its masses, gravity, drag, air, pins and obstacles are. In air the matrix is factored
//! anew each step, for drag depends on the velocity.

use nalgebra::{Matrix3, Matrix3x2, Vector2};
use rayon::prelude::*;

use super::{Model, Report, Solver, State};
use crate::energy::bending::folds_of;
use crate::energy::{AirDrag, Vec3};
use crate::error::{ClothError, check_parameter};
use crate::fabric::Rigidity;
use crate::linear::{BlockMatrix, Cholesky};
use crate::mesh::Sheet;

struct ProjectedTriangle {
    vertices: [usize; 3],
    shape: [Vector2<f64>; 3],
    stiffness: f64,
}

/// The solver, with the factor of one sheet, one set of pins and one time step.
pub struct Projective {
    dt: f64,
    iterations: usize,
    triangles: Vec<ProjectedTriangle>,
    matrix: BlockMatrix,
    factor: Cholesky,
    fixed: Vec<bool>,
    inertia: Vec<f64>,
    /// Whether the factor includes the drag of a step.
    has_air: bool,
}

impl Projective {
    /// For a sheet of stiffness `k` (N/m) and these masses, pins and drag; steps of `dt` with this
    /// many iterations each.
    ///
    /// # Errors
    /// [`ClothError::InvalidParameter`] for dt <= 0 or k < 0; [`ClothError::Factorization`].
    pub fn new(
        sheet: &Sheet,
        model: &Model,
        k: f64,
        rigidity: &Rigidity,
        dt: f64,
        iterations: usize,
    ) -> Result<Self, ClothError> {
        check_parameter("dt", dt, |dt| dt > 0.0, "above 0 s")?;
        check_parameter("stiffness", k, |k| k >= 0.0, "0 or more N/m")?;
        let triangles: Vec<ProjectedTriangle> =
            (0..sheet.triangles().len()).map(|t| triangle(sheet, t, k)).collect();
        let hinges = folds_of(sheet, rigidity)?;
        let mut full = BlockMatrix::with_couplings(sheet.vertex_count(), |visit| {
            sheet.triangles().iter().for_each(|t| visit(t));
            hinges.iter().for_each(|h| visit(&h.nodes));
        });
        for (t, corners) in triangles.iter().zip(sheet.triangles()) {
            let g = &t.shape;
            let block = |a: usize, b: usize| Matrix3::identity() * (t.stiffness * g[a].dot(&g[b]));
            full.add_element(
                corners,
                &std::array::from_fn::<_, 3, _>(|a| std::array::from_fn(|b| block(a, b))),
            );
        }
        for h in &hinges {
            let block =
                |a: usize, b: usize| Matrix3::identity() * (h.stiffness * h.weights[a] * h.weights[b]);
            full.add_element(
                &h.nodes,
                &std::array::from_fn::<_, 4, _>(|a| std::array::from_fn(|b| block(a, b))),
            );
        }
        let inertia: Vec<f64> =
            model.masses.iter().map(|m| m / (dt * dt) * (1.0 + model.drag * dt)).collect();
        full.add_diagonal(inertia.iter().copied());
        let mut reduced = full.clone();
        reduced.fix(&model.fixed);
        let mut factor = Cholesky::analyse_scalar(&reduced)?;
        factor.factor(&reduced)?;
        Ok(Self {
            dt,
            iterations,
            triangles,
            matrix: full,
            factor,
            fixed: model.fixed.clone(),
            inertia,
            has_air: false,
        })
    }

    /// The drag tensors in a step from `state`, with a factor that bounds them from above, so that
    /// iterations lower the energy.
    fn take_air(
        &mut self,
        air: &AirDrag,
        state: &State,
        half: &Vec3,
    ) -> Result<Vec<Matrix3<f64>>, ClothError> {
        let last: Vec<Vec3> = state.v.iter().map(|v| v - half).collect();
        let drag_tensors = air.drag_tensors(&state.x, &last);
        let mut bound = self.matrix.clone();
        bound.add_diagonal(drag_tensors.iter().map(|b| b.symmetric_eigenvalues().max().max(0.0) / self.dt));
        self.refactor(bound)?;
        self.has_air = true;
        Ok(drag_tensors)
    }

    fn refactor(&mut self, mut matrix: BlockMatrix) -> Result<(), ClothError> {
        matrix.fix(&self.fixed);
        self.factor.factor(&matrix)
    }

    /// Pull of the rotated rest shapes on the vertices, N.
    fn local(&self, x: &[Vec3]) -> Vec<Vec3> {
        let pulls: Vec<[Vec3; 3]> = self.triangles.par_iter().with_min_len(256).map(|t| t.pull(x)).collect();
        let mut sum = vec![Vec3::zeros(); x.len()];
        for (t, pull) in self.triangles.iter().zip(&pulls) {
            t.vertices.iter().zip(pull).for_each(|(&v, p)| sum[v] += p);
        }
        sum
    }
}

fn triangle(sheet: &Sheet, t: usize, k: f64) -> ProjectedTriangle {
    let m = sheet.inverse_rest()[t];
    let (g1, g2) = (m.row(0).transpose(), m.row(1).transpose());
    let vertices = sheet.triangles()[t].map(|v| v as usize);
    ProjectedTriangle { vertices, shape: [-g1 - g2, g1, g2], stiffness: k * sheet.areas()[t] }
}

impl ProjectedTriangle {
    fn pull(&self, x: &[Vec3]) -> [Vec3; 3] {
        let mut f = Matrix3x2::zeros();
        for (g, &v) in self.shape.iter().zip(&self.vertices) {
            f += x[v] * g.transpose();
        }
        let r = nearest_rotation(&f) * self.stiffness;
        self.shape.map(|g| r * g)
    }
}

/// The 3 x 2 matrix with orthonormal columns nearest to `f`: f times the inverse square root of
/// `f^T f`, in closed form.
fn nearest_rotation(f: &Matrix3x2<f64>) -> Matrix3x2<f64> {
    let c = f.tr_mul(f);
    let s = c.determinant().max(0.0).sqrt();
    let t = (c.trace() + 2.0 * s).sqrt();
    // Square root of c is (c + s I) / t; its determinant is s.
    let root = (c + nalgebra::Matrix2::identity() * s) / t;
    match root.try_inverse() {
        Some(inverse) if inverse.iter().all(|v| v.is_finite()) => f * inverse,
        _ => *f,
    }
}

impl Solver for Projective {
    fn name(&self) -> &'static str {
        "projective dynamics"
    }

    /// # Errors
    /// Those of input; [`ClothError::Diverged`] for NaN.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError> {
        model.check(state)?;
        let (start, dt) = (state.x.clone(), self.dt);
        let coast: Vec<Vec3> = (0..start.len())
            .map(|v| (state.v[v] * dt + model.gravity * (0.5 * dt * dt)) * (model.masses[v] / (dt * dt)))
            .collect();
        let half = model.gravity * (0.5 * dt);
        let drag_tensors = match &model.air {
            Some(air) => Some((air.air.wind * dt, self.take_air(air, state, &half)?)),
            None => None,
        };
        if drag_tensors.is_none() && std::mem::take(&mut self.has_air) {
            self.refactor(self.matrix.clone())?;
        }
        let mut residual = 0.0;
        for _ in 0..self.iterations {
            model.stopper.check()?;
            let mut load = self.local(&state.x);
            for v in 0..load.len() {
                load[v] += coast[v] + start[v] * self.inertia[v];
            }
            if let Some((way, drag_tensors)) = &drag_tensors {
                let pull = |v: usize| drag_tensors[v] * (start[v] + way - state.x[v]) / dt;
                load.iter_mut().enumerate().for_each(|(v, l)| *l += pull(v));
            }
            // Solved for the change, so that held vertices need no special right-hand side.
            let now = self.matrix.times(&state.x);
            let mut rest: Vec<Vec3> = load.iter().zip(&now).map(|(l, n)| l - n).collect();
            rest.iter_mut().zip(&self.fixed).filter(|(_, f)| **f).for_each(|(r, _)| *r = Vec3::zeros());
            residual = rest.iter().map(|r| r.norm()).fold(0.0, f64::max);
            let change = self.factor.solve(&rest);
            state.x.iter_mut().zip(&change).for_each(|(x, c)| *x += c);
        }
        for (v, from) in start.iter().enumerate().filter(|(v, _)| !self.fixed[*v]) {
            let mut velocity = (state.x[v] - from) / dt;
            for obstacle in &model.obstacles {
                velocity = obstacle.stop(from, &velocity, dt);
            }
            state.x[v] = from + velocity * dt;
            state.v[v] = velocity + model.gravity * (0.5 * dt);
        }
        crate::mesh::check_finite("positions", &state.x)
            .map_err(|_| ClothError::Diverged { what: "position", step: self.iterations })?;
        state.time += dt;
        Ok(Report { advanced: dt, iterations: self.iterations, residual, converged: true })
    }
}

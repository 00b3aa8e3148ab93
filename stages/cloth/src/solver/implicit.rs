//! Implicit (backward) Euler as a minimisation: `x' = argmin |x - y|²_M / 2dt² + E(x)`, y where
//! inertia alone would lead (Baraff and Witkin, 1998, there with one Newton step; here to a
//! residual).
//!
//! Stable at any step, never gains energy. A mode of frequency w loses the factor `1/sqrt(1 + (w
//! dt)²)` a step: choose dt by the motion that must not be damped away. Velocities are those of the
//! middle of a step, as with central differences, so free fall is exact.

use super::{Model, Newton, NewtonReport, Report, Solver, State};
use crate::energy::{AirStep, Energy, Places, Projection, Vec3, total_value};
use crate::error::{ClothError, check_parameter};
use crate::linear::{BlockMatrix, Pattern};
use nalgebra::Matrix3;

/// Pseudo-time step of a hard step, as a share of the step.
const PSEUDO_SHARE: f64 = 0.1;

/// The solver.
pub struct ImplicitEuler {
    /// Time step, s.
    pub dt: f64,
    /// Newton's options; the tolerance is in newtons.
    pub newton: Newton,
    /// Half a step of gravity, held back from the velocities so far.
    held_back: Vec3,
}

impl ImplicitEuler {
    /// With step `dt` (s), each solved to this largest force (N).
    #[must_use]
    pub fn new(dt: f64, tolerance: f64) -> Self {
        let mut newton = Newton::new(tolerance);
        (newton.pseudo_step, newton.cautious) = (PSEUDO_SHARE * dt, false);
        Self { dt, newton, held_back: Vec3::zeros() }
    }
}

/// `s |x - target|²_M / 2` for one time step.
struct Inertia<'a> {
    masses: &'a [f64],
    target: Vec<Vec3>,
    scale: f64,
}

impl Energy for Inertia<'_> {
    fn name(&self) -> &'static str {
        "inertia"
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        let terms = x.iter().zip(&self.target).zip(self.masses);
        0.5 * self.scale * terms.map(|((x, y), m)| m * (x - y).norm_squared()).sum::<f64>()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        for (k, g) in gradient.iter_mut().enumerate() {
            *g += (x[k] - self.target[k]) * (self.scale * self.masses[k]);
        }
    }

    fn add_matrix(&self, _: &[Vec3], _: Projection, _: &Places, values: &mut [Matrix3<f64>]) {
        let terms = values.iter_mut().zip(self.masses);
        terms.for_each(|(v, m)| *v += Matrix3::identity() * (m * self.scale));
    }
}

/// `s (x - start) K (x - start) / 2`: damping by the stiffness at the start of the step.
struct Viscous {
    stiffness: BlockMatrix,
    start: Vec<Vec3>,
    scale: f64,
}

impl Viscous {
    fn moved(&self, x: &[Vec3]) -> Vec<Vec3> {
        x.iter().zip(&self.start).map(|(x, s)| x - s).collect()
    }
}

impl Energy for Viscous {
    fn name(&self) -> &'static str {
        "damping"
    }

    fn value(&self, x: &[Vec3]) -> f64 {
        let d = self.moved(x);
        0.5 * self.scale * self.stiffness.times(&d).iter().zip(&d).map(|(f, d)| f.dot(d)).sum::<f64>()
    }

    fn add_gradient(&self, x: &[Vec3], gradient: &mut [Vec3]) {
        let force = self.stiffness.times(&self.moved(x));
        gradient.iter_mut().zip(&force).for_each(|(g, f)| *g += f * self.scale);
    }

    fn couplings(&self, visit: &mut dyn FnMut(&[u32])) {
        self.stiffness.pattern().upper().for_each(|(i, j, _)| visit(&[i, j]));
    }

    fn places(&self, pattern: &Pattern) -> Places {
        let rows = (0..self.stiffness.rows() as u32).map(|i| (i, i));
        let upper = self.stiffness.pattern().upper().map(|(i, j, _)| (i, j));
        let slots = rows.chain(upper).filter_map(|(i, j)| pattern.slot(i, j)).map(|s| s.index);
        Places::at_slots(slots.collect())
    }

    fn add_matrix(&self, _: &[Vec3], _: Projection, places: &Places, values: &mut [Matrix3<f64>]) {
        let blocks = places.slots().iter().zip(self.stiffness.values());
        blocks.for_each(|(&slot, block)| values[slot as usize] += block * self.scale);
    }
}

impl Solver for ImplicitEuler {
    fn name(&self) -> &'static str {
        "implicit Euler"
    }

    /// # Errors
    /// Those of input, and what [`Newton::minimise`] finds. A step that ran out of iterations is
    /// taken and reported as not converged.
    fn advance(&mut self, model: &Model, state: &mut State) -> Result<Report, ClothError> {
        check_parameter("dt", self.dt, |dt| dt > 0.0, "above 0 s")?;
        model.check(state)?;
        let (dt, half) = (self.dt, model.gravity * (0.5 * self.dt));
        let shift = self.held_back - half;
        let start = state.x.clone();
        let coast = |v: usize| if model.fixed[v] { Vec3::zeros() } else { (state.v[v] + shift) * dt };
        let target = (0..start.len()).map(|v| start[v] + coast(v)).collect();
        let inertia = Inertia { masses: &model.masses, target, scale: dt.powi(-2) };
        let drag = Inertia { masses: &model.masses, target: start.clone(), scale: model.drag / dt };
        let viscous = (model.viscosity > 0.0).then(|| Viscous {
            stiffness: model.stiffness(&start, Projection::PositiveSemiDefinite),
            start: start.clone(),
            scale: model.viscosity / dt,
        });
        let air = model.air.as_ref().map(|a| AirStep {
            start: &start,
            drag_tensors: a.drag_tensors(&start, &state.v),
            wind: a.air.wind,
            dt,
        });
        let weight = model.weight();
        let mut energies = model.internal();
        energies.extend([&weight as &dyn Energy, &inertia]);
        energies.extend((model.drag > 0.0).then_some(&drag as &dyn Energy));
        energies.extend(viscous.as_ref().map(|v| v as &dyn Energy));
        energies.extend(air.as_ref().map(|a| a as &dyn Energy));
        // From the better of coasting and standing still: then a step can never end above the
        // energy it began with.
        let mut x = start.clone();
        if total_value(&energies, &inertia.target) < total_value(&energies, &x) {
            x.clone_from(&inertia.target);
        }
        self.newton.stopper = model.stopper.clone();
        let report = self.newton.minimise(&energies, &model.masses, &model.fixed, &mut x)?;
        state.v = x.iter().zip(&start).map(|(x, s)| (x - s) / dt).collect();
        state.x = x;
        state.time += dt;
        self.held_back = half;
        let NewtonReport { iterations, residual, converged } = report;
        Ok(Report { advanced: dt, iterations, residual, converged })
    }
}

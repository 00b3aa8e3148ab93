//! One period of the slowest swing of a strip that hangs from its upper edge: length 1, gravity 1,
//! density 1.

use super::way::Way;
use super::{Options, Ran, Run, Solve, go_on};
use crate::map::Cloth;
use crate::reference::{HangingSwing, hanging_swing};
use toile_cloth::energy::{self, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};

const WIDTH: f64 = 0.3;
/// Weight over stiffness.
const ALPHA: f64 = 0.01;
/// Rigidity over weight: a trace, so that the sheet has a shape.
const BENDING: f64 = 1e-6;
/// Greatest displacement, in lengths: so small that the motion is linear.
const AMPLITUDE: f64 = 1e-3;
/// Force that implicit steps may leave, in weights: far below the swing's own.
const TOLERANCE: f64 = 1e-9;

/// The strip at rest under its weight, with its swing.
pub(super) struct Problem {
    mesh: Rectangle,
    sheet: Sheet,
    fabric: Fabric,
    model: Model,
    /// At rest.
    rest: Vec<Vec3>,
    exact: HangingSwing,
}

impl Problem {
    pub(super) fn new(way: Way, along: usize) -> Result<Self, ClothError> {
        let mesh = Rectangle::new(Layout::Equilateral, WIDTH, 1.0, along);
        let sheet = mesh.sheet(1.0)?;
        let fabric = Fabric::isotropic(1.0, 1.0 / ALPHA, 0.0, BENDING);
        let mut model = Model::of(&sheet).pinned(|v| mesh.at_top(v)).under(Vec3::new(0.0, -1.0, 0.0));
        let fixed = model.fixed.clone();
        model = model.made_of(way.models(), &energy::Cloth::of(&sheet, &[&fabric]).holding(&fixed))?;
        let mut state = State::at_rest(mesh.uv.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect());
        Static::to(1e-10).advance(&model, &mut state)?;
        Ok(Self { mesh, sheet, fabric, model, rest: state.x, exact: hanging_swing(ALPHA) })
    }

    /// Displacement of a vertex at the start.
    fn out(&self, v: usize) -> f64 {
        AMPLITUDE * self.exact.at(self.mesh.uv[v].y)
    }

    /// Root mean square of what is off at this time, over that of the start.
    fn off(&self, state: &State) -> f64 {
        let phase = (self.exact.omega * state.time).cos();
        let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
            self.model.masses.iter().enumerate().map(|(v, m)| m * of(v).powi(2)).sum()
        };
        (sum(&|v| state.x[v].z - phase * self.out(v)) / sum(&|v| self.out(v))).sqrt()
    }

    fn swing(&self, solver: &mut dyn Solver, options: &Options) -> Ran {
        let start = (0..self.rest.len()).map(|v| self.rest[v] + Vec3::z() * self.out(v)).collect();
        let mut state = State::at_rest(start);
        let (period, mut worst) = (std::f64::consts::TAU / self.exact.omega, 0.0_f64);
        while state.time < period {
            if go_on(options).is_break() {
                return None;
            }
            if let Err(e) = solver.advance(&self.model, &mut state) {
                return Some(Err(e.to_string()));
            }
            worst = worst.max(self.off(&state));
        }
        Some(Ok(worst))
    }
}

impl Solve for Problem {
    fn particles(&self) -> usize {
        self.rest.len()
    }

    fn solve(&self, run: &Run, options: &Options) -> Ran {
        let steps = std::f64::consts::TAU / self.exact.omega / run.dt.unwrap_or(f64::INFINITY);
        if run.way.nominal(steps, self.sheet.triangles().len()) > options.longest {
            return Some(Err(super::TOO_LONG.into()));
        }
        let cloth = Cloth { sheet: &self.sheet, fabric: &self.fabric, model: &self.model };
        match run.way.solver(&cloth, run.dt, TOLERANCE * WIDTH) {
            Ok(Some(mut solver)) => self.swing(&mut *solver, options),
            Ok(None) => Some(Err("it has no motion".into())),
            Err(e) => Some(Err(e.to_string())),
        }
    }
}

//! A strip between two level edges, released near its state of rest and damped about critically:
//! length 1, gravity 1, density 1.

use super::way::Way;
use super::{Options, Ran, Run, Solve, go_on};
use crate::map::{Cloth, Scheme};
use crate::reference;
use std::ops::ControlFlow;
use toile_cloth::energy::{self, Vec3};
use toile_cloth::error::ClothError;
use toile_cloth::fabric::Fabric;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{Model, Solver, State, Static};
use toile_cloth::statics::drive::solve::{StaticEquilibrium, StaticsError};

const WIDTH: f64 = 0.3;
/// Between the supports, in lengths.
const SPAN: f64 = 0.8;
/// Weight over stiffness.
const BETA: f64 = 1e-2;
/// Rigidity over weight.
const BENDING: f64 = 1e-6;
/// Slowest motion, about, rad/s.
const RATE: f64 = 3.0;
/// Powers of e by which motion dies out.
const DECAY: f64 = 12.0;
/// Force that may be left, in weights.
const TOLERANCE: f64 = 1e-7;
/// Speed at which `StaticEquilibrium` is done.
const SPEED: f64 = 1e-6;

/// The strip with its supports.
pub(super) struct Problem {
    mesh: Rectangle,
    sheet: Sheet,
    fabric: Fabric,
    model: Model,
    start: Vec<Vec3>,
}

impl Problem {
    pub(super) fn new(way: Way, along: usize) -> Result<Self, ClothError> {
        let mesh = Rectangle::new(Layout::Equilateral, WIDTH, 1.0, along);
        let sheet = mesh.sheet(1.0)?;
        let fabric = Fabric::isotropic(1.0, 1.0 / BETA, 0.0, BENDING);
        let held = |v: usize| mesh.at_bottom(v) || mesh.at_top(v);
        let mut model = Model::of(&sheet).pinned(held).under(Vec3::new(0.0, -1.0, 0.0));
        let fixed = model.fixed.clone();
        model = model.made_of(way.models(), &energy::Cloth::of(&sheet, &[&fabric]).holding(&fixed))?;
        model.drag = 2.0 * RATE;
        let depth = reference::catenary(SPAN, 0.0).sag;
        let start = |p: &nalgebra::Vector2<f64>| Vec3::new(SPAN * p.y, -4.0 * depth * p.y * (1.0 - p.y), p.x);
        let start = mesh.uv.iter().map(start).collect();
        Ok(Self { mesh, sheet, fabric, model, start })
    }

    /// How far the middle hangs from where it should, in lengths.
    fn error(&self, x: &[Vec3]) -> f64 {
        let middle: Vec<f64> =
            (0..x.len()).filter(|&v| (self.mesh.uv[v].y - 0.5).abs() < 1e-9).map(|v| -x[v].y).collect();
        let sag = middle.iter().sum::<f64>() / middle.len() as f64;
        (sag - reference::catenary(SPAN, BETA).sag).abs()
    }

    fn settle(&self, solver: &mut dyn Solver, options: &Options) -> Ran {
        let mut state = State::at_rest(self.start.clone());
        while state.time < DECAY / RATE {
            if go_on(options).is_break() {
                return None;
            }
            if let Err(e) = solver.advance(&self.model, &mut state) {
                return Some(Err(e.to_string()));
            }
        }
        Some(Ok(self.error(&state.x)))
    }

    fn statics(&self) -> Ran {
        let mut state = State::at_rest(self.start.clone());
        let solved = Static::to(TOLERANCE * WIDTH).advance(&self.model, &mut state);
        Some(solved.map(|_| self.error(&state.x)).map_err(|e| e.to_string()))
    }

    fn rest(&self, options: &Options) -> Ran {
        let scene = self.mesh.scene(&self.fabric, &self.model, &self.start);
        let rest = StaticEquilibrium { speed: SPEED, ..StaticEquilibrium::default() };
        let solved = rest.solve(&scene, &mut |_, _| match (options.stop)() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        });
        match solved {
            Ok(state) => Some(Ok(self.error(&state.positions))),
            Err(StaticsError::Stopped) => None,
            Err(e) => Some(Err(e.to_string())),
        }
    }
}

impl Solve for Problem {
    fn particles(&self) -> usize {
        self.start.len()
    }

    fn solve(&self, run: &Run, options: &Options) -> Ran {
        let steps = DECAY / RATE / run.dt.unwrap_or(f64::INFINITY);
        if run.way.nominal(steps, self.sheet.triangles().len()) > options.longest {
            return Some(Err(super::TOO_LONG.into()));
        }
        let cloth = Cloth { sheet: &self.sheet, fabric: &self.fabric, model: &self.model };
        match run.way.solver(&cloth, run.dt, TOLERANCE * WIDTH) {
            Ok(Some(mut solver)) => self.settle(&mut *solver, options),
            Ok(None) if run.way.scheme == Some(Scheme::Rest) => self.rest(options),
            Ok(None) => self.statics(),
            Err(e) => Some(Err(e.to_string())),
        }
    }
}

//! The extremes: each value of each axis alone, and all pairs of extremes, on a hanging square.
//!
//! A case must converge, stay finite and gain no energy, or be refused with a typed error. Nothing
//! else is allowed.

use super::{Check, Must, Verdict};
use toile_cloth::energy::{Cloth, Models, Vec3};
use toile_cloth::error::{ClothError, check_parameter};
use toile_cloth::fabric::Fabric;
use toile_cloth::mesh::Sheet;
use toile_cloth::solver::layout::{Layout, Rectangle};
use toile_cloth::solver::{ImplicitEuler, Model, Solver, State};

/// One combination of extremes; SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// Stretch stiffness, N/m.
    pub stiffness: f64,
    /// Bending rigidity, N m.
    pub bending: f64,
    /// Time step, s.
    pub dt: f64,
    /// Edge length across, m.
    pub edge: f64,
    /// Edge length along over across.
    pub aspect: f64,
    /// Mass of one free corner against its proper mass.
    pub mass_ratio: f64,
    /// Gravity in g.
    pub gravity: f64,
    /// Area density, kg/m².
    pub density: f64,
}

/// A run that ended well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Largest force left over the weight of the sheet in the last step.
    pub residual: f64,
    /// Newton iterations of all steps.
    pub iterations: usize,
    /// Whether every step met its tolerance.
    pub converged: bool,
    /// Energy gained over the scale of the energies that moved; below rounding for a sound solver.
    pub energy_gain: f64,
    /// Greatest strain at the end.
    pub strain: f64,
}

/// An axis: its name, its values, and how to set it.
pub struct Axis {
    /// As in the list of extremes.
    pub name: &'static str,
    /// From one extreme to the other.
    pub values: &'static [f64],
    /// Puts a value into a case.
    pub set: fn(&mut Case, f64),
}

/// The axes that concern models and solvers.
pub const AXES: [Axis; 7] = [
    Axis {
        name: "stiffness",
        values: &[1e-2, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7],
        set: |c, v| c.stiffness = v,
    },
    Axis { name: "bending", values: &[0.0, 1e-9, 1e-6, 1e-5, 1e-3, 1.0], set: |c, v| c.bending = v },
    Axis {
        name: "time step",
        values: &[1e-5, 1e-4, 1e-3, 1.0 / 240.0, 1.0 / 60.0, 1e-2, 1e-1],
        set: |c, v| c.dt = v,
    },
    Axis { name: "edge", values: &[5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1], set: |c, v| c.edge = v },
    Axis { name: "aspect", values: &[1.0, 10.0, 100.0, 1000.0], set: |c, v| c.aspect = v },
    Axis { name: "mass ratio", values: &[1.0, 1e2, 1e4], set: |c, v| c.mass_ratio = v },
    Axis { name: "gravity", values: &[0.0, 1.0, 100.0], set: |c, v| c.gravity = v },
];

impl Default for Case {
    fn default() -> Self {
        Self {
            stiffness: 500.0,
            bending: 1e-5,
            dt: 1.0 / 60.0,
            edge: 0.01,
            aspect: 1.0,
            mass_ratio: 1.0,
            gravity: 1.0,
            density: 0.15,
        }
    }
}

impl Case {
    /// Every value of every axis, the rest as usual.
    pub fn singles() -> impl Iterator<Item = (String, Self)> {
        AXES.iter().flat_map(|axis| {
            axis.values.iter().map(move |&v| {
                let mut case = Self::default();
                (axis.set)(&mut case, v);
                (format!("{} {v}", axis.name), case)
            })
        })
    }

    /// Both ends of every axis with both ends of every other.
    pub fn pairs() -> impl Iterator<Item = (String, Self)> {
        let ends = |a: &'static Axis| [a.values[0], a.values[a.values.len() - 1]];
        (0..AXES.len()).flat_map(move |i| (0..i).map(move |j| (&AXES[i], &AXES[j]))).flat_map(
            move |(a, b)| {
                ends(a).into_iter().flat_map(move |va| {
                    ends(b).into_iter().map(move |vb| {
                        let mut case = Self::default();
                        (a.set)(&mut case, va);
                        (b.set)(&mut case, vb);
                        (format!("{} {va}, {} {vb}", a.name, b.name), case)
                    })
                })
            },
        )
    }

    /// Hangs a square of `cells` x `cells` by its upper edge, nudged out of its plane, for some
    /// steps.
    ///
    /// # Errors
    /// The typed error of whatever refuses the case.
    pub fn run(&self, cells: usize, steps: usize) -> Result<Outcome, ClothError> {
        check_parameter("edge", self.edge, |e| e > 0.0, "above 0 m")?;
        check_parameter("mass ratio", self.mass_ratio, |e| e > 0.0, "above 0")?;
        let (width, length) = (self.edge * cells as f64, self.edge * self.aspect * cells as f64);
        let (mesh, sheet) = self.mesh(cells, width, length)?;
        let mut model = self.model(&mesh, &sheet)?;
        model.masses[0] /= self.mass_ratio;
        let nudge = |v: usize| 1e-3 * self.edge * (1.7 * v as f64).sin();
        let mut state =
            State::at_rest(mesh.uv.iter().enumerate().map(|(v, p)| Vec3::new(p.x, p.y, nudge(v))).collect());
        let weight = self.density * width * length * 9.81 * self.gravity.max(1.0);
        // Nobody can do better than rounding of the stiffest force in the system.
        let size = width.max(length);
        let floor =
            1e-13 * self.stiffness * self.aspect * size + 1e-14 * self.bending / self.edge.powi(2) * size;
        let mut solver = ImplicitEuler::new(self.dt, (1e-6 * weight).max(floor));
        // Velocities are of the middle of a step: half a step of gravity is no gain.
        let half_step = 0.5 * 9.81 * self.gravity * self.dt;
        let before = model.total_energy(&state) + 0.5 * self.density * width * length * half_step * half_step;
        let mut outcome =
            Outcome { residual: 0.0, iterations: 0, converged: true, energy_gain: 0.0, strain: 0.0 };
        for _ in 0..steps {
            let report = solver.advance(&model, &mut state)?;
            outcome.residual = report.residual / weight;
            outcome.iterations += report.iterations;
            outcome.converged &= report.converged;
        }
        let scale = weight * length + model.elastic_energy(&state.x);
        outcome.energy_gain = (model.total_energy(&state) - before) / scale;
        outcome.strain = sheet.greatest_strain(&state.x).1;
        Ok(outcome)
    }

    fn mesh(&self, cells: usize, width: f64, length: f64) -> Result<(Rectangle, Sheet), ClothError> {
        let square = Rectangle::new(Layout::Alternating, 1.0, 1.0, cells);
        let uv = square.uv.iter().map(|p| nalgebra::Vector2::new(p.x * width, p.y * length)).collect();
        let mesh = Rectangle { uv, size: nalgebra::Vector2::new(width, length), ..square };
        let sheet = mesh.sheet(self.density)?;
        Ok((mesh, sheet))
    }

    fn model(&self, mesh: &Rectangle, sheet: &Sheet) -> Result<Model, ClothError> {
        let fabric = Fabric::isotropic(self.density, self.stiffness, 0.0, self.bending);
        Ok(Model::of(sheet)
            .made_of(Models::DEFAULT, &Cloth::of(sheet, &[&fabric]))?
            .pinned(|v| mesh.at_top(v))
            .under(Vec3::new(0.0, -9.81 * self.gravity, 0.0)))
    }
}

/// Energy that may be gained, of the energies that moved.
const MOST_GAIN: f64 = 1e-6;
/// Steps of a case.
const STEPS: usize = 4;

/// Each value of each axis as a check.
pub(super) fn singles(cells: usize) -> Vec<Check> {
    let check = |axis: &'static Axis| {
        axis.values.iter().map(move |&v| {
            let mut case = Case::default();
            (axis.set)(&mut case, v);
            Check::new(axis.name, v, Must::Converge, move || case.verdict(cells))
        })
    };
    AXES.iter().flat_map(check).collect()
}

/// All pairs of ends as checks.
pub(super) fn pairs(cells: usize) -> Vec<Check> {
    Case::pairs()
        .map(|(name, case)| Check::new("pairs", name, Must::Converge, move || case.verdict(cells)))
        .collect()
}

impl Case {
    /// Runs and judges.
    pub(crate) fn verdict(&self, cells: usize) -> Verdict {
        match self.run(cells, STEPS) {
            Ok(o) if o.converged && o.strain.is_finite() && o.energy_gain < MOST_GAIN => {
                Verdict::Converged(format!(
                    "residual {:.0e} weights, {} iterations, gain of energy {:+.0e}",
                    o.residual, o.iterations, o.energy_gain
                ))
            }
            Ok(o) => Verdict::Failed(format!("{o:?}")),
            Err(e) => Verdict::Failed(e.to_string()),
        }
    }
}

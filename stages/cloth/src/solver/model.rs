//! The mechanical system that solvers solve, and its state.

use crate::constraint::Obstacle;
use crate::energy::{
    Air, AirDrag, Cloth, Energy, Gravity, Models, Projection, Vec3, matrix_of, write_matrix,
};
use crate::error::{ClothError, check_parameter};
use crate::linear::BlockMatrix;
use crate::mesh::{Sheet, check_finite};
use crate::stopper::Stopper;

/// Masses, energies and constraints.
pub struct Model {
    /// Mass of each vertex, kg.
    pub masses: Vec<f64>,
    /// Inertia of each vertex where it is more than its mass, kg; empty where it is its mass. Only
    /// central differences take another.
    pub inertia: Vec<f64>,
    /// Acceleration of gravity, m/s².
    pub gravity: Vec3,
    /// All energies but gravity.
    pub energies: Vec<Box<dyn Energy>>,
    /// Pinned vertices.
    pub fixed: Vec<bool>,
    /// Mass-proportional drag, 1/s: force -drag m v.
    pub drag: f64,
    /// Stiffness-proportional damping time, s: force -viscosity K v.
    pub viscosity: f64,
    /// The air that the sheet moves in; none for a vacuum.
    pub air: Option<AirDrag>,
    /// Rigid bodies with a closed form, for solvers that move vertex by vertex.
    pub obstacles: Vec<Box<dyn Obstacle>>,
    /// Asked within steps.
    pub stopper: Stopper,
}

/// Positions and velocities.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Positions, m.
    pub x: Vec<Vec3>,
    /// Velocities, m/s, at the middle of the last step.
    pub v: Vec<Vec3>,
    /// Time, s.
    pub time: f64,
}

impl State {
    /// At rest at `x`.
    #[must_use]
    pub fn at_rest(x: Vec<Vec3>) -> Self {
        let v = vec![Vec3::zeros(); x.len()];
        Self { x, v, time: 0.0 }
    }

    /// The greatest speed, m/s.
    #[must_use]
    pub fn greatest_speed(&self) -> f64 {
        self.v.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }
}

impl Model {
    /// A sheet with no energies yet, standard gravity along -y, nothing held. Vertices that no
    /// triangle uses are held.
    #[must_use]
    pub fn of(sheet: &Sheet) -> Self {
        Self {
            masses: sheet.masses().to_vec(),
            inertia: Vec::new(),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            energies: Vec::new(),
            fixed: sheet.masses().iter().map(|&m| m == 0.0).collect(),
            drag: 0.0,
            viscosity: 0.0,
            air: None,
            obstacles: Vec::new(),
            stopper: Stopper::default(),
        }
    }

    /// Adds an energy.
    #[must_use]
    pub fn with(mut self, energy: impl Energy + 'static) -> Self {
        self.energies.push(Box::new(energy));
        self
    }

    /// Adds the models of a cloth.
    ///
    /// # Errors
    /// Faults that the models find in a fabric.
    pub fn made_of(mut self, models: Models, cloth: &Cloth<'_>) -> Result<Self, ClothError> {
        // Bending hysteresis is left out of dynamics.
        let energies = models.energies(cloth)?.into_iter().filter(|e| !e.is_hysteretic());
        self.energies.extend(energies.map(|e| e as Box<dyn Energy>));
        Ok(self)
    }

    /// Adds the membrane alone.
    ///
    /// # Errors
    /// Faults that the membrane finds in a fabric.
    pub fn with_membrane(mut self, models: Models, cloth: &Cloth<'_>) -> Result<Self, ClothError> {
        self.energies.push(models.membrane(cloth)?);
        Ok(self)
    }

    /// Holds every vertex that `chosen` picks.
    #[must_use]
    pub fn pinned(mut self, chosen: impl Fn(usize) -> bool) -> Self {
        self.fixed.iter_mut().enumerate().for_each(|(v, f)| *f |= chosen(v));
        self
    }

    /// Other gravity.
    #[must_use]
    pub fn under(mut self, gravity: Vec3) -> Self {
        self.gravity = gravity;
        self
    }

    /// In this air; `sheet` is the one that the model is of.
    #[must_use]
    pub fn in_air(mut self, air: Air, sheet: &Sheet) -> Self {
        self.air = air.acts().then(|| AirDrag::new(air, sheet.triangles()));
        self
    }

    /// Checks parameters and state before the first step.
    ///
    /// # Errors
    /// [`ClothError::NonFiniteInput`], [`ClothError::InvalidParameter`],
    /// [`ClothError::EmptyScene`].
    pub fn check(&self, state: &State) -> Result<(), ClothError> {
        if self.masses.is_empty() {
            return Err(ClothError::EmptyScene);
        }
        check_finite("positions", &state.x)?;
        check_finite("velocities", &state.v)?;
        check_finite("gravity", &[self.gravity])?;
        for (v, &m) in self.masses.iter().enumerate() {
            if !m.is_finite() {
                return Err(ClothError::NonFiniteInput { field: "masses", index: v });
            }
            if m <= 0.0 && !self.fixed[v] {
                let range = "above 0 kg for a vertex that is free to move";
                return Err(ClothError::InvalidParameter { name: "mass", value: m, range });
            }
        }
        check_parameter("drag", self.drag, |d| d >= 0.0, "0 or more 1/s")?;
        check_parameter("viscosity", self.viscosity, |d| d >= 0.0, "0 or more s")?;
        self.air.as_ref().map_or(Ok(()), |a| a.air.check())
    }

    /// Inertia of each vertex, kg.
    #[must_use]
    pub fn inertia(&self) -> &[f64] {
        if self.inertia.is_empty() { &self.masses } else { &self.inertia }
    }

    /// Gravity as an energy.
    #[must_use]
    pub fn weight(&self) -> Gravity {
        Gravity { masses: self.masses.clone(), acceleration: self.gravity }
    }

    /// The energies, borrowed.
    #[must_use]
    pub fn internal(&self) -> Vec<&dyn Energy> {
        self.energies.iter().map(AsRef::as_ref).collect()
    }

    /// Elastic energy at `x`, J.
    #[must_use]
    pub fn elastic_energy(&self, x: &[Vec3]) -> f64 {
        self.energies.iter().map(|e| e.value(x)).sum()
    }

    /// Elastic, gravitational and kinetic energy, J.
    #[must_use]
    pub fn total_energy(&self, state: &State) -> f64 {
        let kinetic: f64 = self.masses.iter().zip(&state.v).map(|(m, v)| 0.5 * m * v.norm_squared()).sum();
        self.elastic_energy(&state.x) + self.weight().value(&state.x) + kinetic
    }

    /// Elastic force and weight on every vertex at `x`, N, without reactions of pins.
    #[must_use]
    pub fn forces(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut gradient = vec![Vec3::zeros(); x.len()];
        self.energies.iter().for_each(|e| e.add_gradient(x, &mut gradient));
        gradient.iter().zip(&self.masses).map(|(g, m)| self.gravity * *m - g).collect()
    }

    /// The stiffness matrix at `x`, rows of held vertices included.
    #[must_use]
    pub fn stiffness(&self, x: &[Vec3], projection: Projection) -> BlockMatrix {
        let internal = self.internal();
        let (mut matrix, places) = matrix_of(x.len(), &internal);
        write_matrix(&internal, &places, x, projection, &mut matrix);
        matrix
    }
}

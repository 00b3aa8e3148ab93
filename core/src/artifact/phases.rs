//! What acts on a garment, one span of time after the other.

use super::{Artifact, ArtifactType, Kind, Measures, Vector3};
use crate::artifact::store::sound::{ensure, finite_figure};

/// What cloth moves in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// kg/m3; 0 for none.
    pub density: f64,
    /// Drag coefficient across the cloth.
    pub normal: f64,
    /// Drag coefficient along it.
    pub tangential: f64,
    /// Velocity, m/s.
    pub wind: Vector3,
}

/// A span of time with one gravity and one air.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Its name: `sew`, `drape`.
    pub name: String,
    /// How long it lasts, seconds; static solvers do not use it.
    pub seconds: f64,
    /// Acceleration, m/s2.
    pub gravity: Vector3,
    /// The air; nothing where the stage that drapes has its own.
    pub air: Option<Air>,
}

/// The phases of a prepared scene, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phases(pub Vec<Phase>);

impl Air {
    /// Density, the coefficients across and along, the wind.
    pub fn figures(&self) -> [f64; 6] {
        [self.density, self.normal, self.tangential, self.wind.x, self.wind.y, self.wind.z]
    }
}

impl Phases {
    /// What acts in the end; nothing where there are no phases.
    pub fn last_gravity(&self) -> Option<Vector3> {
        self.0.last().map(|p| p.gravity)
    }

    /// The air in the end, where the phases say.
    pub fn last_air(&self) -> Option<Air> {
        self.0.last().and_then(|p| p.air)
    }
}

impl ArtifactType for Phases {
    const KIND: Kind = Kind("phases");
    const IN_SETS: bool = false;
}

impl Artifact for Phases {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("phases", self.0.len());
        m.push("seconds", self.0.iter().map(|p| p.seconds).sum(), "s", 1e-9);
        m
    }

    fn check(&self) -> Result<(), String> {
        for p in &self.0 {
            finite_figure("length of a phase", p.seconds)?;
            ensure(p.seconds >= 0.0, || format!("phase \"{}\" lasts {} s", p.name, p.seconds))?;
            p.gravity.iter().try_for_each(|g| finite_figure("gravity", *g))?;
            p.air.iter().flat_map(Air::figures).try_for_each(|f| finite_figure("air", f))?;
        }
        Ok(())
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}

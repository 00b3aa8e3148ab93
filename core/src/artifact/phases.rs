//! What acts on a garment, one span of time after the other.

use super::sound::{ensure, finite_figure};
use super::{Artifact, ArtifactType, Digester, Kind, Measures, Vector3};

/// A span of time with one gravity.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Its name: `sew`, `drape`.
    pub name: String,
    /// How long it lasts, seconds; solvers that go straight to rest do not look at it.
    pub seconds: f64,
    /// Acceleration, m/s2.
    pub gravity: Vector3,
}

/// The phases of a prepared scene, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phases(pub Vec<Phase>);

impl Phases {
    /// What acts in the end; nothing where there are no phases.
    pub fn last_gravity(&self) -> Option<Vector3> {
        self.0.last().map(|p| p.gravity)
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

    fn digest(&self, d: &mut Digester) {
        d.text("phases").count(self.0.len());
        for p in &self.0 {
            d.text(&p.name).floats([p.seconds, p.gravity.x, p.gravity.y, p.gravity.z]);
        }
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
        }
        Ok(())
    }

    fn record(&self) -> Option<super::stored::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        Vec::new()
    }
}

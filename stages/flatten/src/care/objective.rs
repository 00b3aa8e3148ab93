//! Which energy a piece is solved for again.

use crate::energy::{
    ArapEnergy, EnergyDensity, SpringEnergy, SymmetricDirichletEnergy, WovenEnergy, WovenStiffness,
};
use crate::error::FlattenError;
use crate::flatteners::{ArapOptions, Flattening, Placement, arap, springs, symmetric_dirichlet, woven};
use crate::newton::StoppingLimits;
use crate::surface::PieceSurface;

/// A flattener by its energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// [`arap`].
    Arap,
    /// [`symmetric_dirichlet`].
    SymmetricDirichlet,
    /// [`springs`].
    Springs,
    /// [`woven`].
    Woven(WovenStiffness),
}

impl Objective {
    /// Flattens a surface.
    ///
    /// # Errors
    /// Those of the flattener.
    pub fn flatten(
        &self,
        surface: &PieceSurface,
        newton: StoppingLimits,
        placement: &Placement,
    ) -> Result<Flattening, FlattenError> {
        match self {
            Self::Arap => arap(surface, ArapOptions { newton, ..ArapOptions::default() }, placement),
            Self::SymmetricDirichlet => symmetric_dirichlet(surface, newton, placement),
            Self::Springs => springs(surface, newton, placement),
            Self::Woven(stiffness) => woven(surface, *stiffness, newton, placement),
        }
    }

    pub(crate) fn energy(&self, surface: &PieceSurface) -> Result<Box<dyn EnergyDensity>, FlattenError> {
        Ok(match self {
            Self::Arap => Box::new(ArapEnergy),
            Self::SymmetricDirichlet => Box::new(SymmetricDirichletEnergy),
            Self::Springs => Box::new(SpringEnergy::new(surface)),
            Self::Woven(stiffness) => Box::new(WovenEnergy::new(*stiffness)?),
        })
    }
}

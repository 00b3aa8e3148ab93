//! Which energy a piece is solved for again.

use crate::energy::{Arap, Energy, Springs, SymmetricDirichlet, Woven, WovenStiffness};
use crate::error::FlattenError;
use crate::flatteners::{ArapOptions, Flattening, Placement, arap, springs, symmetric_dirichlet, woven};
use crate::newton::NewtonOptions;
use crate::surface::Surface;

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
        surface: &Surface,
        newton: NewtonOptions,
        placement: &Placement,
    ) -> Result<Flattening, FlattenError> {
        match self {
            Self::Arap => arap(surface, ArapOptions { newton, ..ArapOptions::default() }, placement),
            Self::SymmetricDirichlet => symmetric_dirichlet(surface, newton, placement),
            Self::Springs => springs(surface, newton, placement),
            Self::Woven(stiffness) => woven(surface, *stiffness, newton, placement),
        }
    }

    pub(crate) fn energy(&self, surface: &Surface) -> Result<Box<dyn Energy>, FlattenError> {
        Ok(match self {
            Self::Arap => Box::new(Arap),
            Self::SymmetricDirichlet => Box::new(SymmetricDirichlet),
            Self::Springs => Box::new(Springs::new(surface)),
            Self::Woven(stiffness) => Box::new(Woven::new(*stiffness)?),
        })
    }
}

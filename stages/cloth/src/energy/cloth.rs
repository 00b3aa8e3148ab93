//! A sheet and its fabrics: what models of membrane and bending are made from.

use super::bending::Calibration;
use crate::energy::StrainLimit;
use crate::fabric::{Fabric, Rigidity};
use crate::mesh::Sheet;
use std::cell::OnceCell;
use toile_geometry::Vec3;

/// A sheet and what it is made of.
#[derive(Clone)]
pub struct Cloth<'a> {
    /// The triangles, at rest.
    pub sheet: &'a Sheet,
    /// The same as it was cut, where `sheet` has rest shapes that do not fit together (gathers):
    /// bending is calibrated on it.
    pub cut: &'a Sheet,
    /// The fabrics.
    pub fabrics: &'a [&'a Fabric],
    /// Which fabric each triangle is of.
    pub fabric: &'a dyn Fn(usize) -> usize,
    /// Strain limit of warp and weft.
    pub limit: Option<StrainLimit>,
    /// Border edges that keep their slope.
    pub clamp: Option<Clamp<'a>>,
    /// Pinned nodes, at which the border is not free. Empty where that does not matter.
    pub fixed: &'a [bool],
    /// The calibration of its hinges, made on first use.
    pub(crate) calibration: OnceCell<Calibration>,
}

/// Border edges with a held slope; their nodes must be pinned as well.
#[derive(Clone, Copy)]
pub struct Clamp<'a> {
    /// Whether a node is clamped; an edge is if both its ends are.
    pub chosen: &'a dyn Fn(u32) -> bool,
    /// The direction in which the sheet would go on beyond the edge.
    pub outward: &'a dyn Fn(u32) -> Vec3,
}

impl<'a> Cloth<'a> {
    /// A sheet of one fabric, free all around.
    #[must_use]
    pub fn of(sheet: &'a Sheet, fabrics: &'a [&'a Fabric; 1]) -> Self {
        let (limit, clamp, calibration) = (None, None, OnceCell::new());
        Self { sheet, cut: sheet, fabrics, fabric: &|_| 0, limit, clamp, fixed: &[], calibration }
    }

    /// The same with nodes that stay.
    #[must_use]
    pub fn holding(self, fixed: &'a [bool]) -> Self {
        Self { fixed, ..self }
    }

    /// The same with border edges that keep their slope, if there are any.
    #[must_use]
    pub fn clamped(self, clamp: impl Into<Option<Clamp<'a>>>) -> Self {
        Self { clamp: clamp.into(), ..self }
    }

    /// The calibration of hinges on this mesh.
    pub(crate) fn calibration(&self) -> &Calibration {
        self.calibration.get_or_init(|| Calibration::of(self.cut))
    }

    /// The number of a triangle's fabric.
    #[must_use]
    pub fn index(&self, triangle: usize) -> usize {
        (self.fabric)(triangle).min(self.fabrics.len().saturating_sub(1))
    }

    /// A triangle's fabric.
    #[must_use]
    pub fn fabric_of(&self, triangle: usize) -> &Fabric {
        self.fabrics[self.index(triangle)]
    }

    /// A triangle's bending rigidity.
    #[must_use]
    pub fn rigidity(&self, triangle: usize) -> Rigidity {
        Rigidity::of(self.fabric_of(triangle))
    }

    /// Beyond a border edge, the direction in which a clamp holds it.
    #[must_use]
    pub fn beyond(&self, [a, b]: [u32; 2]) -> Option<Vec3> {
        self.clamp.filter(|c| (c.chosen)(a) && (c.chosen)(b)).map(|c| (c.outward)(a))
    }

    /// Whether it has no bending rigidity.
    pub(super) fn is_limp(&self) -> bool {
        self.fabrics.iter().all(|f| Rigidity::of(f).is_zero())
    }
}

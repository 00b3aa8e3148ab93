//! A closed line of a drawing that may be the outline of a piece.

use super::super::side::Side;
use super::drawing::DrawnShape;
use super::role::Role;
use crate::mesh::predicates::inside;
use toile_core::prelude::*;

/// An outline with what it is drawn by.
pub(super) struct Outlined<'d, 't> {
    pub shape: &'d DrawnShape<'t>,
    /// Its sides, or the open lines that are to be its sides.
    pub(super) sides: Vec<Side>,
    pub(super) closed: bool,
    pub(super) holes: Vec<Vec<Point2>>,
    pub polygon: Vec<Point2>,
    pub area: f64,
}

impl Outlined<'_, '_> {
    pub(super) fn has(&self, p: Point2) -> bool {
        inside(&self.polygon, p)
    }

    pub(super) fn says(&self) -> bool {
        self.shape.role == Some(Role::Outline)
    }
}

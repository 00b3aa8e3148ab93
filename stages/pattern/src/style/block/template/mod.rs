//! A garment's template, fitted to an outline.

pub(crate) mod alike;
pub(crate) mod axis;
pub(crate) mod bow;
pub(crate) mod complete;
pub(crate) mod curve;
pub(crate) mod fit;
pub(crate) mod flat;
pub(crate) mod form;
pub(crate) mod halves;
pub(crate) mod marks;
pub(crate) mod piece_role;
pub(crate) mod places;
pub(crate) mod said;
pub(crate) mod seen;
pub(crate) mod segment;
pub(crate) mod stance;

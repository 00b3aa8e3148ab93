//! The parts of a mannequin, as distances from their axes.

pub(crate) mod arm;
pub(crate) mod bridge;
pub(crate) mod bump;
pub(crate) mod head;
pub(crate) mod leg;
pub(crate) mod limb;
pub(crate) mod loft;
pub(crate) mod profile;
pub(crate) mod relief;
pub(crate) mod spline;
pub(crate) mod swing;
pub(crate) mod torso;

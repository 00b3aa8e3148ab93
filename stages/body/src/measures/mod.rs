//! What is measured of a body, and sizes of tables.

pub(crate) mod bounds;
pub(crate) mod estimate;
pub(crate) mod fit;
pub(crate) mod landmarks;
pub(crate) mod measure;
pub(crate) mod sizes;

//! The surface of a body, from a field of distances to a closed mesh.

pub(crate) mod field;
pub(crate) mod isosurface;
pub(crate) mod refine;
pub(crate) mod slice;
pub(crate) mod thin;
pub(crate) mod topology;
pub(crate) mod untangle;

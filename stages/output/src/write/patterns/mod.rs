//! Writers of sewing patterns.

pub(crate) mod dxf;
pub(crate) mod file;
pub(crate) mod json;
pub(crate) mod pdf;
pub(crate) mod plt;
pub(crate) mod svg;
#[cfg(test)]
pub(crate) mod tests;

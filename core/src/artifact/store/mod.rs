//! Artifacts as bytes: digests, stored fields, checks.

pub(crate) mod digest;
#[cfg(test)]
pub(crate) mod every_field;
pub(crate) mod shared;
pub(crate) mod sound;
pub mod stored;

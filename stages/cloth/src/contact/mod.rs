//! Contact of cloth with the body and with itself.

pub mod body;
pub mod collision_surface;
pub mod coulomb;
pub mod friction;
pub mod past;
pub mod response;
pub(crate) mod start;
pub mod step_limit;

#[cfg(test)]
mod tests;

//! The reference that settings are compared with, and how well it is known.

pub mod floor;
pub mod richardson;
pub mod sample;

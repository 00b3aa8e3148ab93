//! The reference that settings are held against, and how well it is known.

pub mod floor;
pub mod richardson;
pub mod sample;

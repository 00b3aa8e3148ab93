//! All forces on cloth, each with its potential, gradient and matrix, and the system that sums
//! them.
//!
//! Depends on no other folder.

pub mod body_contact;
pub mod clearance;
pub(crate) mod contact;
pub mod contact_potential;
pub mod distance_query;
pub mod elastic;
pub mod force;
pub mod friction_history;
pub mod height_springs;
pub mod loads;
pub(crate) mod penetration;
pub mod ridges;
pub mod seam_force;
pub mod self_contact;
pub mod system;

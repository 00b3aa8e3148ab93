//! Everything that acts on cloth: what each force stores, its slope and its curvature, and the
//! system that sums them.
//!
//! Depends on no other room.

pub mod body_contact;
pub mod clearance;
pub(crate) mod contact;
pub mod contact_potential;
pub(crate) mod coulomb;
pub mod elastic;
pub mod friction_history;
pub mod height_springs;
pub(crate) mod penetration;
pub mod ridges;
pub mod seam_force;
pub mod self_contact;
pub mod system;

//! Straight to static equilibrium, coarse to fine.
//!
//! Rooms in the order in which they depend on each other: `forces`, `factor`, `levels`, `newton`,
//! `report`, `drive`. `drive::solve` is where a scene goes in.

pub mod drive;
pub mod factor;
pub mod forces;
pub mod levels;
pub mod newton;
pub mod report;

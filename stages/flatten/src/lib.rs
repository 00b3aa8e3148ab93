//! Flattening of garment pieces: surfaces in space become flat patterns at true scale.
//!
//! ```text
//! garment mesh --islands--> Surface --flatteners--> flat points --care--> pattern pieces
//!                              |                        |
//!                              +------- distortion -----+
//! ```
//!
//! A [`surface::PieceSurface`] is a checked mesh. A flattener gives it flat places; all of them go
//! without flipped triangles, and the same input gives the same bits for any number of threads.
//!
//! ```
//! use nalgebra::Point3;
//! use toile_flatten::distortion::distortion;
//! use toile_flatten::flatteners::{ArapOptions, Placement, arap};
//! use toile_flatten::surface::PieceSurface;
//!
//! // A sheet folded along its diagonal: two triangles, seen from outside counter-clockwise.
//! let corners = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 1.0], [0.0, 4.0, 0.0]];
//! let corners = corners.map(Point3::from).to_vec();
//! let surface = PieceSurface::new(corners, vec![[0, 1, 3], [1, 2, 3]])?;
//! let flat = arap(&surface, ArapOptions::default(), &Placement::default())?;
//! let table = distortion(&surface, &flat.points)?;
//! assert!(table.area_error.abs() < 1e-6 && table.flipped == 0);
//! // The grain, the y of space, stands upright: the edge from the first corner to the last rises by its length.
//! assert!((flat.points[3].y - flat.points[0].y - 4.0).abs() < 0.02);
//! # Ok::<(), toile_flatten::FlattenError>(())
//! ```
//!
//! Limits: a piece needs a boundary and no handles; a tube must be cut along a seam before, or it
//! comes out as a ring. Boundaries may cross themselves in the plane (counted by
//! [`distortion::distortion`]), triangles do not flip. A garment that is stretched flattens to its
//! stretched size unless a tension is stated. Cost of a piece of n triangles: about n^1.5 products;
//! a million triangles take about 1.5 GB.

pub mod care;
#[cfg(test)]
mod damaged;
pub mod distortion;
pub mod energy;
pub mod error;
pub mod flatteners;
mod frames;
pub mod grain;
pub mod islands;
mod linear;
pub mod newton;
#[cfg(test)]
mod shapes;
pub mod start;
pub mod surface;
mod system;

pub use error::{FlattenError, SurfaceError};

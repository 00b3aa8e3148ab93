//! The grain: which direction of the garment is the pattern's y.
//!
//! A direction in space maps to the plane by the mean over the area of `J d`, d its part in each
//! triangle's plane. That mean is a weighted sum of the flat places, so keeping it upright is one
//! linear equation.

use crate::error::FlattenError;
use crate::frames::{TriangleFrames, local_axes};
use crate::surface::PieceSurface;
use nalgebra::{Point2, Rotation2, Vector2, Vector3};

/// What becomes upright in the plane.
#[derive(Debug, Clone, PartialEq)]
pub enum Grain {
    /// A direction in space, on the whole piece.
    Direction(Vector3<f64>),
    /// A direction in space, at one triangle.
    At {
        /// The triangle.
        triangle: u32,
        /// The direction; its part in the triangle's plane counts.
        direction: Vector3<f64>,
    },
    /// From one vertex of the surface to another, such as along a centre front.
    Edge([u32; 2]),
}

/// A mean shorter than this (of 1) has no direction: the grain is at right angles to the piece.
const LEAST_MEAN: f64 = 1e-3;

impl Grain {
    /// The y of space: garments stand.
    #[must_use]
    pub fn up() -> Self {
        Self::Direction(Vector3::y())
    }

    /// The same grain on a piece that was cut out, by its lists of the vertices and triangles that
    /// it came from; none if the piece does not have them.
    #[must_use]
    pub fn on_piece(&self, vertices: &[u32], triangles: &[u32]) -> Option<Self> {
        let find = |list: &[u32], k: u32| list.iter().position(|&x| x == k).map(|x| x as u32);
        Some(match self {
            Self::Direction(d) => Self::Direction(*d),
            Self::At { triangle, direction } => {
                Self::At { triangle: find(triangles, *triangle)?, direction: *direction }
            }
            Self::Edge([from, to]) => Self::Edge([find(vertices, *from)?, find(vertices, *to)?]),
        })
    }

    pub(crate) fn check(&self, surface: &PieceSurface) -> Result<(), FlattenError> {
        let range = "a finite direction other than zero";
        match self {
            Self::Direction(d) | Self::At { direction: d, .. }
                if !(d.norm() > 0.0 && d.norm().is_finite()) =>
            {
                Err(FlattenError::InvalidParameter { name: "grain", value: d.norm(), range })
            }
            Self::At { triangle, .. } if *triangle as usize >= surface.triangles().len() => {
                let range = "a triangle of the piece";
                Err(FlattenError::InvalidParameter {
                    name: "grain.triangle",
                    value: f64::from(*triangle),
                    range,
                })
            }
            Self::Edge(ends) => {
                let vertices = surface.positions().len();
                match ends.iter().find(|&&v| v as usize >= vertices) {
                    Some(&vertex) => Err(FlattenError::NoSuchVertex { what: "the grain", vertex, vertices }),
                    None => Ok(()),
                }
            }
            _ => Ok(()),
        }
    }

    /// The weighted sum of flat places (in units of [`TriangleFrames::unit`]) that becomes upright;
    /// the length of a direction is made 1.
    pub(crate) fn weights(&self, surface: &PieceSurface, frames: &TriangleFrames) -> Vec<(u32, f64)> {
        match self {
            Self::Direction(d) => {
                let mut sums = vec![0.0; surface.positions().len()];
                for (t, corners) in surface.triangles().iter().enumerate() {
                    let w = corner_weights(surface, frames, t, &d.normalize());
                    corners.iter().zip(w).for_each(|(&v, w)| sums[v as usize] += w * frames.share(t));
                }
                sums.into_iter().enumerate().map(|(v, w)| (v as u32, w)).collect()
            }
            Self::At { triangle, direction } => {
                let t = *triangle as usize;
                let w = corner_weights(surface, frames, t, &direction.normalize());
                surface.triangles()[t].into_iter().zip(w).collect()
            }
            Self::Edge([from, to]) => vec![(*from, -1.0), (*to, 1.0)],
        }
    }
}

/// How much each corner's place adds to the image of a direction.
fn corner_weights(surface: &PieceSurface, frames: &TriangleFrames, t: usize, d: &Vector3<f64>) -> [f64; 3] {
    let [x, y] = local_axes(surface, t);
    let d = Vector2::new(d.dot(&x), d.dot(&y));
    frames.gradients(t).map(|g| g.dot(&d))
}

/// The weighted sum of places.
pub(crate) fn weighted_sum(weights: &[(u32, f64)], flat: &[Point2<f64>]) -> Vector2<f64> {
    weights.iter().fold(Vector2::zeros(), |sum, (v, w)| sum + flat[*v as usize].coords * *w)
}

/// Turns a flat piece until the weighted sum points up; false if it has no direction.
pub(crate) fn turn_upright(weights: &[(u32, f64)], flat: &mut [Point2<f64>]) -> bool {
    let mean = weighted_sum(weights, flat);
    let has_direction = mean.norm() > LEAST_MEAN;
    if !has_direction {
        return false;
    }
    let turn = Rotation2::rotation_between(&mean, &Vector2::y());
    flat.iter_mut().for_each(|p| *p = turn * *p);
    true
}

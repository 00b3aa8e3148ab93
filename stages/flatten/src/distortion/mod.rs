//! How much a flat piece differs from the garment's: the table by which a flattening is judged.
//!
//! Errors are counted as the published method does from 3D to 2D: area `(S3 - S2) / S3`, outline
//! `(L3 - L2) / L3`. Strains are those of the garment against the flat cloth (`|J^-1 e| - 1`):
//! above zero where the cloth must stretch. Cost O(n log n).

mod crossings;
mod strain;
#[cfg(test)]
mod tests;

use crossings::boundary_crossings;
use strain::triangle_strains;
pub use strain::{StrainSpread, TriangleStrain};

use crate::error::SurfaceError;
use crate::frames::{TriangleFrames, flat_area, flipped};
use crate::surface::{FREE, PieceSurface};
use nalgebra::{Point2, Vector2, Vector3};
use std::f64::consts::PI;

/// The table of one piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Distortion {
    /// Area on the garment, in square units.
    pub area_3d: f64,
    /// Area of the flat piece.
    pub area_2d: f64,
    /// `(S3 - S2) / S3` of the whole piece.
    pub area_error: f64,
    /// `sum |S3 - S2| / sum S3` over its triangles.
    pub local_area_error: f64,
    /// Length of all boundary loops on the garment.
    pub outline_3d: f64,
    /// Length of all boundary loops in the plane.
    pub outline_2d: f64,
    /// `(L3 - L2) / L3`.
    pub outline_error: f64,
    /// The corners of the boundary, by their vertices.
    pub corners: Vec<CornerAngles>,
    /// The largest change of an inner angle at a corner of the boundary, degrees; 0 without
    /// corners.
    pub corner_change: f64,
    /// Strain along the warp.
    pub warp: StrainSpread,
    /// Strain along the weft.
    pub weft: StrainSpread,
    /// The larger principal strain of each triangle, by absolute value.
    pub principal: StrainSpread,
    /// Triangles face down or without area.
    pub flipped: usize,
    /// Pairs of boundary edges that cross.
    pub crossings: usize,
    /// Strain of each triangle, for colouring.
    pub triangles: Vec<TriangleStrain>,
}

/// The inner angle at a corner of the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerAngles {
    /// The vertex of the surface.
    pub vertex: u32,
    /// On the garment, degrees.
    pub space: f64,
    /// In the plane, degrees.
    pub plane: f64,
}

/// A boundary vertex is a corner if its angle differs by more than this from a straight line,
/// degrees.
pub const CORNER: f64 = 30.0;

/// Measures a flat piece against its surface; y is the warp.
///
/// # Errors
/// [`SurfaceError::LengthMismatch`] unless there is one finite place a vertex.
pub fn distortion(surface: &PieceSurface, flat: &[Point2<f64>]) -> Result<Distortion, SurfaceError> {
    let wanted = surface.positions().len();
    if flat.len() != wanted {
        return Err(SurfaceError::LengthMismatch { what: "flat places", found: flat.len(), wanted });
    }
    if let Some(vertex) = flat.iter().position(|p| !(p.x.is_finite() && p.y.is_finite())) {
        return Err(SurfaceError::NotFinite { vertex });
    }
    let frames = TriangleFrames::new(surface);
    let triangles = triangle_strains(surface, &frames, flat);
    let spread = |of: fn(&TriangleStrain) -> f64| {
        StrainSpread::new(
            &triangles.iter().enumerate().map(|(t, s)| (of(s), frames.share(t))).collect::<Vec<_>>(),
        )
    };
    let (area_3d, area_2d) = (surface.area(), flat_area(surface.triangles(), flat));
    let local = triangles.iter().enumerate().map(|(t, s)| frames.share(t) * (s.area_ratio - 1.0).abs()).sum();
    let (outline_3d, outline_2d) = outlines(surface, flat);
    let corners = corners_of(surface, flat);
    Ok(Distortion {
        area_3d,
        area_2d,
        area_error: (area_3d - area_2d) / area_3d,
        local_area_error: local,
        outline_3d,
        outline_2d,
        outline_error: (outline_3d - outline_2d) / outline_3d,
        corner_change: corners.iter().map(|c| (c.plane - c.space).abs()).fold(0.0, f64::max),
        corners,
        warp: spread(|s| s.warp),
        weft: spread(|s| s.weft),
        principal: spread(|s| s.principal),
        flipped: flipped(surface.triangles(), flat).len(),
        crossings: boundary_crossings(surface.loops(), flat).len(),
        triangles,
    })
}

/// The lengths of all boundary loops, on the garment and in the plane.
fn outlines(surface: &PieceSurface, flat: &[Point2<f64>]) -> (f64, f64) {
    let (mut space, mut plane) = (0.0, 0.0);
    for vertices in surface.loops() {
        let next = vertices.iter().cycle().skip(1);
        for (&a, &b) in vertices.iter().zip(next) {
            space += (surface.positions()[b as usize] - surface.positions()[a as usize]).norm();
            plane += (flat[b as usize] - flat[a as usize]).norm();
        }
    }
    (space, plane)
}

/// The angles of vertices that are corners on the garment.
fn corners_of(surface: &PieceSurface, flat: &[Point2<f64>]) -> Vec<CornerAngles> {
    let n = surface.positions().len();
    let (mut space, mut plane, mut on_boundary) = (vec![0.0; n], vec![0.0; n], vec![false; n]);
    for (t, corners) in surface.triangles().iter().enumerate() {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3] as usize);
            let x = surface.positions();
            space[a] += angle3(&(x[b] - x[a]), &(x[c] - x[a]));
            plane[a] += angle2(&(flat[b] - flat[a]), &(flat[c] - flat[a]));
            if surface.opposite()[3 * t + k] == FREE {
                (on_boundary[a], on_boundary[b]) = (true, true);
            }
        }
    }
    let corner = |v: &usize| on_boundary[*v] && (space[*v] - PI).abs() > CORNER.to_radians();
    let angles = |v: usize| CornerAngles {
        vertex: v as u32,
        space: space[v].to_degrees(),
        plane: plane[v].to_degrees(),
    };
    (0..n).filter(corner).map(angles).collect()
}

fn angle3(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

fn angle2(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    a.perp(b).atan2(a.dot(b))
}

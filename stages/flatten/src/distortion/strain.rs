//! Strain of each triangle, and its spread over the piece.

use crate::energy::singular_values;
use crate::frames::{TriangleFrames, corners};
use crate::surface::PieceSurface;
use nalgebra::Point2;

/// The strain of one triangle of the garment against the flat cloth, without unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleStrain {
    /// Along the pattern's y.
    pub warp: f64,
    /// Along the pattern's x.
    pub weft: f64,
    /// The principal strain of larger absolute value.
    pub principal: f64,
    /// How far warp and weft leave a right angle on the garment, radians.
    pub shear: f64,
    /// Flat area over area on the garment; below zero if face down.
    pub area_ratio: f64,
}

/// How a strain is spread over the area.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StrainSpread {
    /// Mean of the strain with its sign.
    pub signed_mean: f64,
    /// Mean of the absolute strain.
    pub mean: f64,
    /// The absolute strain that 99 % of the area stay below.
    pub p99: f64,
    /// The largest absolute strain.
    pub max: f64,
}

impl StrainSpread {
    /// Of values with weights above zero.
    #[must_use]
    pub fn new(values: &[(f64, f64)]) -> Self {
        let whole: f64 = values.iter().map(|(_, w)| w).sum();
        let mut sorted: Vec<(f64, f64)> = values.iter().map(|(v, w)| (v.abs(), w / whole)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut below = 0.0;
        let p99 = sorted.iter().find(|(_, w)| {
            below += w;
            below >= 0.99
        });
        let max = sorted.last().map_or(0.0, |v| v.0);
        Self {
            signed_mean: values.iter().map(|(v, w)| v * w / whole).sum(),
            mean: sorted.iter().map(|(v, w)| v * w).sum(),
            p99: p99.map_or(max, |v| v.0),
            max,
        }
    }
}

/// Strains of all triangles; those without flat area count as stretched without limit.
#[must_use]
pub(super) fn triangle_strains(
    surface: &PieceSurface,
    frames: &TriangleFrames,
    flat: &[Point2<f64>],
) -> Vec<TriangleStrain> {
    let flat = frames.scaled(flat);
    let strain = |(t, &triangle): (usize, &[u32; 3])| {
        let j = frames.map(t, corners(&flat, triangle));
        let (a, b) = (j.row(0).transpose(), j.row(1).transpose());
        let d = j.determinant();
        let s = singular_values(&j);
        let (least, most) = (1.0 / s.x - 1.0, 1.0 / s.y.abs() - 1.0);
        TriangleStrain {
            warp: a.norm() / d.abs() - 1.0,
            weft: b.norm() / d.abs() - 1.0,
            principal: if least.abs() > most.abs() { least } else { most },
            shear: (a.dot(&b) / (a.norm() * b.norm())).clamp(-1.0, 1.0).asin(),
            area_ratio: d,
        }
    };
    surface.triangles().iter().enumerate().map(strain).collect()
}

//! How each panel is strained against its flat piece.
//!
//! Method: the deformation gradient `F` of each triangle from its flat corners to those in space.
//! Its singular values are the greatest and least stretch; the images of the flat unit vectors
//! along y and x give warp and weft, the angle between them less than 90 degrees the shear. Area
//! and outline errors are those of Fan et al. 1999; what the body stretches counts as it was cut
//! (`toile_drape::measure::tight`). Along gathered seams the flat corners are drawn together as a
//! solver has them. Cost: linear.

use nalgebra::{Matrix2, Matrix3x2};
use serde::Serialize;
use std::collections::BTreeMap;
use toile_core::StageError;
use toile_core::artifact::{Collider, Garment, quantile};
use toile_drape::measure::panel_figures;
use toile_drape::measure::tight::Tight;

/// Strain of one panel, shares.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PanelStrain {
    /// 99th percentile of the greatest `|singular value - 1|` of its triangles.
    pub p99: f64,
    /// The greatest of all its triangles.
    pub max: f64,
    /// 99th percentile of `|stretch - 1|` along the warp.
    pub warp_p99: f64,
    /// The same along the weft.
    pub weft_p99: f64,
    /// 99th percentile of the shear, degrees.
    pub shear_p99_degrees: f64,
    /// `(S2 - S3) / S2`; what the body stretches counts as it was cut.
    pub area_error: f64,
    /// `(L2 - L3) / L2` of the outline, likewise.
    pub outline_error: f64,
}

/// Strain of a garment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Strain {
    /// Each panel's, by name.
    pub panels: BTreeMap<String, PanelStrain>,
    /// 99th percentile of the strain of all edges; those that the body stretches count as not
    /// strained.
    pub free_p99: f64,
    /// The panel that the body stretches most and the 99th percentile of its stretched edges.
    pub tightest: Option<(String, f64)>,
    /// The triangle of the greatest strain.
    pub worst: Option<usize>,
}

/// Strains of a garment whose flat shape is known, on a body where there is a collider.
///
/// # Errors
/// A panel has no flat area or no outline.
pub fn strain(garment: &Garment, collider: Option<&Collider>) -> Result<Strain, StageError> {
    let tight = Tight::of(garment, collider);
    let errors = panel_figures(garment, Some(&tight))?;
    let corners = garment.gathered_corners();
    let of = |k: usize| {
        let flat = garment.triangles[k].map(|v| garment.rest[v as usize]);
        of_triangle(corners.as_ref().map_or(flat, |c| c[k]), garment, k)
    };
    let all: Vec<[f64; 4]> = (0..garment.triangles.len()).map(of).collect();
    let mut panels = BTreeMap::new();
    for p in &garment.panels {
        let own = &all[p.triangles.clone()];
        let sorted = |c: usize| {
            let mut values: Vec<f64> = own.iter().map(|s| s[c]).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let p99 = |c: usize| quantile(&sorted(c), 0.99);
        let error = errors.get(&p.name).copied().unwrap_or_default();
        let figures = PanelStrain {
            p99: p99(0),
            max: sorted(0).last().copied().unwrap_or(0.0),
            warp_p99: p99(1),
            weft_p99: p99(2),
            shear_p99_degrees: p99(3),
            area_error: error.area_error,
            outline_error: error.outline_error,
        };
        panels.insert(p.name.clone(), figures);
    }
    let worst = (0..all.len()).reduce(|a, b| if all[b][0] > all[a][0] { b } else { a });
    let tightest = tight.tightest(garment).map(|(name, strain)| (name.to_owned(), strain));
    Ok(Strain { panels, free_p99: tight.rest(), tightest, worst })
}

/// The greatest strain in any direction, that of warp and weft, and the shear in degrees.
fn of_triangle([a, b, c]: [toile_core::artifact::Point2; 3], garment: &Garment, k: usize) -> [f64; 4] {
    let [p, q, r] = garment.triangles[k].map(|v| garment.positions[v as usize]);
    let Some(back) = Matrix2::from_columns(&[b - a, c - a]).try_inverse() else {
        return [f64::INFINITY, 0.0, 0.0, 0.0];
    };
    let gradient = Matrix3x2::from_columns(&[q - p, r - p]) * back;
    let squared = (gradient.transpose() * gradient).symmetric_eigenvalues();
    let greatest = squared.iter().map(|s| (s.max(0.0).sqrt() - 1.0).abs()).fold(0.0, f64::max);
    let (weft, warp) = (gradient.column(0), gradient.column(1));
    let angle = warp.angle(&weft).to_degrees();
    [greatest, (warp.norm() - 1.0).abs(), (weft.norm() - 1.0).abs(), (90.0 - angle).abs()]
}

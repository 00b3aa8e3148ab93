//! How far a garment is from the reference, in what its maker cares about. No two figures are
//! blended.

use crate::measure::Ran;
use crate::silhouette::{ViewSide, agreement};
use crate::surface::{DrapedSurface, Spread, displacement, distance};
use crate::{girth, texture};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_core::StageError;
use toile_core::artifact::PanelFigures;

/// Distances over a surface, millimetres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Millimetres {
    /// Mean.
    pub mean: f64,
    /// 95 % of the surface are not farther.
    pub p95: f64,
    /// Worst.
    pub max: f64,
}

impl From<Spread> for Millimetres {
    fn from(s: Spread) -> Self {
        Millimetres { mean: s.mean * 1e3, p95: s.p95 * 1e3, max: s.max * 1e3 }
    }
}

/// A garment against the reference.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// To the nearest point of the other surface, both ways.
    pub distance_mm: Millimetres,
    /// Between the places of the same points of the pattern.
    pub displacement_mm: Millimetres,
    /// Ease at bust, waist and hip minus the reference's.
    pub ease_mm: BTreeMap<String, f64>,
    /// Greatest gap of a seam: its exact value is 0.
    pub seam_gap_mm: f64,
    /// Greatest difference of a panel's area error from the reference's, percentage points.
    pub area_pp: f64,
    /// Greatest difference of a panel's outline error from the reference's, percentage points.
    pub outline_pp: f64,
    /// 99th percentile of the strain minus the reference's, percentage points.
    pub strain_p99_pp: f64,
    /// Intersection over union of the silhouettes from the front.
    pub silhouette_front: f64,
    /// The same from the side.
    pub silhouette_side: f64,
    /// Root mean square difference of the texture, grey levels; none without textures.
    pub texture_levels: Option<f64>,
}

/// Compares two runs of a pipeline.
///
/// Errors: garments without triangles, or of other panels.
pub fn compare(found: &Ran, reference: &Ran) -> Result<Errors, StageError> {
    same_panels(found, reference)?;
    let (a, b) = (DrapedSurface::new(&found.garment)?, DrapedSurface::new(&reference.garment)?);
    let texture = match (&found.model, &reference.model) {
        (Some(p), Some(q)) => texture::difference((&a, p), (&b, q)),
        _ => None,
    };
    let panel = |figure: fn(&PanelFigures) -> f64| {
        let panels = |ran: &Ran| ran.figures.as_ref().map(|f| f.panels.clone()).unwrap_or_default();
        let (p, q) = (panels(found), panels(reference));
        let both = p.iter().filter_map(|(name, p)| Some((figure(p) - figure(q.get(name)?)).abs()));
        both.fold(0.0, f64::max) * 1e2
    };
    let strain = |ran: &Ran| ran.figures.as_ref().map_or(0.0, |f| f.garment.edge_strain.p99);
    Ok(Errors {
        distance_mm: distance(&a, &b).into(),
        displacement_mm: displacement(&a, &b).into(),
        ease_mm: minus(&ease(found), &ease(reference)),
        seam_gap_mm: found.garment.seam_gap_max() * 1e3,
        area_pp: panel(|p| p.area_error),
        outline_pp: panel(|p| p.outline_error),
        strain_p99_pp: (strain(found) - strain(reference)) * 1e2,
        silhouette_front: agreement(&found.garment, &reference.garment, ViewSide::Front),
        silhouette_side: agreement(&found.garment, &reference.garment, ViewSide::Left),
        texture_levels: texture,
    })
}

/// Girth of the garment minus the body's there, millimetres, by the name of the height; nothing
/// where the garment does not reach it or nobody wears it.
pub fn ease(ran: &Ran) -> BTreeMap<String, f64> {
    let Some(body) = &ran.body else { return BTreeMap::new() };
    let at = |(name, height, middle): (&str, f64, f64)| {
        let cloth = girth::of_garment(&ran.garment, height, middle)?;
        let skin = girth::girth(&body.positions, &body.triangles, height, middle)?;
        Some((name.to_owned(), (cloth - skin) * 1e3))
    };
    girth::levels(body).into_iter().filter_map(at).collect()
}

fn minus(a: &BTreeMap<String, f64>, b: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
    a.iter().filter_map(|(name, x)| Some((name.clone(), x - b.get(name)?))).collect()
}

fn same_panels(a: &Ran, b: &Ran) -> Result<(), StageError> {
    let names = |ran: &Ran| ran.garment.panels.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    let (p, q) = (names(a), names(b));
    match p == q {
        true => Ok(()),
        false => Err(StageError::invalid(format!(
            "garments of other panels cannot be compared: {} and {}",
            p.join(", "),
            q.join(", ")
        ))),
    }
}

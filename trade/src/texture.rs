//! How differently two models are coloured, at the same points of the pattern.
//!
//! Colours are read from the textures without light, so that neither folds nor the camera count.
//! Limit: a panel without a texture has its material's one colour.

use crate::surface::{ClothPoint, DrapedSurface, pairs};
use toile_core::artifact::{Mesh, Model};

/// Root mean square difference in grey levels (0 to 255) over the surface; none where a panel is
/// missing in a model.
pub(crate) fn difference(a: (&DrapedSurface<'_>, &Model), b: (&DrapedSurface<'_>, &Model)) -> Option<f64> {
    let pairs = pairs(a.0, b.0);
    let squares: Option<Vec<f64>> = pairs
        .iter()
        .map(|(of_a, of_b)| {
            let (p, q) = (colour(a, of_a)?, colour(b, of_b)?);
            Some((0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>() / 3.0)
        })
        .collect();
    let squares = squares.filter(|s| !s.is_empty())?;
    Some((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

fn colour((surface, model): (&DrapedSurface<'_>, &Model), spot: &ClothPoint) -> Option<[f64; 3]> {
    let garment = surface.garment;
    let panel = garment.panels.iter().find(|p| p.triangles.contains(&spot.triangle))?;
    let mesh = model.meshes.iter().find(|m| m.name == panel.name)?;
    let material = model.materials.get(mesh.material)?;
    let first = panel.vertices.start;
    let corners = garment.triangles[spot.triangle].map(|i| i as usize - first);
    match material.texture {
        None => Some(material.colour.map(|c| f64::from(c) * 255.0)),
        Some(texture) => {
            let pixels = &model.textures.get(texture)?.pixels;
            let uv = uv(mesh, corners, spot.weights)?;
            let (w, h) = pixels.dimensions();
            let at = |t: f64, n: u32| ((t * f64::from(n)) as u32).min(n.saturating_sub(1));
            Some(pixels.get_pixel(at(uv[0], w), at(uv[1], h)).0.map(f64::from))
        }
    }
}

fn uv(mesh: &Mesh, corners: [usize; 3], weights: [f64; 3]) -> Option<[f64; 2]> {
    let mut at = [0.0; 2];
    for (corner, weight) in corners.into_iter().zip(weights) {
        let uv = mesh.uv.get(corner)?;
        at = [0, 1].map(|k| at[k] + f64::from(uv[k]) * weight);
    }
    Some(at)
}

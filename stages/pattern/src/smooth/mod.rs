//! Smoothers: panel to panel, and a garment in space.
//!
//! Those of panels share what they must not break (see `guard`): no triangle turns over, corners
//! and ends of named edges are pinned, the outline stays within its tolerance and edges keep their
//! lengths.

mod guard;
mod laplacian;
mod plane;
mod surface;
mod surface_smoother;
mod taubin;
#[cfg(test)]
mod tests;
mod topology;

pub use laplacian::Laplacian;
pub use plane::PlaneSmoother;
pub use surface::{PlaneSmoothing, smooth_to_planes};
pub use surface_smoother::SurfaceSmoother;
pub use taubin::Taubin;
pub use topology::Neighbours;

use toile_core::prelude::*;

/// Adds this folder's stages.
pub fn register(registry: &mut Registry) {
    registry.add::<PlaneSmoother>();
    registry.add::<Laplacian>();
    registry.add::<Taubin>();
    registry.add::<SurfaceSmoother>();
}

/// Checks what a panel from elsewhere (a plugin, a file) may have wrong.
fn check(panel: &Panel) -> Result<(), StageError> {
    let n = panel.positions.len();
    if panel.triangles.is_empty() {
        return Err(StageError::invalid("the panel has no triangles"));
    }
    if !panel.positions.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
        return Err(StageError::invalid("the panel has a vertex that is not a finite number"));
    }
    let chains = panel.edges.iter().map(|e| &e.vertices).chain(panel.inner.iter().map(|c| &c.vertices));
    let mut listed = panel.boundary.iter().chain(panel.holes.iter().flatten()).chain(chains.flatten());
    if listed.any(|&v| v as usize >= n) || panel.triangles.iter().flatten().any(|&v| v as usize >= n) {
        return Err(StageError::invalid(format!("the panel names a vertex beyond its {n}")));
    }
    Ok(())
}

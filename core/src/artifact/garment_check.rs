//! Garments that no stage can work on.

use super::Garment;
use crate::{ErrorCode, StageError};

/// Triangles thinner than this share of their longest edge squared count as of no area.
const LEAST_SHAPE: f64 = 1e-9;

/// What may help where the mesh has a fault.
const AGAIN: &str =
    "mesh the panel again with another edge length, or merge points that lie on each other in the file";

/// The panel of a vertex.
fn of(garment: &Garment, vertex: usize) -> String {
    garment.panel_of(vertex).map_or_else(|| "the cloth".into(), |p| format!("panel \"{}\"", p.name))
}

impl Garment {
    /// Refuses a garment that no solver can work on: empty, with numbers that are not finite, with
    /// triangles or edges of no size, with cloth that weighs nothing.
    pub fn check_solvable(&self) -> Result<(), StageError> {
        if self.positions.is_empty() || self.triangles.is_empty() {
            return Err(StageError::invalid("the garment is empty: it has no triangles")
                .hint("see what the mesher and the placement made of the panels"));
        }
        let n = self.positions.len();
        if self.rest.len() != n || self.velocities.len() != n || self.weld.len() != n {
            return Err(StageError::internal("the garment's vertex lists differ in length"));
        }
        let seams = self.seams.iter().flat_map(|s| s.pairs.iter().flatten());
        if self.triangles.iter().flatten().chain(seams).chain(&self.weld).any(|&i| i as usize >= n) {
            let text = "the garment's triangles or seams name points that it does not have";
            return Err(StageError::invalid(text)
                .hint("the file is damaged: write it again from the program that made it"));
        }
        check_finite(self)?;
        check_fabrics(self)?;
        check_triangles(self)
    }
}

fn check_finite(garment: &Garment) -> Result<(), StageError> {
    let finite = |i: usize| {
        let flat = garment.rest[i].iter().all(|x| x.is_finite());
        flat && garment.positions[i].iter().chain(garment.velocities[i].iter()).all(|x| x.is_finite())
    };
    match (0..garment.positions.len()).find(|&i| !finite(i)) {
        Some(i) => {
            let text = format!("a point of {} has a coordinate that is not a finite number", of(garment, i));
            Err(StageError::invalid(text)
                .hint("the file is damaged: write it again from the program that made it"))
        }
        None => Ok(()),
    }
}

fn check_fabrics(garment: &Garment) -> Result<(), StageError> {
    let covered: usize = garment.panels.iter().map(|p| p.triangles.len()).sum();
    if covered != garment.triangles.len() {
        return Err(StageError::internal("some triangles belong to no panel"));
    }
    for panel in &garment.panels {
        let (density, name) = (panel.fabric.area_density, &panel.name);
        if !(density.is_finite() && density > 0.0) {
            let text = format!("panel \"{name}\" has a mass of {density} kg/m2, it must be above 0");
            return Err(
                StageError::invalid(text).hint("give the fabric its weight: `area_density`, in kg/m2")
            );
        }
        for (curve, word) in
            [(&panel.fabric.warp, "warp"), (&panel.fabric.weft, "weft"), (&panel.fabric.shear, "shear")]
        {
            if !curve.rises() {
                let text =
                    format!("the {word} curve of \"{}\" does not rise from the origin", panel.fabric.name);
                return Err(
                    StageError::invalid(text).hint("give points of strain and force that rise in both")
                );
            }
        }
    }
    Ok(())
}

fn check_triangles(garment: &Garment) -> Result<(), StageError> {
    for t in &garment.triangles {
        let [a, b, c] = t.map(|k| garment.rest[k as usize]);
        let sides = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
        if let Some(k) = sides.iter().position(|&s| s <= 0.0) {
            let text = format!("{} has two points at one place", of(garment, t[k] as usize));
            return Err(StageError::new(ErrorCode::DegenerateTriangles, text).hint(AGAIN));
        }
        let longest = sides.iter().fold(0.0, |m: f64, s| m.max(*s));
        if (b - a).perp(&(c - a)).abs() <= LEAST_SHAPE * longest * longest {
            let text = format!("{} has a triangle without area", of(garment, t[0] as usize));
            return Err(StageError::new(ErrorCode::DegenerateTriangles, text).hint(AGAIN));
        }
    }
    Ok(())
}

//! Panels as one garment.

use super::sew::Offsets;
use std::sync::Arc;
use toile_core::prelude::*;

/// Where the vertices of each panel begin.
pub(crate) fn offsets(panels: &Set<Panel>) -> Result<Offsets<'_>, StageError> {
    let mut offsets = Offsets::new();
    let mut offset = 0;
    for (name, panel) in panels.iter() {
        if panel.triangles.is_empty() {
            return Err(StageError::invalid(format!("the panel \"{name}\" has no triangles")));
        }
        offsets.insert(name, (offset, panel));
        offset += panel.positions.len();
    }
    match offsets.is_empty() {
        true => Err(StageError::invalid("there are no panels to place")),
        false => Ok(offsets),
    }
}

/// The panels with their seams still open, their vertices at `points` in the order of the offsets.
pub(crate) fn whole(
    offsets: &Offsets,
    seams: Vec<GarmentSeam>,
    fabric: &Fabric,
    points: Vec<Point3>,
) -> Garment {
    let fabric = Arc::new(fabric.clone());
    let n = points.len();
    let mut g = Garment {
        velocities: vec![Vector3::zeros(); n],
        rest: Vec::with_capacity(n),
        triangles: Vec::new(),
        panels: Vec::new(),
        seams,
        weld: (0..n as u32).collect(),
        pinned: Vec::new(),
        status: SolveStatus::default(),
        starts: Vec::new(),
        motion: None,
        positions: points,
    };
    offsets.iter().for_each(|(name, (first, panel))| append(&mut g, name, *first, panel, &fabric));
    g
}

/// Adds a panel's flat points and triangles at the garment's end.
fn append(g: &mut Garment, name: &str, first: usize, panel: &Panel, fabric: &Arc<Fabric>) {
    let first_triangle = g.triangles.len();
    let shift = |v: &u32| v + first as u32;
    g.rest.extend(&panel.positions);
    g.triangles.extend(panel.triangles.iter().map(|t| t.map(|v| shift(&v))));
    g.panels.push(GarmentPanel {
        name: name.to_owned(),
        vertices: first..g.rest.len(),
        triangles: first_triangle..g.triangles.len(),
        boundary: panel.boundary.iter().map(shift).collect(),
        photo_px: panel.photo_px.clone(),
        fabric: fabric.clone(),
        layer: 0,
    });
}

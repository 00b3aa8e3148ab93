//! A garment from its file and the flat pieces that its run wrote beside it.

use crate::subject::{bare, finished, panel, unknown_fabric};
use std::sync::Arc;
use toile_core::artifact::{Garment, GarmentSeam, Point3, SeamState};
use toile_output::flat::FileMeshes;
use toile_output::write::origin::{FILE, FlatPanel, FlatPieces};

/// The garment in the order of its flat pieces: every vertex stands where the file's corners have
/// it.
///
/// # Errors
/// Where the file's triangles are not those of the pieces, one sentence.
pub(super) fn garment_of_pieces(meshes: &FileMeshes, pieces: &FlatPieces) -> Result<Garment, String> {
    let mut garment = bare();
    let fabric = Arc::new(unknown_fabric());
    let total: usize = pieces.panels.iter().map(|p| p.triangles.len()).sum();
    let in_a_row = total == meshes.triangles.len();
    for p in &pieces.panels {
        let (v, t) = (garment.positions.len(), garment.triangles.len());
        let own: Vec<usize> = match named(meshes, &p.name) {
            Some(own) => own,
            None if in_a_row => (t..t + p.triangles.len()).collect(),
            None => return Err(format!("the garment has no panel \"{}\" of \"{FILE}\"", p.name)),
        };
        garment.positions.extend(placed(meshes, p, &own)?);
        garment.rest.extend(&p.positions);
        garment.triangles.extend(p.triangles.iter().map(|t| t.map(|i| i + v as u32)));
        let (vertices, triangles) = (v..garment.positions.len(), t..garment.triangles.len());
        garment.panels.push(panel(&p.name, vertices, triangles, &fabric));
    }
    if total != meshes.triangles.len() {
        let there = meshes.triangles.len();
        return Err(format!("the garment has {there} triangles, the pieces of \"{FILE}\" have {total}"));
    }
    let seam = |s: &toile_output::write::origin::FlatSeam| GarmentSeam {
        name: s.name.clone(),
        kind: s.kind,
        pairs: s.pairs.clone(),
        state: SeamState::Closed,
    };
    garment.seams = pieces.seams.iter().map(seam).collect();
    Ok(finished(garment))
}

/// The triangles of the group of that name; none where no group has it.
fn named(meshes: &FileMeshes, name: &str) -> Option<Vec<usize>> {
    // Writers of OBJ keep no blanks.
    let alike = |n: &&String| **n == name || **n == name.replace(' ', "_");
    let is_group: Vec<bool> = meshes.names.iter().map(|n| alike(&n)).collect();
    let own: Vec<usize> = (0..meshes.triangles.len())
        .filter(|k| is_group.get(meshes.groups[*k] as usize) == Some(&true))
        .collect();
    (!own.is_empty()).then_some(own)
}

/// Where the vertices of a panel stand.
fn placed(meshes: &FileMeshes, panel: &FlatPanel, own: &[usize]) -> Result<Vec<Point3>, String> {
    if own.len() != panel.triangles.len() {
        return Err(format!(
            "panel \"{}\" has {} triangles, \"{FILE}\" has {}",
            panel.name,
            own.len(),
            panel.triangles.len()
        ));
    }
    let mut at: Vec<Option<Point3>> = vec![None; panel.positions.len()];
    for (k, t) in own.iter().enumerate() {
        for c in 0..3 {
            let place = meshes.positions[meshes.triangles[*t][c] as usize];
            let known = at[panel.triangles[k][c] as usize].get_or_insert(place);
            if *known != place {
                return Err(format!(
                    "triangle {k} of panel \"{}\" is not connected as \"{FILE}\" says",
                    panel.name
                ));
            }
        }
    }
    // A vertex without a triangle stands with the first of its panel.
    let first = at.iter().flatten().next().copied().unwrap_or_else(Point3::origin);
    Ok(at.into_iter().map(|p| p.unwrap_or(first)).collect())
}

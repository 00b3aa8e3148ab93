//! Seams as vertex pairs of the garment.

use std::collections::BTreeMap;
use toile_core::prelude::*;

/// The vertices of each named panel within the garment.
pub(crate) type Offsets<'a> = BTreeMap<&'a str, (usize, &'a Panel)>;

/// The pairs of every seam of the plan, in the plan's order.
pub(crate) fn seams(plan: &SewingPlan, panels: &Offsets) -> Result<Vec<GarmentSeam>, StageError> {
    plan.seams.iter().map(|seam| pair(seam, panels)).collect()
}

fn pair(seam: &Seam, panels: &Offsets) -> Result<GarmentSeam, StageError> {
    let a = vertices(&seam.a, panels)?;
    let mut b = vertices(&seam.b, panels)?;
    if a.len() != b.len() {
        return Err(unequal(seam, a.len(), b.len()));
    }
    if !seam.reversed {
        b.reverse();
    }
    // The legs of a dart share its tip; an elastic band along one edge has that edge twice.
    let is_one = seam.a == seam.b;
    let pairs = a.into_iter().zip(b).filter(|(a, b)| is_one || a != b).map(|(a, b)| [a, b]).collect();
    Ok(GarmentSeam { name: seam.name(), kind: seam.kind, pairs, state: SeamState::Open })
}

fn unequal(seam: &Seam, a: usize, b: usize) -> StageError {
    let message = format!(
        "`{}` has {a} vertices and `{}` has {b}, so they cannot be sewn point by point",
        seam.a, seam.b
    );
    StageError::invalid(message)
        .hint("mesh both panels with the same mesher and edge length, after the style has named their seams")
}

/// The garment's vertices along an edge or inner line.
pub(crate) fn vertices(at: &EdgeRef, panels: &Offsets) -> Result<Vec<u32>, StageError> {
    let (offset, panel) = panels.get(at.panel.as_str()).ok_or_else(|| unknown_panel(&at.panel, panels))?;
    let edge = panel.edge(&at.edge).map(|e| &e.vertices);
    let inner = || panel.inner.iter().find(|c| c.name == at.edge).map(|c| &c.vertices);
    let found = edge.or_else(inner).ok_or_else(|| unknown_edge(at, panel))?;
    Ok(found.iter().map(|v| v + *offset as u32).collect())
}

/// The plan names a panel that there is none of.
pub(crate) fn unknown_panel(name: &str, panels: &Offsets) -> StageError {
    StageError::invalid(format!("there is no panel \"{name}\""))
        .hint(format!("the panels are {}", list(panels.keys().copied())))
}

fn unknown_edge(at: &EdgeRef, panel: &Panel) -> StageError {
    let names =
        panel.edges.iter().map(|e| e.name.as_str()).chain(panel.inner.iter().map(|c| c.name.as_str()));
    StageError::invalid(format!("the panel \"{}\" has no edge \"{}\"", at.panel, at.edge))
        .hint(format!("its edges are {}", list(names)))
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}

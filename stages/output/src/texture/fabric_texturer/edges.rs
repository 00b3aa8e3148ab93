//! Which edges of which panels are finished, and how.

use super::super::finish::{EdgeFinish, FinishKind};
use std::collections::{BTreeMap, BTreeSet};
use toile_core::prelude::*;

/// The finished edges of each panel of the garment; `ribs` and `stitches` are widths by an edge's
/// name, alone or after that of its panel.
///
/// A name that no edge has is warned of: it costs the look of an edge, not the garment.
///
/// Errors: an edge with two finishes, no panels to look it up in.
pub(super) fn finishes(
    ribs: &BTreeMap<String, Length>,
    stitches: &BTreeMap<String, Length>,
    garment: &Garment,
    panels: Option<&Set<Panel>>,
    cx: &Context,
) -> Result<Vec<Vec<EdgeFinish>>, StageError> {
    let wanted: Vec<(FinishKind, &String, f64)> = [(FinishKind::Rib, ribs), (FinishKind::Stitches, stitches)]
        .into_iter()
        .flat_map(|(kind, widths)| widths.iter().map(move |(name, width)| (kind, name, width.metres())))
        .collect();
    let mut all = vec![Vec::new(); garment.panels.len()];
    let Some((first, ..)) = wanted.first() else { return Ok(all) };
    let Some(panels) = panels else {
        let text = "no panels stand before it, whose edges could be looked up";
        return Err(StageError::invalid(text)
            .hint("let a mesher stand before it, or leave `ribs` and `stitches` out")
            .at(field(*first)));
    };
    let mut found = BTreeSet::new();
    for (of_panel, panel) in all.iter_mut().zip(&garment.panels) {
        let Some(flat) = panels.get(&panel.name) else { continue };
        for edge in &flat.edges {
            let full = format!("{}.{}", panel.name, edge.name);
            let own: Vec<_> = wanted.iter().filter(|(_, n, _)| **n == edge.name || **n == full).collect();
            if own.len() > 1 {
                return Err(StageError::invalid(format!("the edge `{full}` has two finishes"))
                    .hint("name it once, in `ribs` or in `stitches`")
                    .at(field(own[1].0)));
            }
            for (kind, name, width) in own {
                found.insert(*name);
                let line = edge.vertices.iter().map(|v| flat.positions[*v as usize]).collect();
                of_panel.push(EdgeFinish { kind: *kind, width: *width, line });
            }
        }
    }
    let edges = panels.0.values().flat_map(|p| p.edges.iter().map(|e| e.name.as_str()));
    let edges: BTreeSet<&str> = edges.collect();
    for (kind, name, _) in wanted.iter().filter(|(_, name, _)| !found.contains(name)) {
        let told = no_edge(*kind, name, &edges);
        cx.warn(format!("{}; {}", told.message, told.hint.unwrap_or_default()));
    }
    Ok(all)
}

/// Names of `ribs` and `stitches` that no edge of the outlines has.
pub(super) fn lacking(
    ribs: &BTreeMap<String, Length>,
    stitches: &BTreeMap<String, Length>,
    outlines: &[(&str, &Outline)],
) -> Vec<StageError> {
    let edges =
        || outlines.iter().flat_map(|(panel, o)| o.edges.iter().map(move |e| (*panel, e.name.as_str())));
    let has = |name: &str| edges().any(|(panel, edge)| edge == name || format!("{panel}.{edge}") == name);
    let names: BTreeSet<&str> = edges().map(|(_, edge)| edge).collect();
    let wanted = [(FinishKind::Rib, ribs), (FinishKind::Stitches, stitches)].into_iter();
    let wanted = wanted.flat_map(|(kind, widths)| widths.keys().map(move |name| (kind, name)));
    wanted.filter(|(_, name)| !has(name)).map(|(kind, name)| no_edge(kind, name, &names)).collect()
}

fn field(kind: FinishKind) -> &'static str {
    match kind {
        FinishKind::Rib => "ribs",
        FinishKind::Stitches => "stitches",
    }
}

fn no_edge(kind: FinishKind, name: &str, edges: &BTreeSet<&str>) -> StageError {
    let names = edges.iter().copied().collect::<Vec<_>>().join(", ");
    StageError::invalid(format!("no panel has an edge \"{name}\" to finish"))
        .hint(format!("the edges are {names}; a panel's own is `panel.edge`"))
        .at(field(kind))
}

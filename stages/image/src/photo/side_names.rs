//! Whether the photos have the names that the pipeline's style takes: a photo named "fornt" would
//! be a piece that nothing is sewn to.

use toile_core::prelude::*;
use toile_core::{Node, nearest, needed_for};

/// The stage of seams that the file names itself.
const SEAMS: &str = "Seams";
/// The sides that the built-in styles sew.
const SIDES: [&str; 2] = ["front", "back"];

/// The photos that a style needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// The front; what there is no photo of is made by it.
    Front,
    /// Front and back, which it sews to each other.
    Both,
}

/// What a style of that name needs; none for a stage that is no built-in style of photos.
pub fn needs(stage: &str) -> Option<Needs> {
    match stage {
        "Block" | "Fitting" => Some(Needs::Front),
        "Outline" => Some(Needs::Both),
        _ => None,
    }
}

/// Names that are misspelt, and a front that is missing where the garment is cut from it.
pub(super) fn misnamed(names: &[&str], placed: &Placed<'_>) -> Vec<StageError> {
    let styles = styles(placed);
    let Some((style, _)) = styles.first() else { return Vec::new() };
    let meant = |name: &str| {
        let missing = SIDES.into_iter().filter(|side| !names.contains(side));
        nearest(name, missing).filter(|_| !SIDES.contains(&name))
    };
    let misspelt = |name: &&str| {
        let side = meant(name)?;
        let e = StageError::invalid(format!("`{}` takes no photo named {name:?}", style.id));
        Some(e.hint(format!("did you mean {side:?}?")).at("photos").within(*name))
    };
    let mut found: Vec<StageError> = names.iter().filter_map(misspelt).collect();
    let has_front = names.iter().any(|name| *name == SIDES[0] || meant(name) == Some(SIDES[0]));
    let cuts = styles.iter().find(|(_, needs)| *needs == Needs::Front);
    if let (Some((style, _)), false) = (cuts, has_front || names.is_empty()) {
        let e = StageError::invalid(format!(
            "`{}` cuts the garment from \"front\", and no photo has that name",
            style.id
        ));
        found.push(e.hint("call the photo of the garment's front \"front\"").at("photos"));
    }
    found
}

/// Photos that the style makes nothing of, and a side without its other.
pub(super) fn unused(names: &[&str], placed: &Placed<'_>) -> Vec<StageError> {
    let styles = styles(placed);
    let Some((style, needs)) = styles.first() else { return Vec::new() };
    let other = |name: &&&str| !SIDES.contains(name);
    let mut found: Vec<StageError> = names
        .iter()
        .filter(other)
        .map(|name| {
            let e = StageError::invalid(format!("`{}` does not use the photo {name:?}", style.id));
            e.hint("it takes \"front\" and \"back\"").at("photos").within(*name)
        })
        .collect();
    let sides: Vec<&&str> = names.iter().filter(|name| SIDES.contains(name)).collect();
    if let ([lone], Needs::Both) = (&sides[..], needs) {
        let missing = if **lone == SIDES[0] { SIDES[1] } else { SIDES[0] };
        let e =
            StageError::invalid(format!("the photo {lone:?} has no other side, and its piece stays unsewn"));
        let hint = format!("give a photo of the other side, or write `{missing:?}: MirrorOf({lone:?})`");
        found.push(e.hint(hint).at("photos").within(**lone));
    }
    found
}

/// The built-in styles that the photos come to, with what they need; none where the file names the
/// seams itself.
fn styles<'a>(placed: &Placed<'a>) -> Vec<(&'a Node, Needs)> {
    let after = placed.index + 1..placed.nodes.len();
    let reads = |k: &usize| needed_for(placed.nodes, &[*k]).get(placed.index) == Some(&true);
    let behind: Vec<&Node> = after.filter(reads).map(|k| &placed.nodes[k]).collect();
    if behind.iter().any(|n| n.card.name == SEAMS) {
        return Vec::new();
    }
    let mut styles: Vec<_> = behind.into_iter().filter_map(|n| Some((n, needs(n.card.name)?))).collect();
    // A mannequin is fitted for a style, which is named first.
    styles.sort_by_key(|(n, _)| n.card.role != Role::Style);
    styles
}

//! Where the sections' stages stand among the others.
//!
//! A section's stage stands as early as it can: at the start where it takes nothing, else right
//! after the first stage with which all that it takes has been made. So `style` follows the edge
//! detector, and `seams` follows `style`.

use super::read::Draft;
use super::words::required;
use crate::{Card, Kind};
use std::collections::BTreeSet;

/// All stages in the order in which they run.
pub(super) fn place(sections: Vec<Draft>, stages: Vec<Draft>) -> Vec<Draft> {
    let takes_nothing =
        |d: &Draft| d.from.is_empty() && d.card.as_ref().is_none_or(|c| required(c).next().is_none());
    let (mut placed, mut waiting): (Vec<Draft>, Vec<Draft>) = sections.into_iter().partition(takes_nothing);
    placed.extend(stages);
    // One section may wait for what another makes, so the list is gone through until nothing moves.
    while let Some((i, at)) = next(&waiting, &placed) {
        placed.insert(at, waiting.remove(i));
    }
    for draft in waiting {
        let at = first_use(&draft, &placed);
        placed.insert(at, draft);
    }
    placed
}

/// The first waiting stage that can be placed, and where.
fn next(waiting: &[Draft], placed: &[Draft]) -> Option<(usize, usize)> {
    waiting.iter().enumerate().find_map(|(i, d)| Some((i, earliest(d, placed)?)))
}

/// The index after the first stage with which everything that `draft` takes has been made.
fn earliest(draft: &Draft, placed: &[Draft]) -> Option<usize> {
    let mut kinds: BTreeSet<Kind> = draft.card.iter().flat_map(required).collect();
    let mut ids: BTreeSet<&str> = draft.from.iter().map(|(id, _)| id.as_str()).collect();
    for (i, before) in placed.iter().enumerate() {
        kinds.retain(|k| !makes(before, *k));
        ids.remove(before.id.as_str());
        if kinds.is_empty() && ids.is_empty() {
            return Some(i + 1);
        }
    }
    None
}

/// Before the first stage that needs what `draft` makes, so that what it lacks is one fault only.
fn first_use(draft: &Draft, placed: &[Draft]) -> usize {
    let needs = |card: &Card| required(card).any(|k| makes(draft, k));
    placed.iter().position(|d| d.card.as_ref().is_some_and(needs)).unwrap_or(placed.len())
}

fn makes(draft: &Draft, kind: Kind) -> bool {
    draft.card.as_ref().is_some_and(|c| c.outputs.iter().any(|o| o.kind == kind))
}

//! Where the sections' stages stand among the others.
//!
//! A section's stage stands as early as it can: at the start where it takes nothing, else right
//! after the first stage with which all that it takes has been made. So `style` follows the edge
//! detector, and `seams` follows `style`.

use super::words::required;
use crate::load::syntax::draft::Draft;
use std::collections::BTreeSet;
use toile_core::{Card, Kind};

/// All stages in the order in which they run.
pub(super) fn place(sections: Vec<Draft>, stages: Vec<Draft>) -> Vec<Draft> {
    let takes_nothing =
        |d: &Draft| d.from.is_empty() && d.card.as_ref().is_none_or(|c| required(c).next().is_none());
    let (mut placed, mut waiting): (Vec<Draft>, Vec<Draft>) = sections.into_iter().partition(takes_nothing);
    placed.extend(stages);
    // One section may wait for what another makes, so the list is gone through until it is empty.
    while !waiting.is_empty() {
        let (i, at) = next(&waiting, &placed).unwrap_or_else(|| stuck(&waiting, &placed));
        placed.insert(at, waiting.remove(i));
    }
    placed
}

/// The first waiting stage that can be placed, and where; one that could use what another makes
/// lets that one go first.
fn next(waiting: &[Draft], placed: &[Draft]) -> Option<(usize, usize)> {
    let places = || waiting.iter().enumerate().filter_map(|(i, d)| Some((i, earliest(d, placed)?)));
    let patient = |(i, _): &(usize, usize)| !defers(*i, waiting);
    places().find(patient).or_else(|| places().next())
}

/// True where another waiting stage is the source of something that this one takes, if only at
/// will.
fn defers(i: usize, waiting: &[Draft]) -> bool {
    let takes = |k: Kind| waiting[i].card.iter().any(|c| c.inputs.iter().any(|p| p.kind == k));
    let others = waiting.iter().enumerate().filter(|(j, _)| *j != i);
    others
        .filter_map(|(_, d)| Some((d, d.card.as_ref()?)))
        .any(|(d, card)| card.outputs.iter().any(|o| takes(o.kind) && is_source(d, o.kind)))
}

/// The index after the first stage with which everything that `draft` takes has been made: what it
/// needs, and what it could use where some stage makes that.
fn earliest(draft: &Draft, placed: &[Draft]) -> Option<usize> {
    let mut kinds: BTreeSet<Kind> = draft.card.iter().flat_map(required).collect();
    let optional = draft.card.iter().flat_map(|c| &c.inputs).filter(|p| p.optional).map(|p| p.kind);
    kinds.extend(optional.filter(|k| placed.iter().any(|d| is_source(d, *k))));
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

/// Nothing waiting can be fed: takes one that waits for no other, and puts it before the first
/// stage that needs it, so that what it lacks is one fault only.
fn stuck(waiting: &[Draft], placed: &[Draft]) -> (usize, usize) {
    let waits =
        |d: &&Draft| d.card.iter().flat_map(required).any(|k| waiting.iter().any(|o| is_source(o, k)));
    let i = waiting.iter().position(|d| !waits(&d)).unwrap_or(0);
    let needs = |card: &Card| required(card).any(|k| waiting.get(i).is_some_and(|d| makes(d, k)));
    let at = placed.iter().position(|d| d.card.as_ref().is_some_and(needs)).unwrap_or(placed.len());
    (i, at)
}

/// True where the stage makes the kind without taking it.
fn is_source(draft: &Draft, kind: Kind) -> bool {
    makes(draft, kind) && !draft.card.iter().flat_map(required).any(|k| k == kind)
}

fn makes(draft: &Draft, kind: Kind) -> bool {
    draft.card.as_ref().is_some_and(|c| c.outputs.iter().any(|o| o.kind == kind))
}

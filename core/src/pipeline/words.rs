//! Kinds and stages in the words of diagnostics.

use crate::artifact::{ArtifactType, RunLog};
use crate::{Card, Kind, Registry, SectionValue};
use std::collections::BTreeSet;

/// The most stages that a hint names.
const MAX_NAMED: usize = 4;

/// `a mask`, `an outline`.
pub(super) fn a(kind: Kind) -> String {
    match kind.0.starts_with(['a', 'e', 'i', 'o', 'u']) {
        _ if kind.0.ends_with('s') => kind.0.to_owned(),
        true => format!("an {kind}"),
        false => format!("a {kind}"),
    }
}

/// `a photo`, `a photo and a mask`, `nothing`.
pub(super) fn all_of(kinds: impl IntoIterator<Item = Kind>) -> String {
    let words: BTreeSet<Kind> = kinds.into_iter().collect();
    list(&words.into_iter().map(a).collect::<Vec<_>>(), "and")
}

/// `x`, `x and y`, `x, y and z`.
pub(super) fn list(words: &[String], join: &str) -> String {
    match words {
        [] => "nothing".into(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} {join} {last}", rest.join(", ")),
    }
}

/// The kinds that a stage cannot do without.
pub(super) fn required(card: &Card) -> impl Iterator<Item = Kind> {
    card.inputs.iter().filter(|p| !p.optional && p.kind != RunLog::KIND).map(|p| p.kind)
}

/// Names the stages that would make `wanted` out of what is there, or else those that make it at all.
pub(super) fn bridge(wanted: Kind, live: &BTreeSet<Kind>, registry: &Registry) -> Option<String> {
    let makes = |c: &&Card| c.outputs.iter().any(|o| o.kind == wanted) && !required(c).any(|k| k == wanted);
    let makers: Vec<&Card> = registry.cards().filter(makes).collect();
    let ready: Vec<&Card> =
        makers.iter().copied().filter(|c| required(c).all(|k| live.contains(&k))).collect();
    let best = if ready.is_empty() { &makers } else { &ready };
    // Stages that start from the same kinds are named together.
    let sources: BTreeSet<Kind> = required(best.first()?).collect();
    let alike: Vec<String> = best
        .iter()
        .filter(|c| required(c).collect::<BTreeSet<_>>() == sources)
        .take(MAX_NAMED)
        .map(|c| written(c, registry))
        .collect();
    let from = if sources.is_empty() { String::new() } else { format!(" from {}", all_of(sources)) };
    let advice = match (ready.is_empty(), alike.len()) {
        (true, _) => "",
        (false, 1) => "; put it before",
        (false, _) => "; put one of them before",
    };
    let verb = if alike.len() == 1 { "makes" } else { "make" };
    Some(format!("{} {verb} {}{from}{advice}", list(&alike, "and"), a(wanted)))
}

/// A stage as the user would write it: `` `Otsu()` ``, `` `body: Mannequin()` ``, `` `photos: ...` ``.
fn written(card: &Card, registry: &Registry) -> String {
    let section = registry.sections().iter().find_map(|s| match s.holds {
        SectionValue::Stage(role) if role == card.role => Some(format!("`{}: {}()`", s.field, card.name)),
        SectionValue::Table { stage, .. } if stage == card.name => Some(format!("`{}: ...`", s.field)),
        _ => None,
    });
    section.unwrap_or_else(|| format!("`{}()`", card.name))
}

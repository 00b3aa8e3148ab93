//! Kinds and stages in the words of diagnostics.

use std::collections::BTreeSet;
use toile_core::RunLog;
use toile_core::artifact::ArtifactType;
use toile_core::{Card, Kind, Registry, Section, SectionValue};

/// The most stages that a hint names.
const MAX_NAMED: usize = 4;

/// `a mask`, `an outline`.
pub(crate) fn a(kind: Kind) -> String {
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
pub(crate) fn list(words: &[String], join: &str) -> String {
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

/// Names the stages that would make `wanted` out of what is there, or else those that make it at
/// all.
pub(super) fn bridge(wanted: Kind, live: &BTreeSet<Kind>, registry: &Registry) -> Option<String> {
    let makes = |c: &&Card| c.outputs.iter().any(|o| o.kind == wanted) && !required(c).any(|k| k == wanted);
    // In the order of the registry, so that the default of a role is named first.
    let makers: Vec<&Card> = registry.in_order().into_iter().filter(makes).collect();
    let ready: Vec<&Card> =
        makers.iter().copied().filter(|c| required(c).all(|k| live.contains(&k))).collect();
    let best = if ready.is_empty() { &makers } else { &ready };
    // Stages that start from the same kinds are named together.
    let sources: BTreeSet<Kind> = required(best.first()?).collect();
    let alike: Vec<&Card> = best
        .iter()
        .copied()
        .filter(|c| required(c).collect::<BTreeSet<_>>() == sources)
        .take(MAX_NAMED)
        .collect();
    let words: Vec<String> = alike.iter().map(|c| written(c, registry)).collect();
    let from = if sources.is_empty() { String::new() } else { format!(" from {}", all_of(sources)) };
    let is_section = alike.first().is_some_and(|c| section_of(c, registry).is_some());
    let advice = match (ready.is_empty(), is_section, alike.len()) {
        (true, ..) => "",
        (_, true, 1) => "; add it",
        (_, true, _) => "; add one of them",
        (_, false, 1) => "; put it before",
        (_, false, _) => "; put one of them before",
    };
    let verb = if alike.len() == 1 { "makes" } else { "make" };
    Some(format!("{} {verb} {}{from}{advice}", list(&words, "and"), a(wanted)))
}

/// The section that holds such a stage.
fn section_of<'a>(card: &Card, registry: &'a Registry) -> Option<&'a Section> {
    let of = |s: &&Section| match s.holds {
        SectionValue::Stage(role) => role == card.role && !is_table(card, registry),
        SectionValue::Table { stage, .. } => stage == card.name,
    };
    registry.sections().iter().find(of)
}

/// True where a table section stands for this very stage.
pub(super) fn is_table(card: &Card, registry: &Registry) -> bool {
    let of = |s: &Section| matches!(s.holds, SectionValue::Table { stage, .. } if stage == card.name);
    registry.sections().iter().any(of)
}

/// A stage as the user would write it: `` `Otsu()` ``, `` `body: Mannequin()` ``, `` `photos: ...`
/// ``.
fn written(card: &Card, registry: &Registry) -> String {
    match section_of(card, registry) {
        Some(Section { field, holds: SectionValue::Stage(_) }) => format!("`{field}: {}()`", card.name),
        Some(Section { field, .. }) => format!("`{field}: ...`"),
        None => format!("`{}()`", card.name),
    }
}

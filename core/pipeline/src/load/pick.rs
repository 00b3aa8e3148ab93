//! Which of several stages of one name is meant.
//!
//! Stages follow each other by type, and so do their names: `Laplacian()` after a binariser finds
//! edges, after a mesher it smooths. The one is meant that takes what `from` names, that can be
//! fed at all, and that reads from the nearest stage before it, in this order of weight.

use super::words::required;
use crate::load::syntax::draft::Draft;
use toile_core::{Card, Kind};

/// A stage that stands before, as far as it matters here.
#[derive(Debug)]
pub(super) struct Before {
    name: String,
    id: Option<String>,
    makes: Vec<Kind>,
}

impl Before {
    /// What is known of a draft.
    pub(super) fn of(draft: &Draft) -> Self {
        Before {
            name: draft.name.clone(),
            id: draft.given_id.as_ref().map(|(id, _)| id.clone()),
            makes: draft.card.iter().flat_map(|c| &c.outputs).map(|o| o.kind).collect(),
        }
    }

    fn is(&self, id: &str) -> bool {
        self.id.as_deref().unwrap_or(&self.name) == id
    }
}

/// The card that is meant; the first of equals.
pub(super) fn pick<'c>(cards: &[&'c Card], before: &[Before], from: &[String]) -> Option<&'c Card> {
    let score = |card: &&&Card| {
        let feeds = |b: &Before| required(card).any(|k| b.makes.contains(&k));
        let named = before.iter().any(|b| feeds(b) && from.iter().any(|id| b.is(id)));
        let fed = required(card).all(|k| before.iter().any(|b| b.makes.contains(&k)));
        (named, fed, before.iter().rposition(feeds))
    };
    cards.iter().rev().max_by_key(score).copied()
}

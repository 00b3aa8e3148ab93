//! The stages that a program knows, each added by one explicit line.
//!
//! typetag finds a stage's parameters by name; the registry holds the cards, so that a crate whose
//! registrations the linker dropped is missed at once and not at run time.

use crate::{Card, Role, StageType};
use std::collections::BTreeMap;

/// The cards of all known stages, by name.
#[derive(Debug, Clone, Default)]
pub struct Registry {
    cards: BTreeMap<&'static str, Card>,
}

impl Registry {
    /// An empty registry.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a stage type. A second stage of the same name replaces the first.
    pub fn add<S: StageType>(&mut self) -> &mut Self {
        let card = S::type_card();
        self.cards.insert(card.name, card);
        self
    }

    /// The card of that name.
    pub fn card(&self, name: &str) -> Option<&Card> {
        self.cards.get(name)
    }

    /// All cards, ordered by name.
    pub fn cards(&self) -> impl Iterator<Item = &Card> {
        self.cards.values()
    }

    /// The cards of one role, ordered by name.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Card> {
        self.cards().filter(move |c| c.role == role)
    }
}

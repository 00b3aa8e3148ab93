//! The stages that a program knows, each added by one explicit line.
//!
//! typetag finds a stage's parameters by name; the registry holds the cards, so that a crate whose
//! registrations the linker dropped is missed at once and not at run time.

use crate::plugin::{Make, Plugin, Refused};
use crate::{Card, Change, Migration, Role, Stage, StageType};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The cards of all known stages, by name, and the sections of pipeline files.
///
/// Two stages may share a name where their roles differ, as the `Laplacian` that finds edges and
/// the `Laplacian` that smooths do; a pipeline's loader tells them apart by what they take.
#[derive(Debug, Clone, Default)]
pub struct Registry {
    cards: BTreeMap<(&'static str, Role), StageEntry>,
    sections: Vec<Section>,
    implicit: Vec<fn() -> Box<dyn Stage>>,
    plugins: Vec<Plugin>,
    refused: Vec<Refused>,
    migrations: Vec<Migration>,
    /// Whether plugins are loaded as copies.
    apart: bool,
}

/// A stage type.
#[derive(Debug, Clone)]
struct StageEntry {
    card: Card,
    maker: Maker,
    /// How many were added before it: the first of a role is its default.
    order: usize,
}

/// Who makes a stage from its arguments.
#[derive(Debug, Clone)]
enum Maker {
    /// A type that is linked in.
    Typed(fn(&str) -> Result<Box<dyn Stage>, String>),
    /// A plugin.
    Foreign(Arc<dyn Make>),
}

/// A top-level field of pipeline files that stands for a stage, such as `body: Mannequin()`.
///
/// Its stage runs as early as it can: at the start, or right after what it takes is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// The field's name.
    pub field: &'static str,
    /// What it holds.
    pub holds: SectionValue,
}

/// What stands in a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionValue {
    /// Any stage of that role: `style: Vest()`.
    Stage(Role),
    /// The value of one parameter of a given stage: `seams: [...]`.
    Table {
        /// The stage.
        stage: &'static str,
        /// Its parameter.
        param: &'static str,
    },
}

impl Section {
    /// A section that holds any stage of a role.
    pub const fn stage(field: &'static str, role: Role) -> Self {
        Section { field, holds: SectionValue::Stage(role) }
    }

    /// A section that holds the parameter `param` of the stage `stage`.
    pub const fn table(field: &'static str, stage: &'static str, param: &'static str) -> Self {
        Section { field, holds: SectionValue::Table { stage, param } }
    }
}

impl Registry {
    /// An empty registry.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a stage type. A second stage of the same name and role replaces the first.
    pub fn add<S: StageType + 'static>(&mut self) -> &mut Self {
        self.insert(S::type_card(), Maker::Typed(make::<S>));
        self
    }

    fn insert(&mut self, card: Card, maker: Maker) {
        let order = self.cards.len();
        self.cards.insert((card.name, card.role), StageEntry { card, maker, order });
    }

    /// Adds the stages of a plugin that was loaded from `path`, all or none. A plugin that is there
    /// already is not added again.
    ///
    /// Errors: why it is refused, by the loader or since a name is taken; a refused plugin stays
    /// listed with its reason.
    pub fn add_plugin(&mut self, path: &Path, loaded: Result<Plugin, Refused>) -> Result<(), Refused> {
        let added = loaded.and_then(|plugin| self.take_plugin(path, plugin));
        added.inspect_err(|refused| self.refused.push(refused.clone()))
    }

    /// From now on loads copies of plugins, so that their files may be replaced or written over
    /// while the program goes on. A copy does not see libraries that lie beside the file.
    pub fn load_plugins_apart(&mut self) -> &mut Self {
        self.apart = true;
        self
    }

    /// Whether plugins are to be loaded as copies.
    pub fn loads_apart(&self) -> bool {
        self.apart
    }

    fn take_plugin(&mut self, path: &Path, plugin: Plugin) -> Result<(), Refused> {
        if self.plugins.iter().any(|p| p.id == plugin.id) {
            return Ok(());
        }
        let refused =
            |reason: String, hint: Option<String>| Refused { file: path.display().to_string(), reason, hint };
        if let Some(taken) = plugin.cards.iter().find_map(|c| self.card(c.name)) {
            let by = taken
                .plugin
                .map_or("a stage of this program".to_owned(), |p| format!("plugin \"{}\"", p.name));
            let hint = "its author must choose another name".to_owned();
            return Err(refused(format!("the stage name `{}` is taken by {by}", taken.name), Some(hint)));
        }
        for (card, of) in plugin.cards.iter().zip(&plugin.makers) {
            self.insert(card.clone(), Maker::Foreign(of.clone()));
        }
        self.plugins.push(plugin);
        Ok(())
    }

    /// The plugins whose stages it holds.
    pub fn plugins(&self) -> &[Plugin] {
        &self.plugins
    }

    /// The plugins that were refused, with the reasons.
    pub fn refused(&self) -> &[Refused] {
        &self.refused
    }

    /// Says what was renamed or removed since pipeline files were written; changes stand in the
    /// order in which they were made, and stay for good.
    pub fn migrate(&mut self, migration: Migration) -> &mut Self {
        self.migrations.push(migration);
        self
    }

    /// All such changes.
    pub fn migrations(&self) -> &[Migration] {
        &self.migrations
    }

    /// The version of a stage's parameters: one more than the changes of them and of the stage's
    /// name.
    pub fn params_version(&self, stage: &str) -> u32 {
        let mut names = vec![stage];
        // Names lead to older names; each change is taken once.
        for m in self.migrations.iter().rev() {
            if matches!(m.change, Change::Stage { to } if names.contains(&to)) {
                names.push(m.stage);
            }
        }
        1 + self.migrations.iter().filter(|m| names.contains(&m.stage)).count() as u32
    }

    /// Adds a section. A second one of the same field replaces the first.
    pub fn section(&mut self, section: Section) -> &mut Self {
        self.sections.retain(|s| s.field != section.field);
        self.sections.push(section);
        self
    }

    /// The sections, in the order in which they were added.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Adds a stage type that every pipeline gets where it holds what the stage needs.
    pub fn add_implicit<S: StageType + 'static>(&mut self) -> &mut Self {
        self.implicit.push(|| Box::new(S::default()));
        self.add::<S>()
    }

    /// Makers of the implicit stages, in the order in which they were added.
    pub fn implicit(&self) -> &[fn() -> Box<dyn Stage>] {
        &self.implicit
    }

    /// The card of that name; of several, the one whose role comes first in a pipeline.
    pub fn card(&self, name: &str) -> Option<&Card> {
        self.cards().find(|c| c.name == name)
    }

    /// All cards in the order in which they were added: of each role the default comes first.
    pub fn in_order(&self) -> Vec<&Card> {
        let mut entries: Vec<&StageEntry> = self.cards.values().collect();
        entries.sort_by_key(|e| e.order);
        entries.into_iter().map(|e| &e.card).collect()
    }

    /// Whether pipelines get that stage by themselves.
    pub fn is_implicit(&self, card: &Card) -> bool {
        self.implicit.iter().any(|make| make().card().name == card.name)
    }

    /// All cards of that name, in the order of their roles.
    pub fn named(&self, name: &str) -> impl Iterator<Item = &Card> {
        self.cards().filter(move |c| c.name == name)
    }

    /// All cards, ordered by name.
    pub fn cards(&self) -> impl Iterator<Item = &Card> {
        self.cards.values().map(|e| &e.card)
    }

    /// Makes a stage from its arguments as RON, `(bias: 3.0)`.
    ///
    /// Errors: a sentence on the argument at fault.
    pub fn make(&self, card: &Card, arguments: &str) -> Result<Box<dyn Stage>, String> {
        match self.cards.get(&(card.name, card.role)).map(|e| &e.maker) {
            Some(Maker::Foreign(of)) => of.make(card, arguments),
            // typetag knows a stage by its name alone.
            #[cfg(feature = "typetag")]
            Some(Maker::Typed(_)) if self.named(card.name).count() == 1 => {
                crate::typed::stage(&format!("{}{arguments}", card.name))
            }
            Some(Maker::Typed(make)) => make(arguments),
            None => Err(format!("there is no stage `{}`", card.name)),
        }
    }

    /// The cards of one role, ordered by name.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Card> {
        self.cards().filter(move |c| c.role == role)
    }
}

fn make<S: StageType + 'static>(arguments: &str) -> Result<Box<dyn Stage>, String> {
    match crate::param::ron_options().from_str::<S>(arguments) {
        Ok(stage) => Ok(Box::new(stage)),
        Err(e) => Err(e.code.to_string()),
    }
}

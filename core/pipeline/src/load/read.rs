//! Fields, sections and stages of a pipeline's syntax tree.

use super::fault::Fault;
use super::pick::{Before, pick};
use super::words::is_table;
use super::{MAX_FAULTS, MAX_STAGES, PluginUse, Quality, old_name, plugins, qualities};
use crate::load::syntax::draft::{Draft, name_all};
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use toile_core::param::ron_options;
use toile_core::{Card, ParamDoc, ParamFault, Registry, Role, Section, SectionValue};

/// Fields that every stage may carry beside its own.
pub(super) const GENERIC: [&str; 2] = ["id", "from"];

/// Top-level fields that are no sections.
pub(super) const PLAIN: [&str; 4] = ["name", "stages", "plugins", "qualities"];

/// The most elements of one list or map whose faults are reported.
const MAX_ELEMENTS: usize = 20;

/// The longest id: it becomes a folder's name.
const MAX_ID: usize = 64;

/// What the file holds.
#[derive(Debug, Default)]
pub(super) struct FileContents {
    pub(super) name: Option<String>,
    pub(super) plugins: Vec<PluginUse>,
    pub(super) qualities: Vec<Quality>,
    /// In the order of the registry.
    pub(super) sections: Vec<Draft>,
    /// In the order of the file.
    pub(super) stages: Vec<Draft>,
}

/// Reads a whole file; the registry may lack a plugin that is refused.
pub(super) fn file(
    text: &str,
    tree: &ValueTree,
    (registry, lacks_plugin): (&Registry, bool),
    faults: &mut Vec<Fault>,
) -> FileContents {
    let mut r = PipelineReader { text, registry, lacks_plugin, faults, before: Vec::new() };
    let ValueShape::Group { name: None, bracket: Bracket::Round, entries, .. } = &tree.shape else {
        r.fault("not_a_pipeline", "a pipeline file is written `(name: ..., stages: [...])`", &tree.head());
        return FileContents { stages: vec![Draft::unknown(&tree.span)], ..FileContents::default() };
    };
    let mut fields = r.fields(entries);
    r.known_fields(&mut fields);
    let mut read = FileContents {
        name: fields.get("name").and_then(|(_, v)| r.text_value("name", v)),
        plugins: fields.get("plugins").map(|(_, v)| plugins::read(text, v, r.faults)).unwrap_or_default(),
        qualities: fields
            .get("qualities")
            .map(|(_, v)| qualities::read(text, v, r.faults))
            .unwrap_or_default(),
        ..FileContents::default()
    };
    let registered = registry.sections().iter().filter_map(|s| Some((s, fields.get(s.field)?)));
    read.sections = registered.map(|(s, (key, value))| r.section(s, key, value)).collect();
    r.before = read.sections.iter().map(Before::of).collect();
    read.stages = match fields.get("stages") {
        Some((_, list)) => r.stages(list),
        None => {
            let fault = Fault::new("missing_field", "the field `stages` is missing").at(&tree.head(), "");
            r.push(fault.hint("write `stages: [ ... ]` with the stages in their order".to_owned()));
            vec![Draft::unknown(&tree.span)]
        }
    };
    name_all(read.sections.iter_mut().chain(&mut read.stages), r.faults);
    read
}

type Fields<'t> = BTreeMap<String, (Range<usize>, &'t ValueTree)>;

struct PipelineReader<'a> {
    text: &'a str,
    registry: &'a Registry,
    /// True where stages may be missing because their plugin is refused.
    lacks_plugin: bool,
    faults: &'a mut Vec<Fault>,
    /// The stages read so far, by which those of one name are told apart.
    before: Vec<Before>,
}

impl PipelineReader<'_> {
    fn fault(&mut self, code: &'static str, message: impl Into<String>, span: &Range<usize>) {
        self.push(Fault::new(code, message).at(span, ""));
    }

    fn push(&mut self, fault: Fault) {
        if self.faults.len() < MAX_FAULTS {
            self.faults.push(fault);
        }
    }

    fn at(&self, span: &Range<usize>) -> &str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// Named entries; the first of each name counts, a second one is a fault.
    fn fields<'t>(&mut self, entries: impl IntoIterator<Item = &'t GroupEntry>) -> Fields<'t> {
        let mut fields = Fields::new();
        for entry in entries {
            let Some(key) = &entry.key else {
                if !entry.value.is_broken {
                    self.fault("unnamed_value", "a value without a field name", &entry.value.span);
                }
                continue;
            };
            let name = self.at(key).to_owned();
            if let Some((first, _)) = fields.get(&name) {
                let fault = Fault::new("duplicate_field", format!("the field `{name}` is given twice"));
                self.push(fault.at(key, "again here").at(first, "first here"));
                continue;
            }
            fields.insert(name, (key.clone(), &entry.value));
        }
        fields
    }

    /// Reports unknown fields; one that is a misspelt other is then read as that other, so that the
    /// faults within it are found in the same run.
    fn known_fields(&mut self, fields: &mut Fields<'_>) {
        let known = top_level(self.registry);
        let unknown = fields.keys().filter(|name| !known.contains(&name.as_str()));
        let unknown: Vec<String> = unknown.take(MAX_FAULTS).cloned().collect();
        for name in unknown {
            let Some((key, value)) = fields.remove(&name) else { continue };
            let hint = toile_core::hint(&name, "a pipeline has the fields", &known);
            self.push(Fault::new("unknown_field", format!("unknown field `{name}`")).at(&key, "").hint(hint));
            if let Some(meant) = toile_core::nearest(&name, known.iter().copied()) {
                fields.entry(meant.to_owned()).or_insert((key, value));
            }
        }
    }

    fn text_value(&mut self, field: &str, value: &ValueTree) -> Option<String> {
        if value.is_broken {
            return None;
        }
        let parsed = ron_options().from_str(self.at(&value.span)).ok();
        if parsed.is_none() {
            self.fault("bad_value", format!("`{field}` must be text in quotes"), &value.span);
        }
        parsed
    }

    fn stages(&mut self, list: &ValueTree) -> Vec<Draft> {
        let ValueShape::Group { bracket: Bracket::Square, entries, .. } = &list.shape else {
            if list.is_broken {
                return vec![Draft::unknown(&list.span)];
            }
            self.fault("bad_value", "`stages` must be a list, `[Otsu(), ...]`", &list.head());
            return vec![Draft::unknown(&list.span)];
        };
        if entries.is_empty() {
            self.fault("bad_value", "`stages` holds no stage", &list.span);
        }
        if let Some(extra) = entries.get(MAX_STAGES) {
            let message = format!("{} stages, the limit is {MAX_STAGES}", entries.len());
            self.fault("too_large", message, &extra.value.head());
        }
        let mut stages = Vec::new();
        for entry in entries.iter().take(MAX_STAGES) {
            let draft = self.stage(&entry.value, None);
            self.before.push(Before::of(&draft));
            stages.push(draft);
        }
        stages
    }

    fn section(&mut self, section: &Section, key: &Range<usize>, value: &ValueTree) -> Draft {
        match section.holds {
            SectionValue::Stage(role) => self.stage(value, Some((section.field, role))),
            SectionValue::Table { stage, param } => self.table(key, value, stage, param),
        }
    }

    /// A table section: its whole value is one parameter of its stage.
    fn table(&mut self, key: &Range<usize>, value: &ValueTree, stage: &str, param: &'static str) -> Draft {
        let card = self.registry.card(stage).cloned();
        let doc = card.as_ref().and_then(|c| c.params.iter().find(|p| p.name == param)).cloned();
        let mut draft = Draft { is_table: true, ..Draft::new(stage, &value.span, key, card) };
        let Some(doc) = doc else {
            let message = format!("the stage `{stage}`, which reads this field, is not in this program");
            self.fault("unknown_stage", message, key);
            return draft;
        };
        draft.params.insert(param.to_owned(), value.span.clone());
        if self.check(&doc, value) {
            self.make(&mut draft);
        }
        draft
    }

    /// A stage as it is written, `Name(field: value)`; in a section it must have that section's
    /// role.
    fn stage(&mut self, value: &ValueTree, section: Option<(&str, Role)>) -> Draft {
        let (name_span, entries) = match &value.shape {
            ValueShape::Group { name: Some(name), entries, .. } => (name, Some(entries)),
            ValueShape::Name => (&value.span, None),
            ValueShape::Broken => return Draft::unknown(&value.span),
            _ => {
                self.fault("not_a_stage", "expected a stage, written `Name(field: value)`", &value.head());
                let card = section.and_then(|(_, role)| self.fit(role).next().cloned());
                return Draft { card, ..Draft::unknown(&value.span) };
            }
        };
        let name = self.at(name_span).to_owned();
        let before = self.faults.len();
        let from = self.named_sources(value.entries());
        let card = self.card(&name, name_span, section, &from);
        let mut draft = Draft::new(&name, &value.span, name_span, card);
        let is_known =
            self.registry.card(&name).is_some() || old_name::old_stage(self.registry, &name).is_some();
        draft.meant = draft.card.as_ref().map(|c| c.name).filter(|_| !is_known);
        match entries {
            Some(entries) => self.arguments(&mut draft, entries),
            None => {
                let fault = Fault::new("not_a_stage", format!("`{name}` needs brackets")).at(name_span, "");
                self.push(fault.hint(format!("write `{name}()`")));
            }
        }
        let of_values = self.faults.iter().skip(before).all(|f| f.code == "bad_value");
        if of_values && !value.is_broken {
            self.make(&mut draft);
        }
        draft
    }

    /// The stages that may stand in a section of that role.
    fn fit(&self, role: Role) -> impl Iterator<Item = &Card> {
        self.registry.of_role(role).filter(|c| !is_table(c, self.registry))
    }

    /// The stage's card, or that of the stage that was probably meant.
    fn card(
        &mut self,
        name: &str,
        span: &Range<usize>,
        section: Option<(&str, Role)>,
        from: &[String],
    ) -> Option<Card> {
        let names: Vec<&str> = match section {
            Some((_, role)) => self.fit(role).map(|c| c.name).collect(),
            None => self.registry.cards().map(|c| c.name).collect(),
        };
        let in_place = |c: &&Card| section.is_none_or(|(_, role)| c.role == role);
        let fitting: Vec<&Card> = self.registry.named(name).filter(in_place).collect();
        let picked = pick(&fitting, &self.before, from).or_else(|| self.registry.card(name));
        let (fault, meant) = match (picked, section) {
            (Some(card), Some((field, role))) if !names.contains(&name) => {
                let message =
                    format!("`{field}` must be a {}, `{name}` is a {}", noun(role), noun(card.role));
                let known = (!names.is_empty()).then(|| format!("there is {}", toile_core::quoted(&names)));
                (Fault::new("wrong_role", message).hint(known), names.first().copied())
            }
            (Some(card), _) => return Some(card.clone()),
            (None, _) if let Some((fault, to)) = old_name::old_stage(self.registry, name) => {
                (fault, Some(to))
            }
            (None, _) => {
                let listing = if section.is_some() { "there is" } else { "" };
                let near = toile_core::nearest(name, names.iter().copied());
                let hint = match self.lacks_plugin {
                    true => "it may be of the plugin that is refused".to_owned(),
                    false => unknown(name, near, toile_core::hint(name, listing, &names)),
                };
                let meant = near.or(section.and(names.first().copied()));
                (Fault::new("unknown_stage", format!("unknown stage `{name}`")).hint(hint), meant)
            }
        };
        let card = meant.and_then(|n| self.registry.card(n)).cloned();
        self.push(fault.at(span, ""));
        card
    }

    /// The ids in a stage's `from`, as far as they can be read; their faults come out later.
    fn named_sources(&self, entries: &[GroupEntry]) -> Vec<String> {
        let is_from = |e: &&GroupEntry| e.key.as_ref().is_some_and(|k| self.at(k) == "from");
        let Some(from) = entries.iter().find(is_from) else { return Vec::new() };
        let items = from.value.entries().iter().map(|e| &e.value).chain([&from.value]);
        items.filter_map(|t| ron_options().from_str(self.at(&t.span)).ok()).collect()
    }

    fn arguments(&mut self, draft: &mut Draft, entries: &[GroupEntry]) {
        let known = draft.card.as_ref().filter(|c| c.name == draft.name).cloned();
        if let [GroupEntry { key: None, value }] = entries {
            match known.as_ref().map(|card| card.params.first()) {
                Some(Some(doc)) => self.param(draft, doc, value),
                Some(None) => self.no_params(draft, &value.span),
                None => {}
            }
            return;
        }
        if let Some(unnamed) = entries.iter().find(|e| e.key.is_none()) {
            self.unnamed(known.as_ref(), &draft.name, unnamed);
        }
        for (name, (key, value)) in self.fields(entries.iter().filter(|e| e.key.is_some())) {
            match (name.as_str(), &known) {
                ("id", _) => draft.given_id = self.id(value),
                ("from", _) => draft.from = self.from(value),
                (_, None) => {}
                (_, Some(card)) => match card.params.iter().find(|p| p.name == name) {
                    Some(doc) => self.param(draft, doc, value),
                    None => self.unknown_param(card, &name, &key),
                },
            }
        }
    }

    fn param(&mut self, draft: &mut Draft, doc: &ParamDoc, value: &ValueTree) {
        draft.params.insert(doc.name.to_owned(), value.span.clone());
        if !self.check(doc, value) {
            draft.wrong.push(doc.name);
        }
    }

    fn no_params(&mut self, draft: &Draft, span: &Range<usize>) {
        let fault = Fault::new("unknown_param", format!("`{}` has no parameters", draft.name)).at(span, "");
        self.push(fault.hint(format!("write `{}()`", draft.name)));
    }

    fn unnamed(&mut self, card: Option<&Card>, name: &str, entry: &GroupEntry) {
        let message = format!("`{name}` takes one value without a name at most, and then no others");
        let first = card.and_then(|c| c.params.first()).map_or("field", |p| p.name);
        let fault = Fault::new("unnamed_value", message).at(&entry.value.span, "");
        self.push(fault.hint(format!("write `{name}({first}: ..., ...)`")));
    }

    fn unknown_param(&mut self, card: &Card, name: &str, key: &Range<usize>) {
        if self.faults.len() >= MAX_FAULTS {
            return;
        }
        if let Some(old) = old_name::old_param(self.registry, card.name, name) {
            self.push(old.at(key, ""));
            return;
        }
        let names: Vec<&str> = card.params.iter().map(|p| p.name).chain(GENERIC).collect();
        let own: Vec<&str> = card.params.iter().map(|p| p.name).collect();
        let near = toile_core::nearest(name, names.iter().copied()).map(|n| format!("did you mean `{n}`?"));
        let list = match own.is_empty() {
            true => format!("`{}` has no parameters", card.name),
            false => format!("`{}` has {}", card.name, toile_core::quoted(&own)),
        };
        let hint = near.map_or_else(|| list.clone(), |near| format!("{near} {list}"));
        let message = format!("unknown parameter `{name}`");
        self.push(Fault::new("unknown_param", message).at(key, "").hint(hint));
    }

    /// Checks a value by its parameter's own type; puts the fault at the innermost value that has
    /// it. Of a list or a map, an element with a fault is left out and the others are checked as
    /// well.
    fn check(&mut self, doc: &ParamDoc, value: &ValueTree) -> bool {
        if value.is_broken {
            return false;
        }
        let mut text = self.at(&value.span).to_owned();
        for found in 0..MAX_ELEMENTS {
            let Err(e) = doc.check.run(&text, doc) else { return found == 0 };
            let element = e.offset.and_then(|o| self.element(value, value.span.start + o));
            if found > 0 && element.is_none() {
                return false;
            }
            self.wrong(doc, value, e);
            let Some(element) = element else { return false };
            let blank = element.start - value.span.start..element.end - value.span.start;
            text.replace_range(blank.clone(), &" ".repeat(blank.len()));
        }
        false
    }

    /// The element of a list or map that has something at a byte, with the comma behind it.
    fn element(&self, value: &ValueTree, at: usize) -> Option<Range<usize>> {
        let ValueShape::Group { name: None, bracket: Bracket::Square | Bracket::Curly, entries, .. } =
            &value.shape
        else {
            return None;
        };
        let from = |e: &GroupEntry| e.key.as_ref().map_or(e.value.span.start, |k| k.start);
        let entry = entries.iter().find(|e| (from(e)..e.value.span.end).contains(&at))?;
        let rest = self.text.get(entry.value.span.end..)?;
        let comma = rest.find(|c: char| !c.is_whitespace()).filter(|i| rest[*i..].starts_with(','));
        Some(from(entry)..entry.value.span.end + comma.map_or(0, |i| i + 1))
    }

    /// The fault of a value.
    fn wrong(&mut self, doc: &ParamDoc, value: &ValueTree, e: ParamFault) {
        let (span, key) = e.offset.map_or((value.span.clone(), None), |o| value.locate(value.span.start + o));
        let message = match key {
            Some(key) => format!("`{}` in `{}`: {}", self.at(&key).trim_matches('"'), doc.name, e.reason),
            None => e.message,
        };
        self.push(Fault::new("bad_value", message).at(&span, "").hint(e.hint));
    }

    fn id(&mut self, value: &ValueTree) -> Option<(String, Range<usize>)> {
        let id = self.text_value("id", value)?;
        let fit = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if id.is_empty() || id.len() > MAX_ID || !id.chars().all(fit) {
            let message = format!("an id has 1 to {MAX_ID} letters, digits, `_` or `-`: it names a folder");
            self.fault("bad_value", message, &value.span);
            return None;
        }
        Some((id, value.span.clone()))
    }

    fn from(&mut self, value: &ValueTree) -> Vec<(String, Range<usize>)> {
        let items: Vec<&ValueTree> = match &value.shape {
            ValueShape::Group { bracket: Bracket::Square, entries, .. } => {
                entries.iter().map(|e| &e.value).collect()
            }
            _ => vec![value],
        };
        let mut seen = BTreeSet::new();
        let texts = items.into_iter().filter_map(|t| Some((self.text_value("from", t)?, t.span.clone())));
        texts.filter(|(id, _)| seen.insert(id.clone())).collect()
    }

    /// Makes the typed stage of a draft, without the values that are wrong.
    fn make(&mut self, draft: &mut Draft) {
        let Some(card) = &draft.card else { return };
        let clean = draft.params.iter().filter(|(k, _)| !draft.wrong.contains(&k.as_str()));
        let args: Vec<String> = clean.map(|(k, v)| format!("{k}: {}", self.at(v))).collect();
        match self.registry.make(card, &format!("({})", args.join(", "))) {
            Ok(stage) => draft.stage = Some(stage),
            // The missing value is one whose fault is already reported.
            Err(_) if !draft.wrong.is_empty() => {}
            Err(reason) => {
                self.fault("bad_value", format!("`{}` cannot be made: {reason}", draft.name), &draft.place);
            }
        }
    }
}

/// Reports every key that stands twice in a map; of two values the reader would take the last and
/// say nothing.
pub(super) fn doubled_keys(text: &str, tree: &ValueTree, faults: &mut Vec<Fault>) {
    if let ValueShape::Group { bracket: Bracket::Curly, entries, .. } = &tree.shape {
        let mut seen: BTreeMap<String, &Range<usize>> = BTreeMap::new();
        for key in entries.iter().filter_map(|e| e.key.as_ref()) {
            let written = text.get(key.clone()).unwrap_or("");
            let name = ron_options().from_str::<String>(written).unwrap_or_else(|_| written.to_owned());
            match seen.get(&name) {
                Some(first) if faults.len() < MAX_FAULTS => {
                    let fault = Fault::new("duplicate_field", format!("the key \"{name}\" is given twice"));
                    faults.push(fault.at(key, "again here").at(first, "first here"));
                }
                Some(_) => return,
                None => {
                    seen.insert(name, key);
                }
            }
        }
    }
    tree.entries().iter().for_each(|e| doubled_keys(text, &e.value, faults));
}

/// What may be done about a stage that there is not. A name that is no misspelling, or that has a
/// known one in it as `MyOtsu` has `Otsu`, may be of a plugin that the file does not name.
fn unknown(name: &str, near: Option<&str>, known: Option<String>) -> String {
    let known = known.unwrap_or_else(|| "`toile stages` lists those that there are".into());
    match near {
        Some(near) if !name.to_lowercase().contains(&near.to_lowercase()) => known,
        _ => {
            let library = crate::plugin::library_of(name);
            let so = if known.ends_with('?') { "" } else { ";" };
            format!(
                "{known}{so} a stage of a plugin needs its library in the file, `plugins: [\"{library}\"]`"
            )
        }
    }
}

/// A stage of that role in words: `mesher`, `body stage`.
fn noun(role: Role) -> String {
    match role {
        Role::Panorama | Role::Style | Role::Body | Role::Fabric | Role::Placement => {
            format!("{} stage", role.as_str())
        }
        _ => role.as_str().to_owned(),
    }
}

/// The fields that a pipeline file may have.
pub(super) fn top_level(registry: &Registry) -> Vec<&'static str> {
    let sections = registry.sections().iter().map(|s| s.field);
    PLAIN.into_iter().take(1).chain(sections).chain(PLAIN.into_iter().skip(1)).collect()
}

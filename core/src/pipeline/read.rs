//! Fields, sections and stages of a pipeline's syntax tree.

use super::fault::Fault;
use super::tree::{Bracket, Entry, Shape, Tree};
use super::{Feed, MAX_STAGES, Node, near, typed};
use crate::param::ron_options;
use crate::{Card, ParamDoc, Registry, Role, Section, SectionValue, Stage};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Fields that every stage may carry beside its own.
pub(super) const GENERIC: [&str; 2] = ["id", "from"];

/// Top-level fields that are no sections.
pub(super) const PLAIN: [&str; 3] = ["name", "stages", "plugins"];

/// The longest id: it becomes a folder's name.
const MAX_ID: usize = 64;

/// A stage as far as it could be read.
#[derive(Debug)]
pub(super) struct Draft {
    /// Its id; set by [`name_all`].
    pub(super) id: String,
    /// The name that the file gives it.
    pub(super) name: String,
    /// The `id` that the file gives it.
    pub(super) given_id: Option<(String, Range<usize>)>,
    /// The ids that its `from` names.
    pub(super) from: Vec<(String, Range<usize>)>,
    /// Its card; of an unknown stage, the card of the one that was probably meant, so that the
    /// graph can be checked all the same.
    pub(super) card: Option<Card>,
    pub(super) span: Range<usize>,
    pub(super) place: Range<usize>,
    pub(super) params: BTreeMap<String, Range<usize>>,
    /// None where it has a fault.
    pub(super) stage: Option<Box<dyn Stage>>,
}

impl Draft {
    /// The finished node; none where the stage has a fault.
    pub(super) fn finish(self, inputs: Vec<Feed>) -> Option<Node> {
        let Draft { id, card, span, place, params, stage, .. } = self;
        Some(Node { id, stage: stage?, card: card?, span, place, params, inputs })
    }
}

/// What the file holds.
#[derive(Debug, Default)]
pub(super) struct Read {
    pub(super) name: Option<String>,
    pub(super) plugins: Vec<String>,
    /// In the order of the registry.
    pub(super) sections: Vec<Draft>,
    /// In the order of the file.
    pub(super) stages: Vec<Draft>,
}

/// Reads a whole file.
pub(super) fn file(text: &str, tree: &Tree, registry: &Registry, faults: &mut Vec<Fault>) -> Read {
    let mut r = Reader { text, registry, faults };
    let Shape::Group { name: None, bracket: Bracket::Round, entries, .. } = &tree.shape else {
        r.fault("not_a_pipeline", "a pipeline file is written `(name: ..., stages: [...])`", &tree.span);
        return Read::default();
    };
    let fields = r.fields(entries);
    r.known_fields(&fields);
    let mut read = Read {
        name: fields.get("name").and_then(|(_, v)| r.text_value("name", v)),
        plugins: fields.get("plugins").map(|(_, v)| r.texts("plugins", v)).unwrap_or_default(),
        ..Read::default()
    };
    read.plugins.dedup();
    let registered = registry.sections().iter().filter_map(|s| Some((s, fields.get(s.field)?)));
    read.sections = registered.filter_map(|(s, (key, value))| r.section(s, key, value)).collect();
    match fields.get("stages") {
        Some((_, list)) => read.stages = r.stages(list),
        None => {
            let here = tree.span.start..tree.span.start + 1;
            let fault = Fault::new("missing_field", "the field `stages` is missing").at(&here, "");
            r.faults.push(fault.hint(Some("write `stages: [ ... ]` with the stages in their order".into())));
        }
    }
    name_all(read.sections.iter_mut().chain(&mut read.stages), r.faults);
    read
}

/// Gives every stage its id: the one it asks for, else its name with a number where that is taken.
fn name_all<'a>(drafts: impl Iterator<Item = &'a mut Draft>, faults: &mut Vec<Fault>) {
    let mut drafts: Vec<&mut Draft> = drafts.collect();
    let mut taken: BTreeMap<String, Range<usize>> = BTreeMap::new();
    for draft in &mut drafts {
        let Some((id, span)) = &draft.given_id else { continue };
        draft.id = id.clone();
        if let Some(first) = taken.get(id) {
            let message = format!("two stages have the id `{id}`");
            faults.push(Fault::new("duplicate_id", message).at(span, "second").at(first, "first"));
        }
        taken.entry(id.clone()).or_insert_with(|| span.clone());
    }
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for draft in drafts.into_iter().filter(|d| d.given_id.is_none()) {
        let count = counts.entry(draft.name.clone()).or_insert(0);
        loop {
            *count += 1;
            draft.id = if *count == 1 { draft.name.clone() } else { format!("{}{count}", draft.name) };
            if !taken.contains_key(&draft.id) {
                break;
            }
        }
        taken.insert(draft.id.clone(), draft.place.clone());
    }
}

type Fields<'t> = BTreeMap<String, (Range<usize>, &'t Tree)>;

struct Reader<'a> {
    text: &'a str,
    registry: &'a Registry,
    faults: &'a mut Vec<Fault>,
}

impl Reader<'_> {
    fn fault(&mut self, code: &'static str, message: impl Into<String>, span: &Range<usize>) {
        self.faults.push(Fault::new(code, message).at(span, ""));
    }

    fn at(&self, span: &Range<usize>) -> &str {
        self.text.get(span.clone()).unwrap_or("")
    }

    /// Named entries; the first of each name counts, a second one is a fault.
    fn fields<'t>(&mut self, entries: &'t [Entry]) -> Fields<'t> {
        let mut fields = Fields::new();
        for entry in entries {
            let Some(key) = &entry.key else {
                self.fault("unnamed_value", "a value without a field name", &entry.value.span);
                continue;
            };
            let name = self.at(key).to_owned();
            if let Some((first, _)) = fields.get(&name) {
                let fault = Fault::new("duplicate_field", format!("the field `{name}` is given twice"));
                self.faults.push(fault.at(key, "again here").at(first, "first here"));
                continue;
            }
            fields.insert(name, (key.clone(), &entry.value));
        }
        fields
    }

    fn known_fields(&mut self, fields: &Fields<'_>) {
        let known = top_level(self.registry);
        for (name, (key, _)) in fields.iter().filter(|(name, _)| !known.contains(&name.as_str())) {
            let hint = near::hint(name, "a pipeline has the fields", &known);
            self.faults
                .push(Fault::new("unknown_field", format!("unknown field `{name}`")).at(key, "").hint(hint));
        }
    }

    fn text_value(&mut self, field: &str, value: &Tree) -> Option<String> {
        let parsed = ron_options().from_str(self.at(&value.span)).ok();
        if parsed.is_none() {
            self.fault("bad_value", format!("`{field}` wants text in quotes"), &value.span);
        }
        parsed
    }

    /// A list of texts.
    fn texts(&mut self, field: &str, value: &Tree) -> Vec<String> {
        match &value.shape {
            Shape::Group { bracket: Bracket::Square, entries, .. } => {
                entries.iter().filter_map(|e| self.text_value(field, &e.value)).collect()
            }
            _ => {
                self.fault("bad_value", format!("`{field}` wants a list of texts"), &value.span);
                Vec::new()
            }
        }
    }

    fn stages(&mut self, list: &Tree) -> Vec<Draft> {
        let Shape::Group { bracket: Bracket::Square, entries, .. } = &list.shape else {
            self.fault("bad_value", "`stages` wants a list, `[Otsu(), ...]`", &list.span);
            return Vec::new();
        };
        if entries.is_empty() {
            self.fault("bad_value", "`stages` holds no stage", &list.span);
        }
        if let Some(extra) = entries.get(MAX_STAGES) {
            let message = format!("{} stages, the limit is {MAX_STAGES}", entries.len());
            self.fault("too_large", message, &extra.value.span);
        }
        entries.iter().take(MAX_STAGES).filter_map(|e| self.stage(&e.value, None)).collect()
    }

    fn section(&mut self, section: &Section, key: &Range<usize>, value: &Tree) -> Option<Draft> {
        match section.holds {
            SectionValue::Stage(role) => self.stage(value, Some((section.field, role))),
            SectionValue::Table { stage, param } => self.table(key, value, stage, param),
        }
    }

    /// A table section: its whole value is one parameter of its stage.
    fn table(&mut self, key: &Range<usize>, value: &Tree, stage: &str, param: &'static str) -> Option<Draft> {
        let Some(card) = self.registry.card(stage).cloned() else {
            let message = format!("the stage `{stage}`, which reads this field, is not in this program");
            self.fault("unknown_stage", message, key);
            return None;
        };
        let mut draft = Draft::new(stage, &value.span, key, Some(card.clone()));
        let clean = card.params.iter().find(|p| p.name == param).is_some_and(|doc| self.check(doc, value));
        draft.params.insert(param.to_owned(), value.span.clone());
        if clean {
            self.make(&mut draft);
        }
        Some(draft)
    }

    /// A stage as it is written, `Name(field: value)`; in a section it must have that section's role.
    fn stage(&mut self, value: &Tree, section: Option<(&str, Role)>) -> Option<Draft> {
        let (name_span, entries) = match &value.shape {
            Shape::Group { name: Some(name), entries, .. } => (name, Some(entries)),
            Shape::Name => (&value.span, None),
            _ => {
                let message = "expected a stage, written `Name(field: value)`";
                self.fault("not_a_stage", message, &value.span);
                return None;
            }
        };
        let name = self.at(name_span).to_owned();
        let before = self.faults.len();
        let card = self.card(&name, name_span, section);
        let mut draft = Draft::new(&name, &value.span, name_span, card);
        match entries {
            Some(entries) => self.arguments(&mut draft, entries),
            None => {
                let fault = Fault::new("not_a_stage", format!("`{name}` needs brackets")).at(name_span, "");
                self.faults.push(fault.hint(format!("write `{name}()`")));
            }
        }
        if self.faults.len() == before {
            self.make(&mut draft);
        }
        Some(draft)
    }

    /// The stage's card, or that of the stage that was probably meant.
    fn card(&mut self, name: &str, span: &Range<usize>, section: Option<(&str, Role)>) -> Option<Card> {
        let of_role = |c: &&Card| section.is_none_or(|(_, role)| c.role == role);
        let names: Vec<&str> = self.registry.cards().filter(of_role).map(|c| c.name).collect();
        match (self.registry.card(name), section) {
            (Some(card), Some((field, role))) if card.role != role => {
                let message = format!(
                    "`{field}` wants a {} stage, `{name}` is a {}",
                    role.as_str(),
                    card.role.as_str()
                );
                let known = (!names.is_empty()).then(|| format!("there is {}", near::quoted(&names)));
                self.faults.push(Fault::new("wrong_role", message).at(span, "").hint(known));
                self.registry.of_role(role).next().cloned()
            }
            (Some(card), _) => Some(card.clone()),
            (None, _) => {
                let listing = if section.is_some() { "there is" } else { "" };
                let hint = near::hint(name, listing, &names)
                    .unwrap_or_else(|| "`toile stages` lists those that there are".into());
                self.faults.push(
                    Fault::new("unknown_stage", format!("unknown stage `{name}`")).at(span, "").hint(hint),
                );
                let meant =
                    near::nearest(name, names.iter().copied()).or(section.and(names.first().copied()));
                meant.and_then(|n| self.registry.card(n)).cloned()
            }
        }
    }

    fn arguments(&mut self, draft: &mut Draft, entries: &[Entry]) {
        let known = draft.card.as_ref().filter(|c| c.name == draft.name).cloned();
        if let [Entry { key: None, value }] = entries {
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
        let named: Vec<Entry> = entries.iter().filter(|e| e.key.is_some()).cloned().collect();
        for (name, (key, value)) in self.fields(&named) {
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

    fn param(&mut self, draft: &mut Draft, doc: &ParamDoc, value: &Tree) {
        draft.params.insert(doc.name.to_owned(), value.span.clone());
        self.check(doc, value);
    }

    fn no_params(&mut self, draft: &Draft, span: &Range<usize>) {
        let fault = Fault::new("unknown_param", format!("`{}` has no parameters", draft.name)).at(span, "");
        self.faults.push(fault.hint(format!("write `{}()`", draft.name)));
    }

    fn unnamed(&mut self, card: Option<&Card>, name: &str, entry: &Entry) {
        let message = format!("`{name}` takes one value without a name at most, and then no others");
        let first = card.and_then(|c| c.params.first()).map_or("field", |p| p.name);
        let fault = Fault::new("unnamed_value", message).at(&entry.value.span, "");
        self.faults.push(fault.hint(format!("write `{name}({first}: ..., ...)`")));
    }

    fn unknown_param(&mut self, card: &Card, name: &str, key: &Range<usize>) {
        let names: Vec<&str> = card.params.iter().map(|p| p.name).chain(GENERIC).collect();
        let own: Vec<&str> = card.params.iter().map(|p| p.name).collect();
        let near = near::nearest(name, names.iter().copied()).map(|n| format!("did you mean `{n}`?"));
        let list = match own.is_empty() {
            true => format!("`{}` has no parameters", card.name),
            false => format!("`{}` has {}", card.name, near::quoted(&own)),
        };
        let hint = near.map_or_else(|| list.clone(), |near| format!("{near} {list}"));
        let message = format!("unknown parameter `{name}`");
        self.faults.push(Fault::new("unknown_param", message).at(key, "").hint(hint));
    }

    /// Checks a value by its parameter's own type; puts the fault at the innermost value that has it.
    fn check(&mut self, doc: &ParamDoc, value: &Tree) -> bool {
        let Err(e) = (doc.check)(self.at(&value.span), doc) else { return true };
        let at = value.span.start + e.offset.unwrap_or(0);
        let (inner, key) = if e.offset.is_some() { value.innermost(at) } else { (value, None) };
        let message = match key {
            Some(key) => format!("`{}` in `{}`: {}", self.at(key).trim_matches('"'), doc.name, e.reason),
            None => e.message,
        };
        self.faults.push(Fault::new("bad_value", message).at(&inner.span, "").hint(e.hint));
        false
    }

    fn id(&mut self, value: &Tree) -> Option<(String, Range<usize>)> {
        let id = self.text_value("id", value)?;
        let fit = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if id.is_empty() || id.len() > MAX_ID || !id.chars().all(fit) {
            let message = format!("an id has 1 to {MAX_ID} letters, digits, `_` or `-`: it names a folder");
            self.fault("bad_value", message, &value.span);
            return None;
        }
        Some((id, value.span.clone()))
    }

    fn from(&mut self, value: &Tree) -> Vec<(String, Range<usize>)> {
        let items: Vec<&Tree> = match &value.shape {
            Shape::Group { bracket: Bracket::Square, entries, .. } => {
                entries.iter().map(|e| &e.value).collect()
            }
            _ => vec![value],
        };
        let mut seen = BTreeSet::new();
        let texts = items.into_iter().filter_map(|t| Some((self.text_value("from", t)?, t.span.clone())));
        texts.filter(|(id, _)| seen.insert(id.clone())).collect()
    }

    /// Makes the typed stage of a draft whose parameters are clean.
    fn make(&mut self, draft: &mut Draft) {
        let args: Vec<String> = draft.params.iter().map(|(k, v)| format!("{k}: {}", self.at(v))).collect();
        match typed::stage(&format!("{}({})", draft.name, args.join(", "))) {
            Ok(stage) => draft.stage = Some(stage),
            Err(reason) => {
                self.fault("bad_value", format!("`{}` cannot be made: {reason}", draft.name), &draft.place);
            }
        }
    }
}

impl Draft {
    fn new(name: &str, span: &Range<usize>, place: &Range<usize>, card: Option<Card>) -> Self {
        Draft {
            id: String::new(),
            name: name.to_owned(),
            given_id: None,
            from: Vec::new(),
            card,
            span: span.clone(),
            place: place.clone(),
            params: BTreeMap::new(),
            stage: None,
        }
    }
}

/// The fields that a pipeline file may have.
pub(super) fn top_level(registry: &Registry) -> Vec<&'static str> {
    let sections = registry.sections().iter().map(|s| s.field);
    PLAIN.into_iter().take(1).chain(sections).chain(PLAIN.into_iter().skip(1)).collect()
}

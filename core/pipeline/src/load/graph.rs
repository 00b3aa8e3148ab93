//! Which stage feeds which: stages follow each other by type.
//!
//! A port is fed by the one *live* maker of its kind. A stage that takes a kind and gives the same
//! kind supersedes what it took; a stage that makes a kind of something remade supersedes what was
//! made of its former state; a port that wants the original goes back to the first maker, one that
//! wants what was sewn goes back before the flatteners. Where two makers are live the file must say
//! `from` (a table section, which cannot, takes the latest). Every clash is a fault with both ends
//! underlined.
//!
//! Cost: stages times kinds times the number of live makers of one kind, which is one in all but
//! faulty files.

use super::fault::Fault;
use super::words::{a, all_of, bridge, list, required};
use crate::load::syntax::draft::Draft;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use toile_core::RunLog;
use toile_core::artifact::ArtifactType;
use toile_core::{Arity, Card, Feed, InPort, Kind, Registry, Role, Section, SectionValue};

/// The most places that one fault underlines.
const MAX_PLACES: usize = 4;

/// An output port: stage and port index.
type PortSource = (usize, usize);

/// Finds the feeds of every stage; what does not fit becomes a fault.
pub(super) fn connect(drafts: &[Draft], registry: &Registry, faults: &mut Vec<Fault>) -> Vec<Vec<Feed>> {
    let ids = drafts.iter().enumerate().rev().map(|(i, d)| (d.id.as_str(), i)).collect();
    let mut graph = StageGraph {
        drafts,
        registry,
        faults,
        ids,
        fed: Vec::new(),
        live: KindMakers::new(),
        roots: KindMakers::new(),
        blind: false,
    };
    (0..drafts.len()).for_each(|i| graph.add(i));
    graph.fed
}

type KindMakers = BTreeMap<Kind, Vec<PortSource>>;

struct StageGraph<'a> {
    drafts: &'a [Draft],
    registry: &'a Registry,
    faults: &'a mut Vec<Fault>,
    ids: BTreeMap<&'a str, usize>,
    /// The feeds of the stages so far.
    fed: Vec<Vec<Feed>>,
    /// Makers whose output is not superseded.
    live: KindMakers,
    /// Makers that made their kind from other kinds.
    roots: KindMakers,
    /// True after a stage of which nothing is known: what is missing may be its.
    blind: bool,
}

impl<'a> StageGraph<'a> {
    /// Feeds stage `i`, then adds what it makes.
    fn add(&mut self, i: usize) {
        let drafts = self.drafts;
        let Some(card) = drafts[i].card.as_ref() else {
            self.blind = true;
            self.fed.push(Vec::new());
            return;
        };
        let from = self.from(i, card);
        let feeds: Vec<Feed> = card.inputs.iter().map(|port| self.feed(i, port, from.as_deref())).collect();
        for (port, feed) in card.inputs.iter().zip(&feeds) {
            if let Feed::Node { node, port: output } = feed {
                self.check_arity(i, port, *node, *output);
            }
        }
        self.publish(i, card, &feeds);
        self.fed.push(feeds);
    }

    /// The stages that `from` names; none where it has a fault, which then stands for all others.
    fn from(&mut self, i: usize, card: &Card) -> Option<Vec<usize>> {
        let drafts = self.drafts;
        let resolved: Vec<Option<usize>> =
            drafts[i].from.iter().map(|(id, at)| self.named(i, card, id, at)).collect();
        resolved.into_iter().collect()
    }

    /// One id of a `from`.
    fn named(&mut self, i: usize, card: &Card, id: &str, at: &Range<usize>) -> Option<usize> {
        let Some(&maker) = self.ids.get(id) else {
            let ids: Vec<&str> = self.drafts[..i].iter().map(|d| d.id.as_str()).collect();
            let fault = Fault::new("unknown_id", format!("no stage has the id `{id}`")).at(at, "");
            self.faults.push(fault.hint(toile_core::hint(id, "before it stand", &ids)));
            return None;
        };
        if maker >= i {
            self.reads_later(i, maker, at);
            return None;
        }
        let Some(made) = self.drafts[maker].card.as_ref() else { return Some(maker) };
        let fits = |p: &InPort| made.outputs.iter().any(|o| o.kind == p.kind);
        if !card.inputs.iter().any(fits) {
            self.reads_other_kind(card, made, maker, at);
            return None;
        }
        Some(maker)
    }

    fn reads_later(&mut self, i: usize, maker: usize, at: &Range<usize>) {
        let (taker, id) = (&self.drafts[i].id, &self.drafts[maker].id);
        let fault = match maker == i {
            true => Fault::new("order", format!("`{taker}` cannot read from itself")).at(at, ""),
            false => Fault::new("order", format!("`{taker}` reads from `{id}`, which stands after it"))
                .at(at, "read here")
                .at(&self.drafts[maker].place, "stands here")
                .hint(format!("put `{id}` before `{taker}`")),
        };
        self.faults.push(fault);
    }

    /// `from` names a stage that makes nothing that this one takes.
    fn reads_other_kind(&mut self, card: &Card, made: &Card, maker: usize, at: &Range<usize>) {
        let taken: BTreeSet<Kind> =
            card.inputs.iter().map(|p| p.kind).filter(|k| *k != RunLog::KIND).collect();
        let given: BTreeSet<Kind> = made.outputs.iter().map(|o| o.kind).collect();
        let (takes, makes) = (all_of(taken.iter().copied()), all_of(given.iter().copied()));
        let message = format!("`{}` takes {takes}, but `{}` makes {makes}", card.name, made.name);
        let hint = between(&taken, &given, self.registry).or_else(|| self.other_maker(&taken));
        let fault = Fault::new("type_clash", message)
            .at(at, format!("takes {takes}"))
            .at(&self.drafts[maker].place, format!("makes {makes}"));
        self.faults.push(fault.hint(hint));
    }

    /// A live stage that makes one of the kinds.
    fn other_maker(&self, kinds: &BTreeSet<Kind>) -> Option<String> {
        let (kind, maker) = kinds.iter().find_map(|k| Some((k, self.live.get(k)?.last()?.0)))?;
        let id = &self.drafts[maker].id;
        Some(format!("`{id}` makes {}: write `from: \"{id}\"`", a(*kind)))
    }

    fn feed(&mut self, i: usize, port: &InPort, from: Option<&[usize]>) -> Feed {
        if port.kind == RunLog::KIND {
            return Feed::RunLog;
        }
        let Some(from) = from else { return Feed::Nothing };
        let named: Vec<PortSource> =
            from.iter().filter_map(|m| Some((*m, self.output(*m, port.kind)?))).collect();
        let makers = if port.original { &self.roots } else { &self.live };
        let typed = makers.get(&port.kind).map_or(&[][..], Vec::as_slice);
        let candidates = if named.is_empty() { typed } else { &named };
        let fed = |source: &PortSource| {
            let (node, port) = if port.sewn { self.sewn(*source, port.kind) } else { *source };
            Feed::Node { node, port }
        };
        match candidates {
            [source] => fed(source),
            [] if port.optional || self.blind => Feed::Nothing,
            [] => {
                let fault = self.missing(i, port.kind);
                self.faults.push(fault);
                Feed::Nothing
            }
            [.., source] if self.drafts[i].is_table => fed(source),
            several => {
                let fault = self.ambiguous(i, port.kind, several);
                self.faults.push(fault);
                Feed::Nothing
            }
        }
    }

    /// What flatteners were given, where a source is one of theirs.
    fn sewn(&self, source: PortSource, kind: Kind) -> PortSource {
        before_flatteners(source, kind, |node| Some((self.drafts[node].card.as_ref()?, self.fed.get(node)?)))
    }

    fn output(&self, maker: usize, kind: Kind) -> Option<usize> {
        self.drafts[maker].card.as_ref()?.outputs.iter().position(|o| o.kind == kind)
    }

    /// A stage as the file calls it: its id, or the field that stands for it.
    fn called(&self, i: usize) -> &'a str {
        let draft = &self.drafts[i];
        let is_its =
            |s: &&Section| matches!(s.holds, SectionValue::Table { stage, .. } if stage == draft.name);
        let field = self.registry.sections().iter().find(is_its).filter(|_| draft.is_table);
        field.map_or(draft.id.as_str(), |s| s.field)
    }

    /// Nothing before the stage makes the kind.
    fn missing(&self, i: usize, kind: Kind) -> Fault {
        let (taker, kind_words, called) = (&self.drafts[i], a(kind), self.called(i));
        let makes = |d: &&Draft| {
            let fresh =
                |c: &Card| c.outputs.iter().any(|o| o.kind == kind) && !required(c).any(|k| k == kind);
            d.card.as_ref().is_some_and(fresh)
        };
        if let Some(later) = self.drafts[i + 1..].iter().find(makes) {
            let message = format!("`{called}` takes {kind_words}, but `{}` makes it only later", later.id);
            return Fault::new("order", message)
                .at(&taker.place, format!("takes {kind_words}"))
                .at(&later.place, format!("makes {kind_words}"))
                .hint(format!("put `{}` before `{called}`", later.id));
        }
        let live = self.live.iter().filter(|(_, m)| !m.is_empty()).map(|(k, _)| *k).collect();
        Fault::new("missing_input", format!("`{called}` takes {kind_words}, but nothing before it makes one"))
            .at(&taker.place, format!("takes {kind_words}"))
            .hint(bridge(kind, &live, self.registry))
    }

    /// Several stages make the kind.
    fn ambiguous(&self, i: usize, kind: Kind, makers: &[PortSource]) -> Fault {
        let (taker, kind_words) = (&self.drafts[i], a(kind));
        let names: Vec<String> =
            makers.iter().take(MAX_PLACES).map(|(m, _)| format!("`{}`", self.drafts[*m].id)).collect();
        let message = match makers.len() > MAX_PLACES {
            true => format!("`{}` takes {kind_words}, but {} stages make one", taker.id, makers.len()),
            false => format!("`{}` takes {kind_words}, but {} each make one", taker.id, list(&names, "and")),
        };
        let fault = Fault::new("ambiguous_input", message).at(&taker.place, format!("takes {kind_words}"));
        let places = makers.iter().take(MAX_PLACES).map(|(m, _)| &self.drafts[*m].place);
        let last = makers.last().map_or("", |(m, _)| self.drafts[*m].id.as_str());
        places
            .fold(fault, |f, place| f.at(place, format!("makes {kind_words}")))
            .hint(format!("say which: `from: \"{last}\"`"))
    }

    /// A mapped stage and one that takes the whole set need a named set; the others a single value.
    fn check_arity(&mut self, i: usize, port: &InPort, node: usize, output: usize) {
        let (taker, maker) = (&self.drafts[i], &self.drafts[node]);
        let Some(card) = &maker.card else { return };
        let is_set = card.is_mapped() || card.outputs.get(output).is_some_and(|o| o.arity == Arity::All);
        let kind = port.kind;
        let (takes, makes) = match (port.arity, is_set) {
            (Arity::One, true) => (format!("a single {kind}"), format!("a named set ({kind})")),
            (Arity::Each | Arity::All, false) => {
                (format!("a named set ({kind})"), format!("a single {kind}"))
            }
            _ => return,
        };
        let message = format!("`{}` takes {takes}, but `{}` makes {makes}", taker.id, maker.id);
        let fault = Fault::new("arity_clash", message)
            .at(&taker.place, format!("takes {takes}"))
            .at(&maker.place, format!("makes {makes}"));
        self.faults.push(fault);
    }

    /// The live makers of a kind that have taken something of which a stage with these feeds takes
    /// a later state.
    fn stale(&self, kind: Kind, card: &Card, feeds: &[Feed]) -> Vec<PortSource> {
        let is_live =
            |kind: Kind, source: &PortSource| self.live.get(&kind).is_some_and(|l| l.contains(source));
        let taken: BTreeSet<Kind> =
            sources(card, feeds).filter(|(k, s)| is_live(*k, s)).map(|(k, _)| k).collect();
        let was_remade = |(maker, _): &&PortSource| {
            let (Some(card), Some(fed)) = (&self.drafts[*maker].card, self.fed.get(*maker)) else {
                return false;
            };
            sources(card, fed).any(|(k, s)| taken.contains(&k) && !is_live(k, &s))
        };
        self.live.get(&kind).into_iter().flatten().filter(was_remade).copied().collect()
    }

    /// Takes off what the stage supersedes and adds what it makes.
    fn publish(&mut self, i: usize, card: &Card, feeds: &[Feed]) {
        let kinds: BTreeSet<Kind> = card.outputs.iter().map(|o| o.kind).collect();
        let mut remade = BTreeSet::new();
        for (port, feed) in card.inputs.iter().zip(feeds) {
            if port.original || !kinds.contains(&port.kind) {
                continue;
            }
            let live = self.live.entry(port.kind).or_default();
            match feed {
                Feed::Node { node, port: output } => {
                    remade.insert(port.kind);
                    live.retain(|source| source != &(*node, *output));
                }
                // Several makers: that is a fault already, which the stages after this one need not
                // repeat.
                _ => live.clear(),
            }
        }
        for kind in kinds {
            let Some(port) = self.output(i, kind) else { continue };
            let stale = self.stale(kind, card, feeds);
            let live = self.live.entry(kind).or_default();
            live.retain(|source| !stale.contains(source));
            live.push((i, port));
            if !remade.contains(&kind) && stale.is_empty() {
                self.roots.entry(kind).or_default().push((i, port));
            }
        }
    }
}

/// The source of a kind before all flatteners that passed it on; `node` gives a stage's card and
/// feeds.
pub(crate) fn before_flatteners<'a>(
    source: (usize, usize),
    kind: Kind,
    node: impl Fn(usize) -> Option<(&'a Card, &'a Vec<Feed>)>,
) -> (usize, usize) {
    let mut at = source;
    while let Some((card, feeds)) = node(at.0).filter(|(card, _)| card.role == Role::Flattener) {
        let before = sources(card, feeds).find(|(k, _)| *k == kind);
        match before {
            Some((_, source)) => at = source,
            None => break,
        }
    }
    at
}

/// What `feeds` bring to a card's ports, by kind; originals are left out.
fn sources<'a>(card: &'a Card, feeds: &'a [Feed]) -> impl Iterator<Item = (Kind, PortSource)> + 'a {
    card.inputs.iter().zip(feeds).filter_map(|(port, feed)| match feed {
        Feed::Node { node, port: output } if !port.original => Some((port.kind, (*node, *output))),
        _ => None,
    })
}

/// Names the stages that make a wanted kind out of a given one.
fn between(wanted: &BTreeSet<Kind>, given: &BTreeSet<Kind>, registry: &Registry) -> Option<String> {
    let fits = |c: &&Card, kind: Kind| {
        let needs: BTreeSet<Kind> = required(c).collect();
        !needs.is_empty() && needs.is_subset(given) && c.outputs.iter().any(|o| o.kind == kind)
    };
    let kind = *wanted.iter().find(|k| !given.contains(k) && registry.cards().any(|c| fits(&c, **k)))?;
    let cards: Vec<&Card> =
        registry.in_order().into_iter().filter(|c| fits(c, kind)).take(MAX_PLACES).collect();
    let names: Vec<String> = cards.iter().map(|c| format!("`{}()`", c.name)).collect();
    let (verb, which) = if names.len() == 1 { ("makes", "it") } else { ("make", "one of them") };
    let from = all_of(cards.iter().flat_map(|c| required(c)));
    Some(format!("{} {verb} {} from {from}; put {which} between", list(&names, "and"), a(kind)))
}

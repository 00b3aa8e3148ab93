//! A stage between text and graph, and the ids of all stages.

use crate::load::fault::Fault;
use std::collections::BTreeMap;
use std::ops::Range;
use toile_core::{Card, Feed, Node, Stage};

/// A stage as far as it could be read.
#[derive(Debug)]
pub(crate) struct Draft {
    /// Its id; set by [`name_all`].
    pub(crate) id: String,
    /// The name that the file gives it.
    pub(crate) name: String,
    /// The name that was probably meant: others read from it by that.
    pub(crate) meant: Option<&'static str>,
    /// The `id` that the file gives it.
    pub(crate) given_id: Option<(String, Range<usize>)>,
    /// The ids that its `from` names.
    pub(crate) from: Vec<(String, Range<usize>)>,
    /// Its card; of an unknown stage, the card of the one that was probably meant, so that the
    /// graph can be checked all the same.
    pub(crate) card: Option<Card>,
    /// True of a table section, which has no place for `from`.
    pub(crate) is_table: bool,
    pub(crate) span: Range<usize>,
    pub(crate) place: Range<usize>,
    pub(crate) params: BTreeMap<String, Range<usize>>,
    /// The parameters whose values are wrong.
    pub(crate) wrong: Vec<&'static str>,
    /// None where it has a fault; where only values are wrong, the stage without them, if it can be
    /// made.
    pub(crate) stage: Option<Box<dyn Stage>>,
}

impl Draft {
    /// Something in place of a stage, of which nothing is known.
    pub(crate) fn unknown(span: &Range<usize>) -> Self {
        Draft::new("", span, span, None)
    }

    /// A stage of which no argument has been read yet.
    pub(crate) fn new(name: &str, span: &Range<usize>, place: &Range<usize>, card: Option<Card>) -> Self {
        Draft {
            id: String::new(),
            name: name.to_owned(),
            meant: None,
            given_id: None,
            from: Vec::new(),
            card,
            is_table: false,
            span: span.clone(),
            place: place.clone(),
            params: BTreeMap::new(),
            wrong: Vec::new(),
            stage: None,
        }
    }

    /// The finished node; none where the stage has a fault.
    pub(crate) fn finish(self, inputs: Vec<Feed>) -> Option<Node> {
        let Draft { id, card, span, place, params, stage, .. } = self;
        Some(Node { id, stage: stage?, card: card?, span, place, params, inputs })
    }
}

/// The stages that could be made.
#[derive(Debug, Default)]
pub(crate) struct Finished {
    /// Stages whose inputs, directly and indirectly, all come from stages that could be made.
    pub(crate) nodes: Vec<Node>,
    /// For each of `nodes`, whether all values of its parameters are those that the user wrote.
    pub(crate) own: Vec<bool>,
    /// Other stages with only values that the user wrote, without inputs.
    pub(crate) alone: Vec<Node>,
}

impl Finished {
    /// Removes all inputs of the stages, for a graph that is not that of the file.
    pub(crate) fn apart(self) -> Self {
        let Finished { nodes, own, mut alone } = self;
        let of_file = nodes.into_iter().zip(own).filter(|(_, own)| *own).map(|(node, _)| node);
        alone.extend(of_file.map(|node| Node { inputs: nothing(&node.card), ..node }));
        Finished { alone, ..Finished::default() }
    }
}

/// Inputs that nothing feeds.
fn nothing(card: &Card) -> Vec<Feed> {
    card.inputs.iter().map(|_| Feed::Nothing).collect()
}

/// The stages that could be made from these drafts with these inputs.
pub(crate) fn finished(drafts: Vec<Draft>, feeds: Vec<Vec<Feed>>) -> Finished {
    let mut all = Finished::default();
    // Where each draft stands among the nodes.
    let mut places: Vec<Option<usize>> = Vec::new();
    for (draft, inputs) in drafts.into_iter().zip(feeds) {
        let moved = |feed: Feed| match feed {
            Feed::Node { node, port } => {
                places.get(node).copied().flatten().map(|node| Feed::Node { node, port })
            }
            other => Some(other),
        };
        let inputs: Option<Vec<Feed>> = inputs.into_iter().map(moved).collect();
        let is_own = draft.wrong.is_empty();
        let node = match inputs {
            Some(inputs) => draft.finish(inputs),
            None => {
                let unfed = draft.card.as_ref().filter(|_| is_own).map(nothing);
                all.alone.extend(unfed.and_then(|inputs| draft.finish(inputs)));
                None
            }
        };
        places.push(node.as_ref().map(|_| all.nodes.len()));
        all.own.extend(node.as_ref().map(|_| is_own));
        all.nodes.extend(node);
    }
    all
}

/// Gives every stage its id: the one it asks for, else its name with a number where that is taken.
pub(crate) fn name_all<'a>(drafts: impl Iterator<Item = &'a mut Draft>, faults: &mut Vec<Fault>) {
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
        let name = draft.meant.unwrap_or(&draft.name).to_owned();
        let count = counts.entry(name.clone()).or_insert(0);
        loop {
            *count += 1;
            draft.id = if *count == 1 { name.clone() } else { format!("{name}{count}") };
            if !taken.contains_key(&draft.id) {
                break;
            }
        }
        taken.insert(draft.id.clone(), draft.place.clone());
    }
}

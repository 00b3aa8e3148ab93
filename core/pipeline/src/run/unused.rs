//! Warnings about what a pipeline without faults does not use: probably a mistake, but no reason
//! not to run.

use crate::load::words::{a, list};
use crate::load::{Fault, Faults, Pipeline, parse};
use std::ops::Range;
use toile_core::RunLog;
use toile_core::artifact::{ArtifactType, Figures, Garment, Model, OutputFiles};
use toile_core::{Card, Kind, Node, Registry, Role};

/// The most stages that a hint names.
const MAX_NAMED: usize = 4;

impl Pipeline {
    /// Stages whose results nothing uses, what stages warn of, and a pipeline that writes no
    /// garment; none where all is well.
    pub fn warnings(&self, registry: &Registry) -> Option<Faults> {
        let mut found: Vec<Fault> = self.unused();
        found.extend(crate::load::warnings(self));
        found.extend(self.writes_no_garment(registry));
        (!found.is_empty()).then(|| self.faults(found))
    }

    /// Stages whose results no stage takes and that write nothing, in a pipeline in which others
    /// write something.
    fn unused(&self) -> Vec<Fault> {
        if !self.nodes.iter().any(|n| gives(&n.card, OutputFiles::KIND)) {
            return Vec::new();
        }
        let is_end = |n: &Node| gives(&n.card, OutputFiles::KIND) || gives(&n.card, Figures::KIND);
        let lone = |(i, n): &(usize, &Node)| !is_end(n) && self.consumers(*i).is_empty();
        let nodes = self.nodes.iter().enumerate().filter(lone).map(|(_, n)| n);
        nodes.filter(|n| !n.place.is_empty()).map(unused).collect()
    }

    /// No writer takes a garment, or what is made of one.
    fn writes_no_garment(&self, registry: &Registry) -> Option<Fault> {
        let of_garment = |i: usize| {
            let needed = self.needed_for(&[i]);
            let made = self.nodes.iter().zip(needed).filter(|(_, needed)| *needed);
            made.map(|(n, _)| n).any(|n| gives(&n.card, Garment::KIND) || gives(&n.card, Model::KIND))
        };
        let by_hand = |n: &Node| gives(&n.card, OutputFiles::KIND) && !n.place.is_empty();
        let writes = self.nodes.iter().enumerate().any(|(i, n)| by_hand(n) && of_garment(i));
        if writes {
            return None;
        }
        let fault = Fault::new("no_garment", "the pipeline writes no garment").at(&self.stages_place(), "");
        let makes = |kind: Kind| self.nodes.iter().any(|n| gives(&n.card, kind));
        let kind = [Model::KIND, Garment::KIND].into_iter().find(|k| makes(*k));
        Some(match kind {
            Some(kind) => fault.hint(writers(kind, registry)),
            None => fault.hint(format!("no stage makes {}", a(Garment::KIND))),
        })
    }

    /// The field `stages`.
    fn stages_place(&self) -> Range<usize> {
        let tree = parse(&self.text).ok();
        tree.and_then(|t| t.entry(&self.text, "stages")?.key.clone()).unwrap_or(0..0)
    }
}

fn gives(card: &Card, kind: Kind) -> bool {
    card.outputs.iter().any(|o| o.kind == kind)
}

fn unused(node: &Node) -> Fault {
    let fault = Fault::new("unused", format!("nothing uses what `{}` makes", node.id)).at(&node.place, "");
    let kinds: Vec<String> = node.card.outputs.iter().map(|o| a(o.kind)).collect();
    let of = list(&kinds, "and");
    fault.hint(format!("it is left out of a run; put a stage that takes {of} behind it, or take it away"))
}

/// The writers that take such a kind.
fn writers(kind: Kind, registry: &Registry) -> Option<String> {
    let takes = |c: &&Card| {
        let inputs = || c.inputs.iter();
        gives(c, OutputFiles::KIND)
            && inputs().any(|p| p.kind == kind && !p.optional)
            && !inputs().any(|p| p.kind == RunLog::KIND)
            && !registry.is_implicit(c)
    };
    let cards = registry.of_role(Role::Writer).filter(takes).take(MAX_NAMED);
    let names: Vec<String> = cards.map(|c| format!("`{}()`", c.name)).collect();
    let one = if names.len() == 1 { "it" } else { "one of them" };
    let verb = if names.len() == 1 { "writes" } else { "write" };
    (!names.is_empty()).then(|| format!("{} {verb} {}; put {one} last", list(&names, "and"), a(kind)))
}

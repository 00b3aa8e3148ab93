//! Knobs held against a pipeline: which slot each acts on, and what it may be set to there.

use super::{Knob, KnobBoard, KnobSlot, Setting};
use crate::knobs::dial::{Dial, dial};
use crate::knobs::knob::{KnobSpec, Values, fault};
use crate::knobs::source::{Source, path_of};
use toile_core::{Card, Node, ParamDoc, Role, StageError, nearest};
use toile_pipeline::Pipeline;

impl KnobBoard {
    /// Holds knobs against a pipeline.
    ///
    /// Errors: a name that is not there, a range or value that the parameter does not take; with
    /// the nearest name.
    pub fn new(
        source: &Source<'_>,
        pipeline: &Pipeline,
        specs: &[KnobSpec],
    ) -> Result<KnobBoard, StageError> {
        let cards = source.registry.cards().cloned().collect();
        let mut board = KnobBoard { knobs: Vec::new(), slots: Vec::new(), cards, reference: Setting::new() };
        // Choices of stages first: others may name a stage that only a choice brings in.
        let (choices, others): (Vec<_>, Vec<_>) = specs.iter().partition(|s| s.param.is_none());
        for spec in choices.into_iter().chain(others) {
            let knob = board.bind(source, pipeline, spec)?;
            if board.knobs.iter().any(|k| k.key == knob.key) {
                return Err(fault(format!("there are two knobs `{}`", knob.key))
                    .hint("give the second another range, or leave it out"));
            }
            if let Some(same) = board.knobs.iter().find(|k| k.turns_what(&knob)) {
                return Err(fault(format!("the knobs `{}` and `{}` turn the same", same.key, knob.key))
                    .hint("leave one of them out"));
            }
            board.knobs.push(knob);
        }
        Ok(board)
    }

    fn bind(
        &mut self,
        source: &Source<'_>,
        pipeline: &Pipeline,
        spec: &KnobSpec,
    ) -> Result<Knob, StageError> {
        let (slot, only) = self.find(source, pipeline, &spec.owner)?;
        let dial = match (&spec.param, &spec.values) {
            (None, Values::List(names)) => Dial::Stage(self.stages(slot, names)?),
            (None, Values::Range(..)) => {
                return Err(fault(format!("`{}` is a stage, which has no range", spec.owner)).hint(format!(
                    "list stages, like `{}=StaticEquilibrium,Xpbd`, or name a parameter, like `{0}.edge=6..24 mm`",
                    spec.owner
                )));
            }
            (Some(param), values) => {
                let doc = self.doc(slot, only.as_deref(), param, spec)?;
                dial(&spec.key(), &doc, values)?
            }
        };
        Ok(Knob { key: spec.key(), slot, only, param: spec.param.clone(), dial })
    }

    /// The slot that a name or role stands for, and the one stage it is limited to.
    fn find(
        &mut self,
        source: &Source<'_>,
        pipeline: &Pipeline,
        owner: &str,
    ) -> Result<(usize, Option<String>), StageError> {
        if let Some(node) = pipeline.nodes.iter().find(|n| n.id == owner) {
            return Ok((self.slot(source, pipeline, node), Some(node.card.name.to_owned())));
        }
        let brings = |k: &&Knob| matches!(&k.dial, Dial::Stage(names) if names.iter().any(|n| n == owner));
        if let Some(knob) = self.knobs.iter().find(brings) {
            return Ok((knob.slot, Some(owner.to_owned())));
        }
        let role = role(owner).ok_or_else(|| unknown(pipeline, owner))?;
        let nodes: Vec<&Node> = pipeline.nodes.iter().filter(|n| n.card.role == role).collect();
        match nodes.as_slice() {
            [node] => Ok((self.slot(source, pipeline, node), None)),
            [] => Err(unknown(pipeline, owner)),
            several => {
                let ids: Vec<&str> = several.iter().map(|n| n.id.as_str()).collect();
                Err(fault(format!("the pipeline has {} stages of the role `{owner}`", several.len()))
                    .hint(format!("name one of {}", ids.join(", "))))
            }
        }
    }

    fn slot(&mut self, source: &Source<'_>, pipeline: &Pipeline, node: &Node) -> usize {
        let path = path_of(source, pipeline, node);
        if let Some(known) = self.slots.iter().position(|s| s.path == path) {
            return known;
        }
        let text = |span: &std::ops::Range<usize>| pipeline.text.get(span.clone()).unwrap_or("").to_owned();
        self.slots.push(KnobSlot {
            path,
            own: node.card.clone(),
            given: node.params.iter().map(|(name, span)| (name.clone(), text(span))).collect(),
            params: node.stage.params(),
        });
        self.slots.len() - 1
    }

    fn stages(&self, slot: usize, names: &[String]) -> Result<Vec<String>, StageError> {
        let role = self.slots[slot].own.role;
        let known: Vec<&str> = self.cards.iter().filter(|c| c.role == role).map(|c| c.name).collect();
        for name in names {
            if !known.contains(&name.as_str()) {
                let near = nearest(name, known.iter().copied()).map(|n| format!("did you mean `{n}`?"));
                return Err(fault(format!("no {} is called `{name}`", role.as_str()))
                    .hint(near.unwrap_or_else(|| format!("there is {}", quoted(&known)))));
            }
        }
        Ok(names.to_vec())
    }

    /// The card of a parameter.
    fn doc(
        &self,
        slot: usize,
        only: Option<&str>,
        param: &str,
        spec: &KnobSpec,
    ) -> Result<ParamDoc, StageError> {
        let cards = self.cards_in(slot);
        let acts_on: Vec<&Card> =
            cards.iter().copied().filter(|c| only.is_none_or(|name| c.name == name)).collect();
        let docs = acts_on.iter().flat_map(|c| &c.params);
        if let Some(doc) = docs.clone().find(|d| d.name == param) {
            return Ok(doc.clone());
        }
        let mut known: Vec<&str> = docs.map(|d| d.name).collect();
        known.dedup();
        let near =
            nearest(param, known.iter().copied()).map(|n| format!("did you mean `{}.{n}`?", spec.owner));
        Err(fault(format!("`{}` has no parameter `{param}`", spec.owner))
            .hint(near.unwrap_or_else(|| format!("there is {}", quoted(&known)))))
    }

    /// The cards that may stand in a slot.
    pub(super) fn cards_in(&self, slot: usize) -> Vec<&Card> {
        let own = &self.slots[slot].own;
        let chosen = self.knobs.iter().filter(|k| k.slot == slot).filter_map(|k| match &k.dial {
            Dial::Stage(names) => Some(names),
            _ => None,
        });
        let chosen = chosen.flatten().filter_map(|n| self.card(own.role, n)).filter(|c| c.name != own.name);
        std::iter::once(own).chain(chosen).collect()
    }

    pub(super) fn card(&self, role: Role, name: &str) -> Option<&Card> {
        self.cards.iter().find(|c| c.role == role && c.name == name)
    }
}

impl Knob {
    /// Whether it turns what another does: the choice of one slot's stage, or one parameter of one
    /// stage.
    fn turns_what(&self, other: &Knob) -> bool {
        let is_of =
            |only: &Option<String>, name: &Option<String>| only.is_none() || name.is_none() || only == name;
        self.slot == other.slot
            && self.param == other.param
            && (self.param.is_none() || is_of(&self.only, &other.only))
    }
}

/// The role of a key; `solver` is the draper.
fn role(word: &str) -> Option<Role> {
    match word {
        "solver" => Some(Role::Draper),
        _ => Role::named(&word.replace(['-', '_'], " ")),
    }
}

fn unknown(pipeline: &Pipeline, owner: &str) -> StageError {
    let ids = pipeline.nodes.iter().map(|n| n.id.as_str());
    let roles = pipeline.nodes.iter().map(|n| n.card.role.as_str());
    let mut known: Vec<&str> = ids.chain(roles).chain(["solver"]).collect();
    known.sort_unstable();
    known.dedup();
    let near = nearest(owner, known.iter().copied()).map(|n| format!("did you mean `{n}`?"));
    fault(format!("the pipeline has no stage or role `{owner}`"))
        .hint(near.unwrap_or_else(|| format!("there is {}", quoted(&known))))
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

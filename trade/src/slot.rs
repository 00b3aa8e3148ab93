//! Knobs held against a pipeline, and settings of them as overrides of its file.
//!
//! A *slot* is a place in the pipeline that holds one stage. A knob turns the stage of a slot or one of its parameters.
//! A parameter knob by role (`mesher.edge`) acts on whatever stage is in the slot, if it has the parameter; one by
//! name (`GridMesher.edge`) on that stage alone. Where it has nothing to act on it is left out of the setting, so that
//! settings that differ in nothing are one.

mod reference;

pub use reference::ReferenceValue;

use crate::dial::{Dial, Form, dial, is_finer, is_spatial, numeric, rounded, way};
use crate::knob::{KnobSpec, Values, fault};
use crate::split::field;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_core::pipeline::{Changes, Faults, Node, Override, Pipeline, load_with, nearest};
use toile_core::{Card, ParamDoc, Registry, Role, SectionValue, StageError, add_implicit};

/// A pipeline file with what the user has set, ready to be loaded with other settings.
#[derive(Debug, Clone)]
pub struct Source<'a> {
    /// Its text.
    pub text: String,
    /// Its name, for messages.
    pub file: String,
    /// The folder that its paths are relative to.
    pub base: PathBuf,
    /// The named quality, before `set`.
    pub quality: Option<String>,
    /// `--set`, before all knobs.
    pub set: Vec<Override>,
    /// The stages there are.
    pub registry: &'a Registry,
}

impl Source<'_> {
    /// Loads it with further overrides, and with the stages that every pipeline gets.
    ///
    /// Errors: every fault of the file.
    pub fn load(&self, more: &[Override]) -> Result<Pipeline, Box<Faults>> {
        let all: Vec<Override> = self.set.iter().chain(more).cloned().collect();
        let changes = Changes { quality: self.quality.as_deref(), set: &all, ..Changes::default() };
        let loaded = load_with(&self.text, &self.file, &self.base, self.registry, &changes);
        let mut pipeline = loaded.map_err(Box::new)?;
        add_implicit(&mut pipeline, self.registry);
        Ok(pipeline)
    }
}

/// A knob of a pipeline.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// As the user knows it: `mesher.edge`.
    pub key: String,
    /// The index of its slot.
    pub slot: usize,
    /// The stage that it acts on; none where it acts on any that has the parameter.
    pub only: Option<String>,
    /// The parameter; none for the choice of the stage.
    pub param: Option<String>,
    /// What it may be.
    pub dial: Dial,
}

/// A place of the pipeline that knobs act on.
#[derive(Debug, Clone)]
pub struct Slot {
    /// The path of its stage for overrides: `stages.GridMesher`, `body`.
    path: String,
    /// The card of the stage that the file has there.
    own: Card,
    /// Its parameters that the file gives, as text.
    given: BTreeMap<String, String>,
    /// All its parameters, as text.
    params: String,
}

/// The knobs of a pipeline with the slots that they act on.
#[derive(Debug, Clone)]
pub struct Board {
    /// The knobs, in the user's order; dimensions of the search.
    pub knobs: Vec<Knob>,
    slots: Vec<Slot>,
    cards: Vec<Card>,
    /// What the reference has in place of the pipeline's own values.
    reference: Setting,
}

/// A setting: the value of every knob that acts, by its key.
pub type Setting = BTreeMap<String, String>;

impl Board {
    /// Holds knobs against a pipeline.
    ///
    /// Errors: a name that is not there, a range or value that the parameter does not take; with the nearest name.
    pub fn new(source: &Source<'_>, pipeline: &Pipeline, specs: &[KnobSpec]) -> Result<Board, StageError> {
        let cards = source.registry.cards().cloned().collect();
        let mut board = Board { knobs: Vec::new(), slots: Vec::new(), cards, reference: Setting::new() };
        // Choices of stages first: others may name a stage that only a choice brings in.
        let (choices, others): (Vec<_>, Vec<_>) = specs.iter().partition(|s| s.param.is_none());
        for spec in choices.into_iter().chain(others) {
            let knob = board.bind(source, pipeline, spec)?;
            if board.knobs.iter().any(|k| k.key == knob.key) {
                return Err(fault(format!("there are two knobs `{}`", knob.key))
                    .hint("give the second another range, or leave it out"));
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
                    "list stages, like `{}=Rest,Xpbd`, or name a parameter, like `{0}.edge=6..24 mm`",
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
        self.slots.push(Slot {
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
    fn cards_in(&self, slot: usize) -> Vec<&Card> {
        let own = &self.slots[slot].own;
        let chosen = self.knobs.iter().filter(|k| k.slot == slot).filter_map(|k| match &k.dial {
            Dial::Stage(names) => Some(names),
            _ => None,
        });
        let chosen = chosen.flatten().filter_map(|n| self.card(own.role, n)).filter(|c| c.name != own.name);
        std::iter::once(own).chain(chosen).collect()
    }

    fn card(&self, role: Role, name: &str) -> Option<&Card> {
        self.cards.iter().find(|c| c.role == role && c.name == name)
    }

    /// The setting at a point of the unit cube, one coordinate a knob.
    pub fn setting(&self, at: &[f64]) -> Setting {
        let value = |i: usize| at.get(i).copied().unwrap_or(0.5).clamp(0.0, 1.0);
        let picked: Vec<(usize, String)> =
            self.knobs.iter().enumerate().map(|(i, k)| (i, k.dial.at(value(i)))).collect();
        let stage = |slot: usize| {
            let of_slot = |(i, _): &&(usize, String)| {
                self.knobs[*i].slot == slot && matches!(self.knobs[*i].dial, Dial::Stage(_))
            };
            picked.iter().find(of_slot).map_or(self.slots[slot].own.name, |(_, name)| name)
        };
        let acts = |(i, _): &&(usize, String)| self.acts(&self.knobs[*i], stage(self.knobs[*i].slot));
        picked.iter().filter(acts).map(|(i, v)| (self.knobs[*i].key.clone(), v.clone())).collect()
    }

    /// Whether a knob acts on the stage of that name in its slot.
    fn acts(&self, knob: &Knob, stage: &str) -> bool {
        let Some(param) = &knob.param else { return true };
        let card = self.card(self.slots[knob.slot].own.role, stage);
        knob.only.as_ref().is_none_or(|only| only == stage)
            && card.is_some_and(|c| c.params.iter().any(|p| p.name == param))
    }

    /// What the pipeline's own file says, as a setting.
    pub fn own(&self) -> Setting {
        let own = |k: &Knob| {
            let slot = &self.slots[k.slot];
            let value = match &k.param {
                None => slot.own.name.to_owned(),
                Some(param) => field(&slot.params, param)?.to_owned(),
            };
            self.acts(k, slot.own.name).then(|| (k.key.clone(), value))
        };
        self.knobs.iter().filter_map(own).collect()
    }

    /// The reference's setting, the pipeline's own where it was given none, with every resolution refined by a factor, as
    /// far as its parameters go.
    pub fn refined(&self, factor: f64) -> Setting {
        let mut setting = self.unrefined();
        for knob in &self.knobs {
            let Some((way, doc)) = self.resolution(knob) else { continue };
            let Some(own) = setting.get(&knob.key).and_then(|v| numeric(v)) else { continue };
            let finer =
                (own / factor.powf(way)).clamp(doc.min.unwrap_or(f64::MIN), doc.max.unwrap_or(f64::MAX));
            if let (Some(form), true) = (Form::of(doc), finer != own) {
                setting.insert(knob.key.clone(), form.write(rounded(finer)));
            }
        }
        setting
    }

    /// True where every resolution of a setting is finer by a factor than all that its knob may be set to.
    pub fn is_finer(&self, setting: &Setting, factor: f64) -> bool {
        self.resolutions(setting).all(|(way, finest, value)| is_finer(way, value, finest, factor))
    }

    /// True where a setting has a resolution that is not coarser by a factor than the reference's.
    pub fn is_too_fine(&self, setting: &Setting, reference: &Setting, factor: f64) -> bool {
        let pair = |k: &Knob| {
            let (way, _) = self.resolution(k)?;
            let (own, other) = (numeric(setting.get(&k.key)?)?, numeric(reference.get(&k.key)?)?);
            Some(!is_finer(way, other, own, factor))
        };
        self.knobs.iter().filter(|k| self.is_spatial(k)).filter_map(pair).any(|too_fine| too_fine)
    }

    /// Direction, finest value of the dial and value in a setting, of every knob that is a resolution in space.
    fn resolutions<'b>(&'b self, setting: &'b Setting) -> impl Iterator<Item = (f64, f64, f64)> + 'b {
        self.knobs.iter().filter(|k| self.is_spatial(k)).filter_map(|k| {
            let (way, _) = self.resolution(k)?;
            Some((way, k.dial.finest(way)?, numeric(setting.get(&k.key)?)?))
        })
    }

    /// Which way a knob is refined, with its parameter; none where it is no resolution of the pipeline's own stage.
    fn resolution(&self, knob: &Knob) -> Option<(f64, &ParamDoc)> {
        let param = knob.param.as_deref()?;
        let doc = self.slots[knob.slot].own.params.iter().find(|p| p.name == param)?;
        Some((way(doc)?, doc))
    }

    fn is_spatial(&self, knob: &Knob) -> bool {
        self.resolution(knob).is_some_and(|(_, doc)| is_spatial(doc))
    }

    /// The place of a setting in the unit cube; knobs that do not act are at their middle.
    pub fn place(&self, setting: &Setting) -> Vec<f64> {
        self.knobs.iter().map(|k| setting.get(&k.key).and_then(|v| k.dial.place(v)).unwrap_or(0.5)).collect()
    }

    /// The overrides that make a setting, in the order in which they are applied.
    pub fn overrides(&self, setting: &Setting) -> Vec<Override> {
        (0..self.slots.len()).flat_map(|slot| self.slot_overrides(slot, setting)).collect()
    }

    fn slot_overrides(&self, index: usize, setting: &Setting) -> Vec<Override> {
        let slot = &self.slots[index];
        let knobs = || self.knobs.iter().filter(|k| k.slot == index);
        let chosen = knobs().find(|k| k.param.is_none()).and_then(|k| setting.get(&k.key));
        let turned: Vec<(&String, &String)> =
            knobs().filter_map(|k| Some((k.param.as_ref()?, setting.get(&k.key)?))).collect();
        match chosen.filter(|name| **name != slot.own.name) {
            None => turned
                .iter()
                .map(|(param, value)| Override {
                    path: format!("{}.{param}", slot.path),
                    value: (*value).clone(),
                })
                .collect(),
            Some(name) => {
                let mut params = self.carried(slot, name);
                params.extend(turned.iter().map(|(p, v)| ((*p).clone(), (*v).clone())));
                let params: Vec<String> = params.iter().map(|(p, v)| format!("{p}: {v}")).collect();
                vec![Override { path: slot.path.clone(), value: format!("{name}({})", params.join(", ")) }]
            }
        }
    }

    /// What the file gives of the slot's own stage that a stage in its place takes as well.
    fn carried(&self, slot: &Slot, name: &str) -> BTreeMap<String, String> {
        let Some(card) = self.card(slot.own.role, name) else { return BTreeMap::new() };
        let same = |p: &ParamDoc| slot.own.params.iter().any(|q| q.name == p.name && q.kind == p.kind);
        let takes = |name: &str, text: &str| {
            card.params.iter().any(|p| p.name == name && same(p) && p.check.run(text, p).is_ok())
        };
        slot.given
            .iter()
            .filter(|(name, text)| takes(name, text))
            .map(|(n, t)| (n.clone(), t.clone()))
            .collect()
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

/// The path by which overrides reach a stage: in the list, or in a section of the file.
pub(crate) fn path_of(source: &Source<'_>, pipeline: &Pipeline, node: &Node) -> String {
    let sections = source.registry.sections().iter().filter_map(|s| match s.holds {
        SectionValue::Stage(role) if role == node.card.role => Some(s.field.to_owned()),
        _ => None,
    });
    let text = pipeline.text.get(node.span.clone()).unwrap_or("").to_owned();
    // In its own place a stage's own text changes nothing; anywhere else it does not load.
    let is_its = |path: &String| {
        let same = source.load(&[Override { path: path.clone(), value: text.clone() }]);
        same.is_ok_and(|p| p.text == pipeline.text)
    };
    let in_list = format!("stages.{}", node.id);
    sections.chain([in_list.clone()]).find(is_its).unwrap_or(in_list)
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
#[path = "slot_tests.rs"]
mod tests;

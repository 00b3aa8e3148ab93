//! A run under way: stage by stage, each from the cache where its result is known, and what lies in the cache
//! only brought into memory once something needs it.

use super::node::{Failure, Made, run_entries};
use super::value::{Held, gather};
use super::{Reads, RunError, typed};
use crate::artifact::{Measure, stored};
use crate::cache::{Cache, Fed, Found, Hash, Ingredients, Kept, Manifest, Miss, RUN_SO_FAR, of_stage};
use crate::cost::{Meter, Predicted, Size, StageCost, Used, size_of};
use crate::pipeline::{Feed, Node, Pipeline};
use crate::{Arity, ArtifactType, Cancel, Context, Contract, Event, Inputs, Listener, PortValue, StageError};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError};
use std::time::Instant;

/// What became of a stage.
pub(super) enum Step {
    /// Left out, with the reason.
    Skipped(String),
    /// Run, or found in the cache.
    Ran(Ran),
}

/// A stage that gave its result.
pub(super) struct Ran {
    pub(super) outputs: Vec<Held>,
    pub(super) wall_s: f64,
    /// True while nothing of it had to be run.
    pub(super) cached: bool,
    pub(super) figures: Vec<Measure>,
    pub(super) warnings: Vec<String>,
    /// What it took and how much it made, where it ran whole under a meter.
    pub(super) cost: Option<(Used, Size)>,
}

/// A run up to some stage.
pub(super) struct Run<'a> {
    pub(super) pipeline: &'a Pipeline,
    pub(super) cache: Option<&'a Arc<Cache>>,
    pub(super) cancel: &'a Cancel,
    pub(super) listener: &'a Arc<dyn Listener>,
    pub(super) reads: Option<&'a Reads>,
    pub(super) meter: Option<&'a dyn Meter>,
    pub(super) predicted: &'a BTreeMap<String, Predicted>,
    pub(super) steps: Vec<Step>,
}

/// One run of a stage, as it is looked for in the cache.
pub(super) struct Search {
    pub(super) entry: String,
    pub(super) ingredients: Ingredients,
    pub(super) found: Found,
}

impl Run<'_> {
    /// Gives the next stage its result.
    pub(super) fn step(&mut self) -> Result<(), RunError> {
        let index = self.steps.len();
        let node = &self.pipeline.nodes[index];
        let cx = self.context(node, self.listener.clone());
        cx.progress(0.0, "");
        let started = Instant::now();
        cx.check().map_err(|e| located(node, (String::new(), e)))?;
        let searches = self.search(index).map_err(|e| located(node, e))?;
        self.tell(node, &searches);
        let missing = searches.iter().filter(|s| matches!(s.found, Found::Miss(_)));
        let missing: Vec<String> = missing.map(|s| s.entry.clone()).collect();
        let whole = missing.len() == searches.len() && !missing.is_empty();
        let (made, used) = self.make(index, &missing, &cx)?;
        let cost = used.filter(|_| whole).map(|used| (used, sizes(&made)));
        let mut ran = self.ran(node, searches, made, &cx);
        ran.cost = cost;
        cx.progress(1.0, "");
        ran.wall_s = started.elapsed().as_secs_f64();
        self.steps.push(Step::Ran(ran));
        Ok(())
    }

    fn context(&self, node: &Node, listener: Arc<dyn Listener>) -> Context {
        let cx = Context::new(&node.id, &self.pipeline.base, self.cancel.clone(), listener);
        cx.with_memo(self.cache.cloned(), of_stage(&node.card))
    }

    /// Looks for every run of a stage in the cache.
    pub(super) fn search(&self, index: usize) -> Result<Vec<Search>, Failure> {
        let node = &self.pipeline.nodes[index];
        let kept = node.card.contracts.contains(&Contract::Deterministic);
        let search = |entry: String| {
            let ingredients = self.ingredients(index, &entry);
            let key = ingredients.key().filter(|_| kept);
            let found = match (self.cache, key) {
                (Some(cache), Some(key)) => shaped(node, cache.find(&key, &self.pipeline.base)),
                _ => Found::Miss(Miss::Unknown),
            };
            Search { entry, ingredients, found }
        };
        Ok(self.entries(index)?.into_iter().map(search).collect())
    }

    /// The key of a run; none where it cannot be kept.
    fn key(&self, node: &Node, ingredients: &Ingredients) -> Option<(&Cache, Hash)> {
        let kept = node.card.contracts.contains(&Contract::Deterministic);
        Some((self.cache?, ingredients.key().filter(|_| kept)?))
    }

    /// Says what is wrong with the cache, and repeats the warnings of results that come from it.
    fn tell(&self, node: &Node, searches: &[Search]) {
        for search in searches {
            match &search.found {
                Found::Hit(manifest) => {
                    self.note_reads(manifest.reads.clone());
                    for warning in &manifest.warnings {
                        self.listener.event(&node.id, &search.entry, &Event::Warning(warning.clone()));
                    }
                }
                Found::Miss(Miss::Damaged(why)) => self.damaged(node, &search.entry, why),
                Found::Miss(_) => {}
            }
        }
    }

    fn damaged(&self, node: &Node, entry: &str, why: &str) {
        let of = if entry.is_empty() { String::new() } else { format!(" ({entry})") };
        if let Some(cache) = self.cache {
            cache.warn(format!("damaged cache entry of {}{of}: {why}; it is made anew", node.id));
        }
    }

    /// Keeps what was made and puts it together with what was found.
    fn ran(&self, node: &Node, searches: Vec<Search>, made: Vec<Made>, cx: &Context) -> Ran {
        let cached = made.is_empty() && self.cache.is_some();
        let kept = self.keep(node, &searches, &made);
        let mut made = made.into_iter().zip(kept).peekable();
        let (mut notes, mut entries) = ((Vec::new(), Vec::new()), Vec::new());
        for Search { entry, ingredients, found } in searches {
            let (fresh, manifest) = match found {
                Found::Hit(manifest) => (None, Some(manifest)),
                Found::Miss(_) => made.next().map_or((None, None), |(made, kept)| (Some(made), kept)),
            };
            if let (Some(cache), Some(manifest)) = (self.cache, &manifest) {
                if let (None, Some(key)) = (&fresh, ingredients.key()) {
                    cache.touch(&key, manifest);
                }
                cache.note(self.pipeline, &node.id, &ingredients, manifest);
            }
            entries.push((entry.clone(), held(node, fresh.as_ref(), manifest.as_ref())));
            let own = match (fresh, manifest) {
                (Some(made), _) => (made.figures, made.warnings),
                (None, Some(manifest)) => (manifest.figures(), manifest.warnings),
                (None, None) => (Vec::new(), Vec::new()),
            };
            match node.card.is_mapped() {
                true => cx.absorb(&entry, own.0, own.1),
                false => notes = own,
            }
        }
        let outputs = match node.card.is_mapped() {
            true => {
                notes = cx.take_notes();
                gather(&node.card, &entries)
            }
            false => entries.pop().map(|(_, outputs)| outputs).unwrap_or_default(),
        };
        Ran { outputs, wall_s: 0.0, cached, figures: notes.0, warnings: notes.1, cost: None }
    }

    /// Puts into the cache what was made; none for what cannot be kept.
    fn keep(&self, node: &Node, searches: &[Search], made: &[Made]) -> Vec<Option<Manifest>> {
        let keep = |made: &Made| {
            let search = searches.iter().find(|s| s.entry == made.entry)?;
            let (cache, key) = self.key(node, &search.ingredients)?;
            Some(cache.keep(&key, made))
        };
        made.par_iter().map(keep).collect()
    }

    /// What every stage took.
    pub(super) fn costs(&self) -> Vec<StageCost> {
        let cost = |(node, step): (&Node, &Step)| match step {
            Step::Ran(Ran { cost: Some((used, made)), .. }) => {
                Some(StageCost { stage: node.id.clone(), used: *used, made: made.clone() })
            }
            _ => None,
        };
        self.pipeline.nodes.iter().zip(&self.steps).filter_map(cost).collect()
    }

    /// Runs a stage for some of its entries, and says what that took.
    fn make(
        &mut self,
        index: usize,
        entries: &[String],
        cx: &Context,
    ) -> Result<(Vec<Made>, Option<Used>), RunError> {
        let node = &self.pipeline.nodes[index];
        if entries.is_empty() {
            return Ok((Vec::new(), None));
        }
        for (port, feed) in node.card.inputs.iter().zip(&node.inputs) {
            match feed {
                Feed::Nothing => {}
                Feed::RunLog => self.ensure_before(index)?,
                Feed::Node { node: maker, port: output } => {
                    let some = (port.arity == Arity::Each).then_some(entries);
                    self.ensure(*maker, *output, some)?;
                }
            }
        }
        let jobs = entries.iter().map(|e| (e.clone(), self.inputs(index, e))).collect();
        self.meter.iter().for_each(|m| m.start());
        let made = run_entries(node, jobs, cx);
        let used = self.meter.map(Meter::stop);
        self.note_reads(cx.take_reads());
        made.map(|made| (made, used)).map_err(|e| located(node, e))
    }

    /// Tells whoever asked which files were read.
    fn note_reads(&self, files: impl IntoIterator<Item = (String, Option<Hash>)>) {
        if let Some(reads) = self.reads {
            let full = files.into_iter().map(|(path, hash)| (self.pipeline.base.join(path), hash));
            reads.lock().unwrap_or_else(PoisonError::into_inner).extend(full);
        }
    }

    /// Brings what a report on the stages before `index` is given into memory: all but services.
    fn ensure_before(&mut self, index: usize) -> Result<(), RunError> {
        for i in 0..index {
            for (port, out) in self.pipeline.nodes[i].card.outputs.iter().enumerate() {
                if stored::is_stored(out.kind) {
                    self.ensure(i, port, None)?;
                }
            }
        }
        Ok(())
    }

    /// Brings all that a stage made into memory.
    pub(super) fn ensure_all(&mut self, index: usize) -> Result<(), RunError> {
        let ports = match &self.steps[index] {
            Step::Ran(ran) => ran.outputs.len(),
            Step::Skipped(_) => 0,
        };
        (0..ports).try_for_each(|port| self.ensure(index, port, None))
    }

    /// Brings a port's value (of some entries) into memory: from the cache, or where it is not to be had from there
    /// by running its stage.
    pub(super) fn ensure(
        &mut self,
        index: usize,
        port: usize,
        entries: Option<&[String]>,
    ) -> Result<(), RunError> {
        let (node, cache) = (&self.pipeline.nodes[index], self.cache.map(Arc::as_ref));
        let Step::Ran(ran) = &mut self.steps[index] else { return Ok(()) };
        let Some(held) = ran.outputs.get_mut(port) else { return Ok(()) };
        let lost = held.ensure(entries, cache);
        for (name, damage) in &lost {
            if let Some(why) = damage {
                self.damaged(node, name, why);
            }
        }
        let mut lost: Vec<String> = lost.into_iter().map(|(name, _)| name).collect();
        if !lost.is_empty() && !node.card.is_mapped() {
            lost = vec![String::new()];
        }
        if lost.is_empty() { Ok(()) } else { self.remake(index, &lost) }
    }

    /// Runs a stage again whose result is known but not to be had.
    fn remake(&mut self, index: usize, entries: &[String]) -> Result<(), RunError> {
        let node = &self.pipeline.nodes[index];
        // What it said came from the cache already.
        let cx = self.context(node, Arc::new(()));
        let started = Instant::now();
        let (made, _) = self.make(index, entries, &cx)?;
        for made in &made {
            if let Some((cache, key)) = self.key(node, &self.ingredients(index, &made.entry)) {
                cache.keep(&key, made);
            }
        }
        let Step::Ran(ran) = &mut self.steps[index] else { return Ok(()) };
        for made in &made {
            for (held, value) in ran.outputs.iter_mut().zip(&made.outputs) {
                held.restore(&made.entry, value);
            }
        }
        ran.cached = false;
        ran.wall_s += started.elapsed().as_secs_f64();
        Ok(())
    }

    /// The inputs of one run, all of which are in memory.
    fn inputs(&self, index: usize, entry: &str) -> Inputs {
        let node = &self.pipeline.nodes[index];
        let value = |(port, feed): (&crate::InPort, &Feed)| match feed {
            Feed::Nothing => None,
            Feed::RunLog => Some(PortValue::One(Arc::new(self.report(index)))),
            Feed::Node { node, port: output } => {
                let one = (port.arity == Arity::Each).then_some(entry);
                self.held(*node, *output)?.value(one)
            }
        };
        Inputs(node.card.inputs.iter().zip(&node.inputs).map(value).collect())
    }

    fn held(&self, node: usize, port: usize) -> Option<&Held> {
        match self.steps.get(node)? {
            Step::Ran(ran) => ran.outputs.get(port),
            Step::Skipped(_) => None,
        }
    }

    fn ingredients(&self, index: usize, entry: &str) -> Ingredients {
        let node = &self.pipeline.nodes[index];
        let fed = |(port, feed): (&crate::InPort, &Feed)| match feed {
            Feed::Nothing => (String::new(), Fed::Nothing),
            Feed::RunLog => (RUN_SO_FAR.to_owned(), self.log_hash(index).map_or(Fed::Unknown, Fed::One)),
            Feed::Node { node, port: output } => {
                let one = (port.arity == Arity::Each).then_some(entry);
                let value = match self.held(*node, *output) {
                    // What feeds an optional port may itself have been given nothing.
                    None => Fed::Nothing,
                    Some(held) => held.fed(one),
                };
                (self.pipeline.nodes[*node].id.clone(), value)
            }
        };
        let inputs = node.card.inputs.iter().zip(&node.inputs).map(fed).collect();
        Ingredients::of(node, entry, inputs)
    }

    /// The names of the sets on the mapped ports, which must all be the same; one empty name for a stage that is not
    /// mapped.
    fn entries(&self, index: usize) -> Result<Vec<String>, Failure> {
        let node = &self.pipeline.nodes[index];
        if !node.card.is_mapped() {
            return Ok(vec![String::new()]);
        }
        let ports = node.card.inputs.iter().zip(&node.inputs).filter(|(p, _)| p.arity == Arity::Each);
        let mut sets = ports.filter_map(|(port, feed)| match feed {
            Feed::Node { node, port: output } => Some((port.kind, self.held(*node, *output)?.names()?)),
            _ => None,
        });
        let Some((first_kind, names)) = sets.next() else { return Ok(Vec::new()) };
        for (kind, other) in sets {
            if other != names {
                let message = format!(
                    "the {first_kind}s are named {} but the {kind}s {}",
                    names.join(", "),
                    other.join(", ")
                );
                return Err((String::new(), StageError::invalid(message)));
            }
        }
        Ok(names)
    }

    /// All artifacts of a type, which are brought into memory first.
    pub(super) fn all<T: ArtifactType + Clone>(&mut self) -> Result<Vec<T>, RunError> {
        let mut all = Vec::new();
        for index in 0..self.steps.len() {
            let outputs = &self.pipeline.nodes[index].card.outputs;
            for port in (0..outputs.len()).filter(|p| outputs[*p].kind == T::KIND) {
                self.ensure(index, port, None)?;
                let value = self.held(index, port).and_then(|held| held.value(None));
                let made = value.iter().flat_map(PortValue::entries).filter_map(|(_, a)| typed::<T>(a));
                all.extend(made.cloned());
            }
        }
        Ok(all)
    }
}

/// The values of one run's ports.
pub(super) fn held(node: &Node, made: Option<&Made>, manifest: Option<&Manifest>) -> Vec<Held> {
    let port = |(i, out): (usize, &crate::OutPort)| {
        let value = made.and_then(|m| m.outputs.get(i));
        Held::of(out.kind, value, manifest.and_then(|m| m.outputs.get(i)))
    };
    node.card.outputs.iter().enumerate().map(port).collect()
}

/// How much was made, all entries and ports together.
fn sizes(made: &[Made]) -> Size {
    let ports = |m: &Made| m.outputs.iter().fold(Size::new(), |all, v| all.joined(&size_of(v)));
    made.iter().fold(Size::new(), |sum, m| sum.plus(&ports(m)))
}

/// A manifest that does not have the stage's ports is damaged.
fn shaped(node: &Node, found: Found) -> Found {
    let Found::Hit(manifest) = found else { return found };
    let fits =
        |(port, kept): (&crate::OutPort, &Kept)| (port.arity == Arity::All) == matches!(kept, Kept::Set(_));
    let ports = &node.card.outputs;
    match manifest.outputs.len() == ports.len() && ports.iter().zip(&manifest.outputs).all(fits) {
        true => Found::Hit(manifest),
        false => Found::Miss(Miss::Damaged("its outputs are not those of the stage".into())),
    }
}

/// A failure with its place in the pipeline file.
fn located(node: &Node, (entry, error): Failure) -> RunError {
    let span = error.param.and_then(|p| node.params.get(p)).unwrap_or(&node.span).clone();
    RunError { stage: node.id.clone(), entry, span, error }
}

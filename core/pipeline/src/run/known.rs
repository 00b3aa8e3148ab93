//! Results that are known: looked for in the cache, put together with what was made, and kept
//! there.

use super::node::EntryFailure;
use super::steps::{PipelineRun, RanStage, StageOutcome};
use super::value::{HeldValue, gather};
use crate::cache::{Cache, CacheAnswer, Ingredients, KeptValue, Manifest, Miss};
use crate::made::EntryResult;
use rayon::prelude::*;
use toile_core::artifact::Digest;
use toile_core::{Arity, Context, Contract, Event, Node, Remarks};

/// One run of a stage, as it is looked for in the cache.
pub(super) struct CacheSearch {
    pub(super) entry: String,
    pub(super) ingredients: Ingredients,
    pub(super) found: CacheAnswer,
}

impl PipelineRun<'_> {
    /// Looks for every run of a stage in the cache.
    pub(super) fn search(&self, index: usize) -> Result<Vec<CacheSearch>, EntryFailure> {
        let node = &self.pipeline.nodes[index];
        let kept = node.card.contracts.contains(&Contract::Deterministic);
        let search = |entry: String| {
            let ingredients = self.ingredients(index, &entry);
            let key = ingredients.key().filter(|_| kept);
            let found = match (self.cache, key) {
                (Some(cache), Some(key)) => shaped(node, cache.find(&key, &self.pipeline.base)),
                _ => CacheAnswer::Miss(Miss::Unknown),
            };
            CacheSearch { entry, ingredients, found }
        };
        Ok(self.entries(index)?.into_iter().map(search).collect())
    }

    /// The key of a run; none where it cannot be kept.
    pub(super) fn key(&self, node: &Node, ingredients: &Ingredients) -> Option<(&Cache, Digest)> {
        let kept = node.card.contracts.contains(&Contract::Deterministic);
        Some((self.cache?, ingredients.key().filter(|_| kept)?))
    }

    /// Says what is wrong with the cache, and repeats the remarks of results that come from it.
    pub(super) fn tell(&self, node: &Node, searches: &[CacheSearch]) {
        for search in searches {
            match &search.found {
                CacheAnswer::Hit(manifest) => {
                    self.note_reads(manifest.reads.clone());
                    let Remarks { notes, warnings } = manifest.remarks.clone();
                    let events = notes.into_iter().map(Event::Note);
                    for event in events.chain(warnings.into_iter().map(Event::Warning)) {
                        self.listener.event(&node.id, &search.entry, &event);
                    }
                }
                CacheAnswer::Miss(Miss::Damaged(why)) => self.damaged(node, &search.entry, why),
                CacheAnswer::Miss(_) => {}
            }
        }
    }

    pub(super) fn damaged(&self, node: &Node, entry: &str, why: &str) {
        let of = if entry.is_empty() { String::new() } else { format!(" ({entry})") };
        if let Some(cache) = self.cache {
            cache.warn(format!("damaged cache entry of {}{of}: {why}; it is made anew", node.id));
        }
    }

    /// Keeps what was made and puts it together with what was found.
    pub(super) fn ran(
        &self,
        node: &Node,
        searches: Vec<CacheSearch>,
        made: Vec<EntryResult>,
        cx: &Context,
    ) -> RanStage {
        let cached = made.is_empty() && self.cache.is_some();
        let kept = self.keep(node, &searches, &made);
        let mut made = made.into_iter().zip(kept).peekable();
        let (mut figures, mut remarks, mut entries) = (Vec::new(), Remarks::default(), Vec::new());
        for CacheSearch { entry, ingredients, found } in searches {
            let (fresh, manifest) = match found {
                CacheAnswer::Hit(manifest) => (None, Some(manifest)),
                CacheAnswer::Miss(_) => made.next().map_or((None, None), |(made, kept)| (Some(made), kept)),
            };
            if let (Some(cache), Some(manifest)) = (self.cache, &manifest) {
                if let (None, Some(key)) = (&fresh, ingredients.key()) {
                    cache.touch(&key, manifest);
                }
                cache.note(self.pipeline, &node.id, &ingredients, manifest);
            }
            entries.push((entry.clone(), held(node, fresh.as_ref(), manifest.as_ref())));
            let own = match (fresh, manifest) {
                (Some(made), _) => (made.figures, made.remarks),
                (None, Some(manifest)) => (manifest.figures(), manifest.remarks),
                (None, None) => (Vec::new(), Remarks::default()),
            };
            match node.card.is_mapped() {
                true => cx.absorb(&entry, own.0, own.1),
                false => (figures, remarks) = own,
            }
        }
        let outputs = match node.card.is_mapped() {
            true => {
                (figures, remarks) = (cx.take_figures(), cx.take_remarks());
                gather(&node.card, &entries)
            }
            false => entries.pop().map(|(_, outputs)| outputs).unwrap_or_default(),
        };
        self.told_before(&mut remarks);
        RanStage { outputs, wall_s: 0.0, cached, figures, remarks, cost: None }
    }

    /// Takes off what an earlier stage has told in the same words.
    fn told_before(&self, remarks: &mut Remarks) {
        let before: Vec<&Remarks> =
            self.steps.iter().filter_map(StageOutcome::ran).map(|ran| &ran.remarks).collect();
        remarks.notes.retain(|text| before.iter().all(|r| !r.notes.contains(text)));
        remarks.warnings.retain(|text| before.iter().all(|r| !r.warnings.contains(text)));
    }

    /// Puts into the cache what was made; none for what cannot be kept.
    fn keep(&self, node: &Node, searches: &[CacheSearch], made: &[EntryResult]) -> Vec<Option<Manifest>> {
        let keep = |made: &EntryResult| {
            let search = searches.iter().find(|s| s.entry == made.entry)?;
            let (cache, key) = self.key(node, &search.ingredients)?;
            Some(cache.keep(&key, made))
        };
        made.par_iter().map(keep).collect()
    }
}

/// The values of one run's ports.
pub(super) fn held(node: &Node, made: Option<&EntryResult>, manifest: Option<&Manifest>) -> Vec<HeldValue> {
    let port = |(i, out): (usize, &toile_core::OutPort)| {
        let value = made.and_then(|m| m.outputs.get(i));
        HeldValue::of(out.kind, value, manifest.and_then(|m| m.outputs.get(i)))
    };
    node.card.outputs.iter().enumerate().map(port).collect()
}

/// A manifest that does not have the stage's ports is damaged.
fn shaped(node: &Node, found: CacheAnswer) -> CacheAnswer {
    let CacheAnswer::Hit(manifest) = found else { return found };
    let fits = |(port, kept): (&toile_core::OutPort, &KeptValue)| {
        (port.arity == Arity::All) == matches!(kept, KeptValue::Set(_))
    };
    let ports = &node.card.outputs;
    match manifest.outputs.len() == ports.len() && ports.iter().zip(&manifest.outputs).all(fits) {
        true => CacheAnswer::Hit(manifest),
        false => CacheAnswer::Miss(Miss::Damaged("its outputs are not those of the stage".into())),
    }
}

//! What lies in the cache only, brought into memory once something needs it.

use super::RunError;
use super::steps::{PipelineRun, StageOutcome};
use std::sync::Arc;
use std::time::Instant;
use toile_core::artifact::stored;

impl PipelineRun<'_> {
    /// Brings what a report on the stages before `index` is given into memory: all but services.
    pub(super) fn ensure_before(&mut self, index: usize) -> Result<(), RunError> {
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
        let ports = match self.steps.get(index) {
            Some(StageOutcome::Ran(ran)) => ran.outputs.len(),
            _ => 0,
        };
        (0..ports).try_for_each(|port| self.ensure(index, port, None))
    }

    /// Brings a port's value (of some entries) into memory: from the cache, or where it is not to
    /// be had from there by running its stage.
    pub(super) fn ensure(
        &mut self,
        index: usize,
        port: usize,
        entries: Option<&[String]>,
    ) -> Result<(), RunError> {
        let (node, cache) = (&self.pipeline.nodes[index], self.cache.map(Arc::as_ref));
        let Some(StageOutcome::Ran(ran)) = self.steps.get_mut(index) else { return Ok(()) };
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
        let Some(StageOutcome::Ran(ran)) = self.steps.get_mut(index) else { return Ok(()) };
        for made in &made {
            for (held, value) in ran.outputs.iter_mut().zip(&made.outputs) {
                held.restore(&made.entry, value);
            }
        }
        ran.cached = false;
        ran.wall_s += started.elapsed().as_secs_f64();
        Ok(())
    }
}

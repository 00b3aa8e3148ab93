//! Stages that only improve on a result that is good already: where one fails, that result goes on,
//! with a warning.
//!
//! A stage that improves (`toile_core::Stage::improves`) gives back the kinds that it takes: a
//! garment in another pose, on a finer mesh, at rest again. The result that it improves on is the
//! last garment at rest that a stage made which does not improve. All improving stages since then
//! are undone together, for none of them leaves a result by itself: a garment in another pose is
//! good once it has settled. Each of them then passes on what it was given, and the run goes on
//! from the first of them.

use super::node::WORK;
use super::steps::{PipelineRun, RanStage, StageOutcome};
use super::value::HeldValue;
use super::{RunError, typed};
use std::ops::Range;
use toile_core::artifact::{ArtifactType, Garment, Kind};
use toile_core::{ErrorCode, Event, Feed, Node, PortValue, Remarks};

impl PipelineRun<'_> {
    /// Undoes what failed at stage `index`, where it improves on a result that is at rest; the
    /// runner then goes on behind the steps that are left.
    ///
    /// Errors: the failure itself, where there is no such result, or where the user asked to stop.
    pub(super) fn undo(&mut self, index: usize, failure: RunError) -> Result<(), RunError> {
        let node = &self.pipeline.nodes[index];
        if failure.error.code == ErrorCode::Cancelled
            || !node.stage.improves()
            || self.undone.contains_key(&index)
        {
            return Err(failure);
        }
        let Some(base) = self.base(index)? else { return Err(failure) };
        let why = format!(
            "{}; the garment is shown as `{}` left it",
            failure.error.message, self.pipeline.nodes[base].id
        );
        self.turn_back(base, index, why.clone());
        self.listener.event(&node.id, &failure.entry, &Event::Warning(why));
        Ok(())
    }

    /// Undoes the improving stages up to `index`, the last one to have run, where they took a
    /// garment away from rest and did not bring it back. A later stage that improves may do so
    /// still.
    pub(super) fn undo_unrest(&mut self, index: usize) -> Result<(), RunError> {
        let nodes = &self.pipeline.nodes;
        let fed_by =
            |n: &Node| n.inputs.iter().any(|f| matches!(f, Feed::Node { node, .. } if *node == index));
        let goes_on = nodes.iter().any(|n| fed_by(n) && n.stage.improves() && gives_garment(n));
        let looks = nodes[index].stage.improves() && gives_garment(&nodes[index]) && !goes_on;
        if !looks || self.undone.contains_key(&index) || self.is_at_rest(index)? != Some(false) {
            return Ok(());
        }
        if let Some(base) = self.base(index)? {
            let why = format!(
                "the garment did not come to rest again; it is shown as `{}` left it",
                self.pipeline.nodes[base].id
            );
            self.turn_back(base, index, why.clone());
            self.listener.event(&self.pipeline.nodes[index].id, "", &Event::Warning(why));
        }
        Ok(())
    }

    /// The improving stages that ran behind the last garment at rest, all of which could be undone;
    /// none where there are none.
    pub(super) fn improvements(&mut self) -> Result<Option<(usize, usize)>, RunError> {
        let last = (0..self.steps.len()).rev().find(|&i| {
            let node = &self.pipeline.nodes[i];
            let ran = matches!(self.steps[i], StageOutcome::Ran(_));
            ran && node.stage.improves() && gives_garment(node) && !self.undone.contains_key(&i)
        });
        let Some(last) = last else { return Ok(None) };
        Ok(self.base(last)?.map(|base| (base, last)))
    }

    /// Has the improving stages between `base` and `last` pass on what they are given, and forgets
    /// all steps from the first of them.
    pub(super) fn turn_back(&mut self, base: usize, last: usize, why: String) {
        let between: Range<usize> = base + 1..last + 1;
        let improving: Vec<usize> =
            between.filter(|&i| self.pipeline.nodes[i].stage.improves() && !self.is_skipped(i)).collect();
        let first = improving.first().copied().unwrap_or(last);
        for i in improving {
            self.undone.insert(i, None);
        }
        self.undone.insert(last, Some(why));
        self.steps.truncate(first);
    }

    /// Tells what the steps from `first` on remarked, which ran unheard.
    pub(super) fn tell_again(&self, first: usize) {
        for (step, node) in self.steps.iter().zip(&self.pipeline.nodes).skip(first) {
            let Some(RanStage { remarks: Remarks { notes, warnings }, .. }) = step.ran() else { continue };
            notes.iter().for_each(|text| self.listener.event(&node.id, "", &Event::Note(text.clone())));
            warnings.iter().for_each(|text| self.listener.event(&node.id, "", &Event::Warning(text.clone())));
        }
    }

    /// The result of an undone stage: what it was given of the kinds that it makes.
    ///
    /// Errors: those of bringing that into memory.
    pub(super) fn passed_on(&mut self, index: usize) -> Result<RanStage, RunError> {
        let node = &self.pipeline.nodes[index];
        let mut outputs = Vec::new();
        for out in &node.card.outputs {
            let Some(Feed::Node { node: maker, port }) = feed_of(node, out.kind).cloned() else {
                outputs.push(HeldValue::Unknown);
                continue;
            };
            self.ensure(maker, port, None)?;
            outputs.push(self.held(maker, port).cloned().unwrap_or(HeldValue::Unknown));
        }
        let mut remarks = Remarks::default();
        if let Some(Some(why)) = self.undone.get(&index) {
            remarks.warnings.push(why.clone());
        }
        Ok(RanStage { outputs, wall_s: 0.0, cached: false, figures: Vec::new(), remarks, cost: None })
    }

    /// How much work the stage may take: as much as the result took that it improves on; any amount
    /// where it does not improve.
    pub(super) fn allowance(&self, index: usize) -> Option<f64> {
        if !self.pipeline.nodes[index].stage.improves() {
            return None;
        }
        let before = self.steps[..index.min(self.steps.len())].iter().zip(&self.pipeline.nodes).rev();
        let mut work = before
            .filter(|(_, node)| !node.stage.improves())
            .filter_map(|(step, _)| step.ran()?.figures.iter().find(|m| m.name == WORK).map(|m| m.value));
        work.next()
    }

    /// The stage that made the garment at rest on which the improving stages up to `index` build.
    fn base(&mut self, index: usize) -> Result<Option<usize>, RunError> {
        let nodes = &self.pipeline.nodes;
        let passes = |i: usize| nodes[i].card.outputs.iter().all(|o| feed_of(&nodes[i], o.kind).is_some());
        let makes =
            |i: &usize| gives_garment(&nodes[*i]) && !nodes[*i].stage.improves() && !self.is_skipped(*i);
        let Some(base) = (0..index.min(self.steps.len())).rev().find(makes) else { return Ok(None) };
        let all_pass = (base + 1..=index).filter(|&i| nodes[i].stage.improves()).all(passes);
        Ok((self.is_at_rest(base)? == Some(true) && all_pass).then_some(base))
    }

    fn is_skipped(&self, index: usize) -> bool {
        matches!(self.steps.get(index), Some(StageOutcome::Skipped(_)))
    }

    /// Whether the garment that a stage made is at rest; none where it made none.
    fn is_at_rest(&mut self, index: usize) -> Result<Option<bool>, RunError> {
        let outputs = &self.pipeline.nodes[index].card.outputs;
        let Some(port) = outputs.iter().position(|o| o.kind == Garment::KIND) else { return Ok(None) };
        self.ensure(index, port, None)?;
        let value = self.held(index, port).and_then(|held| held.value(None));
        let Some(PortValue::One(artifact)) = value else { return Ok(None) };
        Ok(typed::<Garment>(&artifact).map(|g| g.status.converged))
    }
}

fn gives_garment(node: &Node) -> bool {
    node.card.outputs.iter().any(|o| o.kind == Garment::KIND)
}

/// What feeds a stage's last port of that kind: the latest made, where another one wants the first.
fn feed_of(node: &Node, kind: Kind) -> Option<&Feed> {
    let ports = node.card.inputs.iter().zip(&node.inputs).rev();
    let mut feeds = ports.filter(|(port, _)| port.kind == kind && !port.original).map(|(_, feed)| feed);
    feeds.find(|feed| matches!(feed, Feed::Node { .. }))
}

//! Tells a watcher of the stages that are done.

use super::RunError;
use super::steps::{PipelineRun, StageOutcome};
use super::watch::WatchedStage;
use toile_core::Remarks;

impl PipelineRun<'_> {
    /// Tells the watcher of the stages from `first` on.
    ///
    /// Errors: those of bringing into memory what it wants to see.
    pub(super) fn tell_watch(&mut self, first: usize) -> Result<(), RunError> {
        let Some(watch) = self.watch.clone() else { return Ok(()) };
        for index in first..self.steps.len() {
            let node = &self.pipeline.nodes[index];
            for (port, out) in node.card.outputs.iter().enumerate() {
                if watch.kinds().contains(&out.kind) {
                    self.ensure(index, port, None)?;
                }
            }
            let none = Remarks::default();
            let stage = WatchedStage {
                id: &node.id,
                index,
                skipped: None,
                wall_s: 0.0,
                cached: false,
                figures: &[],
                remarks: &none,
                outputs: Vec::new(),
            };
            watch.done(&match &self.steps[index] {
                StageOutcome::Skipped(reason) => WatchedStage { skipped: Some(reason), ..stage },
                StageOutcome::Ran(ran) => WatchedStage {
                    wall_s: ran.wall_s,
                    cached: ran.cached,
                    figures: &ran.figures,
                    remarks: &ran.remarks,
                    outputs: ran.outputs.iter().filter_map(|held| held.value(None)).collect(),
                    ..stage
                },
            });
        }
        Ok(())
    }
}

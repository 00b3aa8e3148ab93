//! What a run says of itself: digests of what every stage made, and the records that reports are
//! given.

use super::steps::{PipelineRun, RanStage, StageOutcome};
use super::value::HeldValue;
use crate::cache::Fed;
use toile_core::artifact::{Digest, Digester, stored};
use toile_core::{Node, PortValue};
use toile_core::{RunLog, StageRecord};

impl PipelineRun<'_> {
    /// The digest of what every stage made.
    pub(super) fn results(&self) -> Vec<(String, Option<Digest>)> {
        let result = |ran: &RanStage| {
            let mut d = Digester::new();
            d.text("toile result").count(ran.outputs.len());
            for held in &ran.outputs {
                feed(&mut d, held)?;
            }
            Some(d.finish())
        };
        let steps = self.pipeline.nodes.iter().zip(&self.steps);
        let ran = steps.filter_map(|(node, step)| match step {
            StageOutcome::Ran(ran) => Some((node.id.clone(), result(ran))),
            StageOutcome::Skipped(_) => None,
        });
        ran.collect()
    }

    /// The digest of the run so far, times apart; none where something in it has no digest.
    pub(super) fn log_hash(&self, index: usize) -> Option<Digest> {
        let mut d = Digester::new();
        d.text("toile run").text(&self.pipeline.name).count(index);
        if let Some(quality) = &self.pipeline.quality {
            d.text("quality").text(quality);
        }
        for (node, step) in self.pipeline.nodes.iter().zip(&self.steps).take(index) {
            d.text(&node.id);
            let ran = match step {
                StageOutcome::Skipped(reason) => {
                    d.text("skipped").text(reason);
                    continue;
                }
                StageOutcome::Ran(ran) => ran,
            };
            d.text(node.card.name).text(&node.stage.params()).count(ran.outputs.len());
            for held in &ran.outputs {
                feed(&mut d, held)?;
            }
        }
        Some(d.finish())
    }

    /// The record that a report is given: without services, which would have to be set up to be
    /// shown.
    pub(super) fn report(&self, index: usize) -> RunLog {
        let mut log = self.new_log();
        for (node, step) in self.pipeline.nodes.iter().zip(&self.steps).take(index) {
            match step {
                StageOutcome::Skipped(reason) => log.skipped.push((node.id.clone(), reason.clone())),
                StageOutcome::Ran(ran) => {
                    let shown =
                        node.card.outputs.iter().zip(&ran.outputs).filter(|(o, _)| stored::is_stored(o.kind));
                    log.stages.push(self.record(node, ran, shown.map(|(_, held)| held)));
                }
            }
        }
        log
    }

    /// The record of the stages before `index`. A stage of whose artifacts one is not in memory has
    /// none.
    pub(super) fn log(&self, index: usize) -> RunLog {
        let mut log = self.new_log();
        for (node, step) in self.pipeline.nodes.iter().zip(&self.steps).take(index) {
            match step {
                StageOutcome::Skipped(reason) => log.skipped.push((node.id.clone(), reason.clone())),
                StageOutcome::Ran(ran) => log.stages.push(self.record(node, ran, ran.outputs.iter())),
            }
        }
        log
    }

    fn new_log(&self) -> RunLog {
        let (pipeline, quality) = (self.pipeline.name.clone(), self.pipeline.quality.clone());
        RunLog { pipeline, quality, ..RunLog::default() }
    }

    fn record<'h>(
        &self,
        node: &Node,
        ran: &RanStage,
        held: impl Iterator<Item = &'h HeldValue>,
    ) -> StageRecord {
        let outputs: Option<Vec<PortValue>> = held.map(|held| held.value(None)).collect();
        StageRecord {
            id: node.id.clone(),
            name: node.card.name.to_owned(),
            role: node.card.role,
            params: node.stage.params(),
            wall_s: ran.wall_s,
            outputs: outputs.unwrap_or_default(),
            figures: ran.figures.clone(),
            remarks: ran.remarks.clone(),
            used: ran.cost.as_ref().map(|c| c.0),
            predicted: self.pipeline.find(&node.id).and_then(|i| self.expected(i)),
        }
    }
}

/// Feeds a value's digests; none where it has none.
fn feed(d: &mut Digester, held: &HeldValue) -> Option<()> {
    match held.fed(None) {
        Fed::One(hash) => d.bytes(&hash.0),
        Fed::Set(set) => set.iter().fold(d.count(set.len()), |d, (name, hash)| d.text(name).bytes(&hash.0)),
        Fed::Nothing | Fed::Unknown => return None,
    };
    Some(())
}

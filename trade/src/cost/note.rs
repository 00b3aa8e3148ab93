//! From a run to its records.

use super::Costs;
use super::named::{key, style};
use super::record::CostRecord;
use super::work::work;
use std::cell::RefCell;
use std::collections::BTreeMap;
use toile_core::cost::Size;
use toile_pipeline::Pipeline;
use toile_pipeline::cost::{Foreseen, StageCost, foresee};

/// What the stages of a run took, with the sizes that they had; what came from the cache has none
/// and is taken from earlier runs.
pub fn note(pipeline: &Pipeline, costs: &[StageCost], earlier: &Costs, threads: usize) -> Vec<CostRecord> {
    let facts: BTreeMap<&str, &StageCost> = costs.iter().map(|c| (c.stage.as_str(), c)).collect();
    let keys: RefCell<Vec<String>> = RefCell::default();
    let known = |i: usize, rule: &Size| {
        let own = key(&pipeline.nodes[i], rule);
        let made = facts.get(pipeline.nodes[i].id.as_str()).map(|c| c.made.clone());
        let made = made.or_else(|| earlier.made(&own).cloned());
        keys.borrow_mut().push(own);
        made
    };
    let sizes = foresee(pipeline, &known);
    let before = foresee(pipeline, &|_, _| None);
    let all = |f: &Foreseen| f.given.clone().joined(&f.made);
    let record = |(i, key): (usize, String)| {
        let (node, cost) = (&pipeline.nodes[i], facts.get(pipeline.nodes[i].id.as_str())?);
        Some(CostRecord {
            pipeline: pipeline.name.clone(),
            style: style(pipeline),
            stage: work(node),
            role: node.card.role.as_str().to_owned(),
            key,
            threads,
            size: all(&sizes[i]),
            made: cost.made.clone(),
            foreseen: all(&before[i]),
            used: cost.used,
        })
    };
    keys.into_inner().into_iter().enumerate().filter_map(record).collect()
}

//! A pipeline's forecast.

use super::named::{key, style};
use super::record::CostFigure;
use super::work::work;
use super::{Costs, StagePlace};
use toile_core::Node;
use toile_core::cost::{Estimate, Predicted, Size};
use toile_pipeline::Pipeline;
use toile_pipeline::cost::{Foreseen, foresee};

/// What is expected of one stage.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// The stage's id.
    pub stage: String,
    /// How much it will be given and make, all together.
    pub size: Size,
    /// What it will take.
    pub predicted: Predicted,
    /// False where the stage has no record of its own and others of its role stand in.
    pub known: bool,
    /// False where the stage has not run on this machine yet.
    pub measured_here: bool,
}

/// What each stage of a pipeline will be given, make and take. Nothing is run.
pub fn predict(pipeline: &Pipeline, costs: &Costs) -> Vec<Forecast> {
    let sizes = sizes(pipeline, costs).into_iter().enumerate();
    sizes.filter_map(|(i, size)| forecast(pipeline, costs, i, size)).collect()
}

/// How much each stage of a pipeline will be given and make, all together.
pub fn sizes(pipeline: &Pipeline, costs: &Costs) -> Vec<Size> {
    let known = |i: usize, rule: &Size| costs.made(&key(&pipeline.nodes[i], rule)).cloned();
    let (rules, facts) = (foresee(pipeline, &|_, _| None), foresee(pipeline, &known));
    let style = style(pipeline);
    let size = |(node, (rules, facts)): (&Node, (Foreseen, Foreseen))| {
        best(&costs.corrected(&work(node), &style, &all(&rules)), &all(&rules), &all(&facts))
    };
    pipeline.nodes.iter().zip(rules.into_iter().zip(facts)).map(size).collect()
}

/// What one stage, by its index, will take of such a size.
pub fn forecast(pipeline: &Pipeline, costs: &Costs, node: usize, size: Size) -> Option<Forecast> {
    let node = pipeline.nodes.get(node)?;
    let (work, role, style) = (work(node), node.card.role.as_str(), style(pipeline));
    let place = StagePlace { pipeline: &pipeline.name, stage: &work, role, style: &style };
    let predicted = costs.predicted(&place, &size);
    let (known, measured_here) = (costs.knows(&work), costs.measured_here(&work));
    Some(Forecast { stage: node.id.clone(), size, predicted, known, measured_here })
}

fn all(f: &Foreseen) -> Size {
    f.given.clone().joined(&f.made)
}

/// What follows from facts of earlier runs where there are some, else the corrected rules.
fn best(corrected: &Size, rules: &Size, facts: &Size) -> Size {
    let told = facts.iter().filter(|(q, a)| rules.get(*q) != Some(*a));
    told.fold(corrected.clone(), |all, (q, a)| all.with(q, a))
}

/// All stages together: times add up, with errors that do not depend on each other; memory is the
/// peak of one stage on top of what those before it keep.
pub fn total(stages: &[&Predicted]) -> Predicted {
    let of = |p: &Predicted, f: CostFigure| f.predicted(p);
    let sum = |figure| sum(stages.iter().filter_map(|p| of(p, figure)));
    let mut held: Vec<Estimate> = Vec::new();
    let mut peak: Option<Estimate> = None;
    for p in stages {
        if let Some(own) = of(p, CostFigure::Peak) {
            let here = self::sum(held.iter().copied().chain([own]));
            peak = peak.into_iter().chain(here).reduce(|a, b| if a.value < b.value { b } else { a });
        }
        held.extend(of(p, CostFigure::Kept));
    }
    Predicted {
        wall_s: sum(CostFigure::Wall),
        cpu_s: sum(CostFigure::Cpu),
        peak_bytes: peak,
        kept_bytes: sum(CostFigure::Kept),
    }
}

fn sum(all: impl Iterator<Item = Estimate>) -> Option<Estimate> {
    let add = |(v, below, above): (f64, f64, f64), e: Estimate| {
        (v + e.value, below.hypot(e.value - e.low), above.hypot(e.high - e.value))
    };
    let all: Vec<Estimate> = all.collect();
    let (value, below, above) = all.iter().fold((0.0, 0.0, 0.0), |s, e| add(s, *e));
    (!all.is_empty()).then(|| Estimate { value, low: (value - below).max(0.0), high: value + above })
}

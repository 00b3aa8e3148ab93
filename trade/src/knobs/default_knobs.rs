//! What is turned where the user names no knob.
//!
//! The stages decide most of a garment's time and error in this order: edge length of the mesh,
//! solver, when it stops, mesher. Where a draped garment is laid out finer and draped on, that mesh
//! and the last solver are turned: the first mesh picks the folds, and another one would pick
//! others. Their ranges are factors around the pipeline's own values.

use crate::knobs::dial::{NumberForm, is_spatial, numeric};
use crate::knobs::knob::{KnobSpec, Number, Values};
use crate::knobs::split::field;
use toile_core::{Node, ParamDoc, Registry, Role};
use toile_pipeline::Pipeline;

/// Factors around the pipeline's own edge length: from rough to four times the triangles.
const EDGES: [f64; 2] = [0.5, 3.0];
/// Factors around the parts of a finer mesh.
const PARTS: [f64; 2] = [0.5, 2.0];
/// Factors around any other resolution.
const OTHERS: [f64; 2] = [0.1, 10.0];

/// Knobs for a pipeline: edge length, choice of mesher and solver, and what ends the solver.
pub fn default_knobs(pipeline: &Pipeline, registry: &Registry) -> Vec<KnobSpec> {
    let mut knobs = Vec::new();
    if let Some(refiner) = pipeline.nodes.iter().rfind(|n| n.card.role == Role::Placement && is_turned(n)) {
        let last = pipeline.nodes.iter().rfind(|n| n.card.role == Role::Draper);
        return std::iter::once(refiner).chain(last).flat_map(|n| ends(n, PARTS)).collect();
    }
    if let Some(mesher) = only(pipeline, Role::Mesher) {
        let edge = mesher.card.params.iter().find(|p| p.trades && is_spatial(p));
        knobs.extend(edge.and_then(|p| range(mesher, "mesher", p.name, EDGES)));
        knobs.extend(choice(mesher, "mesher", registry));
    }
    if let Some(solver) = only(pipeline, Role::Draper) {
        knobs.extend(choice(solver, "solver", registry));
        knobs.extend(ends(solver, OTHERS));
    }
    knobs
}

/// Whether a stage has a resolution that trades time for accuracy.
fn is_turned(node: &Node) -> bool {
    node.card.params.iter().any(|p| p.trades && p.finer.is_some())
}

/// The resolutions of a stage, by factors around its own; whole numbers by fewer.
fn ends(node: &Node, factors: [f64; 2]) -> Vec<KnobSpec> {
    let ends = node.card.params.iter().filter(|p| p.trades && p.finer.is_some());
    let of =
        |p: &ParamDoc| if matches!(NumberForm::of(p), Some(NumberForm::Whole)) { factors } else { OTHERS };
    ends.filter_map(|p| range(node, &node.id, p.name, of(p))).collect()
}

/// The only stage of a role.
fn only(pipeline: &Pipeline, role: Role) -> Option<&Node> {
    let mut nodes = pipeline.nodes.iter().filter(|n| n.card.role == role);
    nodes.next().filter(|_| nodes.next().is_none())
}

fn choice(node: &Node, key: &str, registry: &Registry) -> Option<KnobSpec> {
    let others = registry.of_role(node.card.role).map(|c| c.name).filter(|n| *n != node.card.name);
    let names: Vec<String> = std::iter::once(node.card.name).chain(others).map(str::to_owned).collect();
    (names.len() > 1).then(|| KnobSpec { owner: key.to_owned(), param: None, values: Values::List(names) })
}

/// A range around a parameter's own value, within what it takes.
fn range(node: &Node, owner: &str, param: &str, factors: [f64; 2]) -> Option<KnobSpec> {
    let doc = node.card.params.iter().find(|p| p.name == param)?;
    let own = numeric(field(&node.stage.params(), param)?)?;
    let number = |x: f64| match NumberForm::of(doc)? {
        NumberForm::Length => Some(Number::Length(x)),
        NumberForm::Whole => Some(Number::Plain(x.round())),
        NumberForm::Real => Some(Number::Plain(x)),
    };
    let bound =
        |factor: f64| number((own * factor).clamp(doc.min.unwrap_or(f64::MIN), doc.max.unwrap_or(f64::MAX)));
    let (lo, hi) = (bound(factors[0])?, bound(factors[1])?);
    let values = Values::Range(lo, hi);
    (lo.value() < hi.value()).then(|| KnobSpec {
        owner: owner.to_owned(),
        param: Some(param.to_owned()),
        values,
    })
}

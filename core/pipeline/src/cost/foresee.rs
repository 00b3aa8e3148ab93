//! Sizes along a pipeline, before anything of it runs.

use super::{Size, rules};
use crate::load::Pipeline;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use toile_core::{Cancel, Context, Feed, Node};

/// What a stage will be given and will make.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Foreseen {
    /// All its inputs together.
    pub given: Size,
    /// All its outputs together.
    pub made: Size,
}

/// Walks the pipeline and says the sizes at every stage. `known` may know better what a stage makes
/// of such an input, from an earlier run; it is given the stage's index.
///
/// It reads what stages say that they must look at: the headers of photos.
pub fn foresee(pipeline: &Pipeline, known: &dyn Fn(usize, &Size) -> Option<Size>) -> Vec<Foreseen> {
    let mut all: Vec<Foreseen> = Vec::new();
    for (index, node) in pipeline.nodes.iter().enumerate() {
        let given = given(node, &all.iter().map(|f| &f.made).collect::<Vec<_>>());
        let rule = own(pipeline, node, &given).unwrap_or_else(|| rules::usual(node, &given));
        let made = match known(index, &rule) {
            Some(known) => rule.corrected(&known),
            None => rule,
        };
        all.push(Foreseen { given, made });
    }
    all
}

/// What a stage is given, by what the stages before it made.
pub fn given(node: &Node, made: &[&Size]) -> Size {
    let fed = |feed: &Feed| match feed {
        Feed::Nothing => Size::new(),
        Feed::RunLog => made.iter().fold(Size::new(), |all, m| all.joined(m)),
        Feed::Node { node, .. } => made.get(*node).map_or_else(Size::new, |m| (*m).clone()),
    };
    node.inputs.iter().fold(Size::new(), |all, feed| all.joined(&fed(feed)))
}

/// What the stage itself says; one that panics says nothing.
fn own(pipeline: &Pipeline, node: &Node, given: &Size) -> Option<Size> {
    let cx = Context::new(&node.id, &pipeline.base, Cancel::new(), Arc::new(()));
    catch_unwind(AssertUnwindSafe(|| node.stage.sizes(given, &cx))).ok().flatten()
}

//! How stages and kinds of garments are named in the records.

use toile_core::Node;
use toile_core::Role;
use toile_core::artifact::Digester;
use toile_core::cost::Size;
use toile_pipeline::Pipeline;

/// Names what a stage is to be given, for finding what it made of the same before.
pub(super) fn key(node: &Node, foreseen: &Size) -> String {
    let mut d = Digester::new();
    d.text("toile size").text(node.card.name).count(node.card.version as usize).text(&node.stage.params());
    foreseen.iter().for_each(|(quantity, amount)| {
        // Text does not bring the last bit of a number back.
        d.text(&format!("{quantity:?} {amount:.6e}"));
    });
    d.finish().short()
}

/// The kind of garment that a pipeline makes: the name of its first style, which names the edges;
/// empty without one.
pub(super) fn style(pipeline: &Pipeline) -> String {
    let style = pipeline.nodes.iter().find(|n| n.card.role == Role::Style);
    style.map_or_else(String::new, |n| n.card.name.to_owned())
}

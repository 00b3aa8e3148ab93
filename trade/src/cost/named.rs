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

/// The kind of garment that a pipeline makes: what its first style, which names the edges, is told
/// that it is, `style: Vest`, else the name of that stage; empty without one.
pub(super) fn style(pipeline: &Pipeline) -> String {
    let Some(node) = pipeline.nodes.iter().find(|n| n.card.role == Role::Style) else { return String::new() };
    let params = node.stage.params();
    let told = params.split(['(', ',', ')']).find_map(|p| p.trim().strip_prefix("style: "));
    told.unwrap_or(node.card.name).to_owned()
}

//! Which work of a stage it is that takes so long.

use toile_core::Node;
use toile_pipeline::fields_of;

/// The stage's name, and what of its parameters makes it do other work than by default:
/// `StaticEquilibrium(from_here: true)`.
pub(super) fn work(node: &Node) -> String {
    let fields = fields_of(&node.stage.params());
    let other = node.card.params.iter().filter(|p| p.way).filter_map(|p| {
        let value = fields.get(p.name)?;
        (*value != p.default).then(|| format!("{}: {value}", p.name))
    });
    let other: Vec<String> = other.collect();
    if other.is_empty() {
        node.card.name.to_owned()
    } else {
        format!("{}({})", node.card.name, other.join(", "))
    }
}

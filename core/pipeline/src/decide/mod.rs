//! What a run leaves out, simplifies or adds because of what the scene is: the decisions of its
//! stages ([`toile_core::decide`]) and the runner's own, `unasked`.

mod gather;
#[cfg(test)]
mod tests;
mod unasked;

pub use gather::{StageDecision, decisions};
pub use toile_core::decide::*;

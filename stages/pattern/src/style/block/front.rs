//! A front in one piece, or in two halves that are closed along the middle.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::flat::{Flat, Run, Side, straight};
use crate::style::block::template::form::Form;
use crate::style::block::template::piece_role::{Layer, PieceRole};
use toile_core::prelude::*;

/// How the front is cut.
#[choice]
#[derive(Copy, Eq)]
pub(crate) enum Front {
    /// In one piece.
    Whole,
    /// In two halves, closed along the middle edge to edge: shirts, blouses and jackets that are
    /// buttoned or zipped.
    Halves,
}

impl Front {
    /// Refuses what has no front to open.
    pub(super) fn check(self, form: &Form) -> Result<(), StageError> {
        let has_front = form.ends_at(EdgeRole::Neck) && !form.begins_at_fork();
        if self == Front::Whole || has_front {
            return Ok(());
        }
        let text = format!("only a top or a dress is cut in halves in front, and this is {}", form.word);
        Err(StageError::invalid(text).hint("take `front` out").at("front"))
    }
}

/// One half of the front: hem, the edges up to the neck, the neck, and the middle down to the hem.
pub(super) fn half(side: &Side, trunk: &[(EdgeRole, Run)], form: &Form) -> Flat {
    let (hem, neck) = (side.edges[0].1, side.edges[form.edges.len() - 1].1);
    let middle: Curve = straight(neck.0[3], hem.0[0]);
    let mut edges = vec![(EdgeRole::Hem, Run::Cubic(hem))];
    edges.extend(trunk.iter().cloned());
    edges.extend([(EdgeRole::Neck, Run::Cubic(neck)), (EdgeRole::Middle, Run::Cubic(middle))]);
    Flat::of_trunk(PieceRole::Half(Layer::Front, side.hand), side.own(&edges))
}

//! The tool that makes both legs of a dart equally long on its base line.

use super::super::plane::{angle, lines};
use super::super::source::number;
use super::drafting::{DraftTool, Drafting};
use super::values::Failed;
use kurbo::Affine;

/// Closes the dart, draws the base line straight across it, and opens it again.
pub(super) fn true_darts(d: &mut Drafting, tool: &DraftTool<'_, '_>) -> Result<(), Failed> {
    let (base1, base2) = (d.point(tool, "baseLineP1")?, d.point(tool, "baseLineP2")?);
    let (leg1, tip, leg2) = (d.point(tool, "dartP1")?, d.point(tool, "dartP2")?, d.point(tool, "dartP3")?);
    let opening = angle(leg1 - tip) - angle(leg2 - tip);
    let closed = Affine::rotate_about(opening.to_radians(), tip) * base2;
    let first = lines(base1, closed - base1, tip, leg1 - tip)
        .ok_or_else(|| d.impossible(tool, "its base line does not meet the dart"))?;
    let second = Affine::rotate_about(-opening.to_radians(), tip) * first;
    d.put_point(number(tool.node, "point1"), tool.name("name1"), first);
    d.put_point(number(tool.node, "point2"), tool.name("name2"), second);
    Ok(())
}

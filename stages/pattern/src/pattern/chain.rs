//! Open lines chained to a loop.

use super::side::Side;
use toile_core::Remarks;
use toile_core::prelude::*;

/// Gaps of up to this are no gaps, metres.
pub(super) const JOINT: f64 = 2e-4;
/// Gaps of up to this are closed, with a warning, metres.
pub(super) const HAIR: f64 = 5e-3;

/// Where a chain of lines is open, and how far, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gap {
    pub at: Point2,
    pub wide: f64,
}

/// The lines as a loop, beginning with the first, each followed by the one that is nearest to its
/// end.
///
/// Errors: the first gap that is too wide to close; a gap of no width for a single open line.
pub(super) fn chained(mut rest: Vec<Side>, piece: &str, told: &mut Remarks) -> Result<Vec<Side>, Gap> {
    let mut sides = vec![rest.remove(0)];
    while !rest.is_empty() {
        let here = sides[sides.len() - 1].end();
        let gap = |s: &Side| (here - s.start).norm().min((here - s.end()).norm());
        let next = (0..rest.len()).min_by(|&i, &j| gap(&rest[i]).total_cmp(&gap(&rest[j]))).unwrap_or(0);
        let side = rest.remove(next);
        let backwards = (here - side.start).norm() > (here - side.end()).norm();
        sides.push(if backwards { side.turned() } else { side });
    }
    close(&mut sides, piece, told)?;
    Ok(sides)
}

/// Lets each side begin where the one before ends.
fn close(sides: &mut [Side], piece: &str, told: &mut Remarks) -> Result<(), Gap> {
    let n = sides.len();
    for k in 0..n {
        let end = sides[k].end();
        let next = (k + 1) % n;
        let gap = (end - sides[next].start).norm();
        if gap > HAIR || (n == 1 && gap > JOINT) {
            return Err(Gap { at: end, wide: gap });
        }
        if gap > JOINT {
            told.warnings.push(format!(
                "the boundary of piece \"{piece}\" was open by {:.2} mm between \"{}\" and \"{}\": closed",
                gap * 1e3,
                sides[k].name,
                sides[next].name
            ));
        }
        sides[next].start = end;
    }
    Ok(())
}

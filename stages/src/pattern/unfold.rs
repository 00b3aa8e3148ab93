//! Half pieces unfolded at the line where their middle lies on a fold of the cloth.

use super::side::{CORNER, Side, smooth};
use toile_core::prelude::*;

/// An edge lies on the line to this, metres.
const ON: f64 = 1e-3;

/// The line at which a half piece is mirrored, through two points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fold {
    pub at: Point2,
    pub way: Vector2,
}

impl Fold {
    /// None where the points are one.
    pub(super) fn through(a: Point2, b: Point2) -> Option<Self> {
        Some(Fold { at: a, way: (b - a).try_normalize(1e-9)? })
    }

    fn foot(&self, p: Point2) -> Point2 {
        self.at + self.way * (p - self.at).dot(&self.way)
    }

    /// The image of a point.
    pub(super) fn mirror(&self, p: Point2) -> Point2 {
        let foot = self.foot(p);
        foot + (foot - p)
    }

    pub(super) fn has(&self, p: Point2) -> bool {
        (p - self.foot(p)).norm() <= ON
    }

    /// The whole loop of a half one of which an edge lies on the line; an edge that runs smoothly into its image becomes one with it.
    /// None where no edge lies on the line.
    pub(super) fn unfolded(&self, sides: &[Side]) -> Option<Vec<Side>> {
        let fold = sides.iter().position(|s| s.points().iter().all(|p| self.has(*p)))?;
        let (n, m) = (sides.len(), sides.len() - 1);
        let mut half: Vec<Side> = (1..n).map(|k| sides[(fold + k) % n].clone()).collect();
        // Its ends to the last bit on the line, so that the images meet them.
        if let Some(s) = half.first_mut() {
            s.start = self.foot(s.start);
        }
        if let Some(s) = half.last_mut() {
            s.end_at(self.foot(s.end()));
        }
        let image =
            |s: &Side| Side { name: format!("{}_m", s.name), ..s.moved(|p| self.mirror(p), true).turned() };
        let whole: Vec<Side> = half.iter().cloned().chain(half.iter().rev().map(image)).collect();
        // The last side of the half meets its image, and the first one's image the first.
        let goes_on = |one: &Side, other: &Side| smooth(one, other, 2.0 * CORNER);
        let (middle, around) =
            (goes_on(whole.get(m - 1)?, whole.get(m)?), goes_on(whole.last()?, whole.first()?));
        let mut out: Vec<Side> = Vec::new();
        for (k, side) in whole.iter().enumerate() {
            match k {
                _ if k == m && middle => {
                    let before = out.pop()?;
                    out.push(before.joined(side));
                }
                _ if k == 2 * m - 1 && around && out.len() > 1 => {
                    out[0] = Side { name: out[0].name.clone(), ..side.joined(&out[0]) }
                }
                _ => out.push(side.clone()),
            }
        }
        (out.len() >= 2).then_some(out)
    }
}

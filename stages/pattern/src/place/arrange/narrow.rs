//! Cloth around an arm beside the arm's own girth.
//!
//! Method: the girth of a tube of two pieces is that of its shortest loop: straight across one
//! piece from a place on one seam to a place on the other seam, and back across the other piece.
//! The arm's girth is that of a tape around its skin at the same distance from the shoulder (ISO
//! 8559-1: a tape spans hollows). Since a sleeve slides along the arm, the arm's least girth within
//! [`SLIDES`] counts. Cost: a pass over the body's triangles each centimetre of the arm. Limits: an
//! arm is taken to be straight from the shoulder to the wrist; tubes of more than two pieces are
//! not measured.

use super::limb::Limb;
use toile_body::slice;
use toile_core::prelude::*;

/// A sleeve slides along the arm by so much, metres.
const SLIDES: f64 = 0.04;
/// No arm is thicker, metres around.
const THICKEST: f64 = 0.7;
/// Steps along the arm, metres.
const STEP: f64 = 0.01;

/// A place on a seam of a tube of two pieces: its points on both sides of the seam, in the plane of
/// the cloth, metres, and its distance along the arm.
#[derive(Debug, Clone, Copy)]
pub(super) struct TubePlace {
    pub(super) cloth: [Point2; 2],
    pub(super) along: f64,
}

/// A loop around a tube.
#[derive(Debug, Clone, Copy)]
pub(super) struct TubeLoop {
    /// Its length on the cloth, metres.
    pub(super) girth: f64,
    /// Its distance along the arm, metres.
    pub(super) along: f64,
}

/// Where cloth is narrowest beside the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Narrow {
    /// Girth of the cloth, metres.
    pub(super) cloth: f64,
    /// Girth of the arm, metres.
    pub(super) arm: f64,
}

impl Narrow {
    /// By which share the arm stretches the cloth.
    pub(super) fn stretch(&self) -> f64 {
        self.arm / self.cloth.max(1e-9) - 1.0
    }
}

/// The girths of an arm along it.
pub(super) struct ArmGirths {
    /// Every [`STEP`] from the root on; none where no loop goes around the arm alone.
    girths: Vec<Option<f64>>,
}

impl ArmGirths {
    pub(super) fn of(limb: &Limb, body: &Body) -> Self {
        // The arm's axis becomes the upright one.
        let turned = |p: &Point3| {
            let q = p - limb.root;
            Point3::new(q.dot(&limb.front), q.dot(&limb.axis), q.dot(&limb.up))
        };
        let skin: Vec<Point3> = body.positions.iter().map(turned).collect();
        let end = limb.length;
        let steps = (end / STEP).floor().max(0.0) as usize;
        let girth = |k: usize| {
            let loops = slice(&skin, &body.triangles, k as f64 * STEP);
            let around = loops.iter().filter(|l| l.holds(Point2::origin()));
            // At its root the arm goes over into the trunk.
            around.map(|l| l.girth).filter(|girth| *girth < THICKEST).min_by(f64::total_cmp)
        };
        ArmGirths { girths: (0..=steps).map(girth).collect() }
    }

    /// The least girth that is near a distance from the root; none beyond the wrist.
    fn least(&self, along: f64) -> Option<f64> {
        let index = |s: f64| (s / STEP).round().max(0.0) as usize;
        let (from, to) = (index(along - SLIDES), index(along + SLIDES));
        let near = self.girths.get(from..=to.min(self.girths.len().saturating_sub(1)))?;
        near.iter().copied().flatten().min_by(f64::total_cmp)
    }
}

/// The shortest loop through each place of one seam of a tube of two pieces, whose places have
/// their point on the first piece first.
pub(super) fn loops([one, other]: &[Vec<TubePlace>; 2]) -> Vec<TubeLoop> {
    let shortest = |a: &TubePlace| {
        let around = |b: &TubePlace| TubeLoop {
            girth: (0..2).map(|k| (b.cloth[k] - a.cloth[k]).norm()).sum(),
            along: f64::midpoint(a.along, b.along),
        };
        other.iter().map(around).min_by(|x, y| x.girth.total_cmp(&y.girth))
    };
    one.iter().filter_map(shortest).collect()
}

/// Where a tube is narrowest beside the arm.
pub(super) fn narrowest(girths: &ArmGirths, loops: &[TubeLoop]) -> Option<Narrow> {
    let beside = |l: &TubeLoop| Some(Narrow { cloth: l.girth, arm: girths.least(l.along)? });
    loops.iter().filter_map(beside).max_by(|a, b| a.stretch().total_cmp(&b.stretch()))
}

/// Refuses what the arm would tear: cloth that it stretches by more than `most`, a share.
pub(super) fn refuse(names: &str, narrow: &Narrow, most: f64, stage: &str) -> Result<(), StageError> {
    if narrow.stretch() <= most {
        return Ok(());
    }
    let [cloth, arm] = [narrow.cloth, narrow.arm].map(|x| x * 1e2);
    let what = format!(
        "{names}: {cloth:.1} cm of cloth for {arm:.1} cm of arm, which would stretch it by {:.0} %",
        narrow.stretch() * 1e2
    );
    Err(StageError::new(ErrorCode::PatternLoading, what).hint(format!(
        "take the body that the pattern was drafted for, or cut it {:.0} cm wider; a cloth that stretches so far: \
         --set 'stages.{stage}.max_tight={:.2}'",
        (arm / (1.0 + most) - cloth).ceil().max(1.0),
        (narrow.stretch() * 100.0).ceil() / 100.0
    )))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A tube of two pieces of that width and length whose seams run along the arm.
    fn tube(width: f64, from: f64, to: f64) -> [Vec<TubePlace>; 2] {
        let seam = |x: f64| {
            let at = |k: usize| {
                let along = from + (to - from) * k as f64 / 10.0;
                TubePlace { cloth: [Point2::new(x, along), Point2::new(-x, along)], along }
            };
            (0..=10).map(at).collect()
        };
        [seam(0.0), seam(width)]
    }

    /// An arm of 60 cm that tapers from 30 cm around to 18 cm.
    fn arm() -> ArmGirths {
        ArmGirths { girths: (0..=60).map(|k| Some(0.30 - 0.002 * f64::from(k))).collect() }
    }

    #[test]
    fn a_cuff_is_held_against_the_arm_where_it_may_slide_to() {
        // At 20 cm along, the arm is 26 cm around; 4 cm farther, where the cuff may slide, 25.2 cm.
        let found = narrowest(&arm(), &loops(&tube(0.08, 0.20, 0.25))).unwrap();
        assert!((found.cloth - 0.16).abs() < 1e-12 && (found.arm - 0.252).abs() < 1e-12, "{found:?}");
        let error = refuse("cuff_f, cuff_b", &found, 0.25, "Arrange").unwrap_err();
        assert_eq!(
            error.to_string(),
            "cuff_f, cuff_b: 16.0 cm of cloth for 25.2 cm of arm, which would stretch it by 57 %"
        );
        assert!(refuse("cuff_f, cuff_b", &found, 0.58, "Arrange").is_ok());
    }

    #[test]
    fn what_is_as_wide_as_the_arm_is_let_through_and_so_is_what_hangs_over_the_hand() {
        let wide = narrowest(&arm(), &loops(&tube(0.13, 0.20, 0.25))).unwrap();
        assert!(wide.stretch() < 0.0 && refuse("cuff", &wide, 0.0, "Arrange").is_ok());
        assert_eq!(narrowest(&arm(), &loops(&tube(0.08, 0.66, 0.70))), None);
    }
}

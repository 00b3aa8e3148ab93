//! A long sleeve as it is cut, from one as it lies.
//!
//! A sleeve lies bent, and folded at the armpit where it hangs beside the body; a cut one is
//! straight. Its fold along the top, between front and back, is a straight line, and the cuff
//! stands upright on it. It is as wide at the armpit as it is widest below, since what lies folded
//! there is no narrower, and its cap is as long as the armhole: of a set-in sleeve the cap is a
//! quarter to three fifths as high as the armhole is long (Aldrich 2008). It is as long as it lies
//! along its middle. Limits: a sleeve of two pieces, which is cut bent, is straightened.

use crate::style::block::template::curve::Curve;
use crate::style::block::template::flat::{PARTS, straight};
use nalgebra::Rotation2;
use std::f64::consts::FRAC_PI_2;
use toile_core::artifact::{Point2, Vector2};

/// Width at the armpit, as a share of the armhole's chord: a cap of three fifths, and of a quarter.
const WIDE: [f64; 2] = [0.8, 0.97];
/// A short sleeve that is narrower at the armpit hangs beside the body, and lies folded there.
const LEAST_SHORT: f64 = 0.55;

/// A sleeve's curves, from the armpit counter-clockwise up to the shoulder point; its cap closes
/// it.
pub(super) struct SleeveShape {
    pub underarm: Curve,
    pub cuff: Curve,
    pub top: Vec<Curve>,
}

impl SleeveShape {
    /// The armpit and the shoulder point.
    pub(super) fn ends(&self) -> Option<[Point2; 2]> {
        Some([self.underarm.0[0], self.top.last()?.0[3]])
    }

    /// How long its top is.
    pub(super) fn top_length(&self) -> f64 {
        self.top.iter().map(Curve::length).sum()
    }

    /// Whether its underarm seam is shorter than its armhole.
    pub(super) fn is_short(&self) -> bool {
        self.ends().is_some_and(|[armpit, shoulder]| self.underarm.length() < (shoulder - armpit).norm())
    }

    /// The sleeve straightened, as it stands off with its cap along the armhole; a short one as it
    /// lies, where it stands off. None where it has no length.
    pub(super) fn straightened(self) -> Option<Self> {
        let [armpit, shoulder] = self.ends()?;
        let cap = (shoulder - armpit).norm();
        let lengths = [self.underarm.length(), self.top_length()];
        if self.is_short() && self.widest() >= LEAST_SHORT * cap {
            return Some(self.even());
        }
        let cuff = self.cuff.length();
        let wide = self.widest().clamp(WIDE[0] * cap, WIDE[1] * cap);
        let high = (cap * cap - wide * wide).max(0.0).sqrt();
        let long = 0.5 * (lengths[0] + lengths[1] + high);
        // Its cap lies along the armhole.
        let down = Rotation2::new(wide.atan2(high)) * (armpit - shoulder).try_normalize(1e-9)?;
        let across = Rotation2::new(FRAC_PI_2) * down;
        let at = |along: f64, inwards: f64| shoulder + down * along - across * inwards;
        let [armpit, inner, outer] = [at(high, wide), at(long, cuff), at(long, 0.0)];
        Some(SleeveShape {
            underarm: straight(armpit, inner),
            cuff: straight(inner, outer),
            top: vec![straight(outer, shoulder)],
        })
    }

    /// The sleeve with an underarm seam that is no longer than its top: a short sleeve that hangs
    /// lies folded along its top.
    fn even(self) -> Self {
        let [under, top] = [self.underarm.length(), self.top_length()];
        if under <= top {
            return self;
        }
        let [underarm, _] = self.underarm.parted(top / under);
        SleeveShape { underarm, cuff: straight(underarm.0[3], self.cuff.0[3]), top: self.top }
    }

    /// From the middle of the cap to that of the cuff.
    pub(super) fn way(&self) -> Option<Vector2> {
        let [armpit, shoulder] = self.ends()?;
        Some(nalgebra::center(&self.cuff.0[0], &self.cuff.0[3]) - nalgebra::center(&armpit, &shoulder))
    }

    /// How far the underarm lies from the top at most.
    fn widest(&self) -> f64 {
        let top: Vec<Point2> = self.top.iter().flat_map(|c| c.points(PARTS)).collect();
        let nearest = |p: Point2| top.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        self.underarm.points(PARTS).into_iter().map(nearest).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A sleeve through these places: armpit, cuff within and without, shoulder point.
    fn sleeve(places: [[f64; 2]; 4]) -> SleeveShape {
        let [armpit, inner, outer, shoulder] = places.map(|[x, y]| Point2::new(x, y));
        SleeveShape {
            underarm: straight(armpit, inner),
            cuff: straight(inner, outer),
            top: vec![straight(outer, shoulder)],
        }
    }

    fn right_angle(s: &SleeveShape) -> f64 {
        let top = s.top[0].0[3] - s.top[0].0[0];
        (s.cuff.0[3] - s.cuff.0[0]).normalize().dot(&top.normalize())
    }

    #[test]
    fn a_sleeve_that_hangs_is_as_wide_at_the_armpit_as_a_cap_lets_it_be() {
        // Straight down, 20 cm of armhole, 12 cm wide.
        let cut = sleeve([[0.25, 0.4], [0.27, -0.05], [0.37, -0.05], [0.3, 0.6]]).straightened().unwrap();
        let [armpit, shoulder] = cut.ends().unwrap();
        let cap = (Point2::new(0.25, 0.4) - Point2::new(0.3, 0.6)).norm();
        assert!(((shoulder - armpit).norm() - cap).abs() < 1e-12);
        assert!((armpit - Point2::new(0.25, 0.4)).norm() < 1e-12, "its cap lies along the armhole");
        assert!(cut.way().unwrap().x > 0.2, "it stands off");
        assert!(right_angle(&cut).abs() < 1e-12);
        assert!((cut.cuff.length() - 0.1).abs() < 1e-12);
        assert!(cut.underarm.length() > 0.45 && cut.top[0].length() > 0.55);
    }

    #[test]
    fn a_sleeve_that_is_cut_straight_stays_as_it_is() {
        // Along x; cap 12 cm high and 16 cm wide.
        let places = [[0.12, -0.16], [0.6, -0.1], [0.6, 0.0], [0.0, 0.0]];
        let cut = sleeve(places).straightened().unwrap();
        let [before, after] = [sleeve(places), cut].map(|s| [s.underarm.length(), s.top[0].length()]);
        assert!((before[0] - after[0]).abs() < 0.01 && (before[1] - after[1]).abs() < 0.01, "{after:?}");
    }

    #[test]
    fn a_short_sleeve_is_cut_as_it_lies() {
        let places = [[0.25, 0.4], [0.36, 0.36], [0.44, 0.5], [0.23, 0.64]];
        let [before, after] = [sleeve(places), sleeve(places).straightened().unwrap()];
        assert_eq!((before.underarm, before.cuff), (after.underarm, after.cuff));
    }

    #[test]
    fn a_short_sleeve_is_no_longer_under_the_arm_than_along_its_top() {
        let cut = sleeve([[0.2, 0.4], [0.2, 0.31], [0.33, 0.36], [0.31, 0.39]]).straightened().unwrap();
        assert!((cut.underarm.length() - cut.top_length()).abs() < 1e-9);
        assert_eq!(cut.cuff.0[3], Point2::new(0.33, 0.36));
    }

    #[test]
    fn a_short_sleeve_that_hangs_beside_the_body_is_cut_as_wide_as_a_cap_lets_it_be() {
        let hangs = sleeve([[0.25, 0.44], [0.26, 0.4], [0.34, 0.41], [0.26, 0.64]]);
        assert!(hangs.widest() < 0.1);
        let cut = hangs.straightened().unwrap();
        let [armpit, shoulder] = cut.ends().unwrap();
        let cap = (shoulder - armpit).norm();
        assert!(cut.widest() > 0.75 * cap && cut.way().unwrap().x > 0.05);
    }
}

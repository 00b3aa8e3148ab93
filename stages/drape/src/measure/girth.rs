//! Ease: the cloth around the body beside the body, at bust, waist and hip.
//!
//! The draped garment is sliced where the body was measured, and the slice is measured on the flat
//! panels: what a tape would read along the cloth, folds and gathers spread out. At the waist that
//! is the narrowest place within 2 cm. Where sleeves join the trunk only below a level, it is
//! measured below their armpits. Cost: one pass over the triangles a height. Limits: a garment that
//! is open there has no girth; cloth that hangs askew reads a little long.

use std::collections::BTreeMap;
use toile_core::artifact::{Garment, GirthFigures};
use toile_core::prelude::*;

/// Levels at which the body is measured.
const LEVELS: [&str; 3] = ["bust", "waist", "hip"];
/// Where an armhole opens the garment at a level, or a sleeve leaves it, its girth is taken lower
/// by fewer steps than this.
const STEPS_DOWN: u32 = 20;
/// Height of a step, metres.
const STEP: f64 = 0.005;
/// A waist seam is not always at the body's waist: the narrowest of this many steps above and below
/// counts.
const WAIST: u32 = 4;
/// Cloth narrower than the body by more than this share gives a warning; a tape on a mesh of 16 mm
/// is no more exact.
const NARROW: f64 = 0.02;
/// Cloth around the bust of more than this many times the body's girth gives a warning: no coat has
/// more.
const WIDE: f64 = 1.6;

/// The girths of a garment where it closes around its body, by level.
pub fn girths(garment: &Garment, body: &Body) -> BTreeMap<String, GirthFigures> {
    let of = |level: &str| {
        let mark = |side: &str| body.landmarks.get(&format!("{level}_{side}"));
        let (front, back) = (mark("front")?, mark("back")?);
        let middle = Point2::new((front.x + back.x) / 2.0, (front.z + back.z) / 2.0);
        let body_m = *body.measurements.get(level)?;
        // What begins near the waist has no bust, however short the body is.
        let waist = body.landmarks.get("waist_front").filter(|_| level == "bust");
        let least = waist.map_or(f64::NEG_INFINITY, |waist| f64::midpoint(front.y, waist.y));
        let at = |y: f64| around(garment, y, middle, &arms(body, y));
        let below = |k: u32| at(front.y - f64::from(k) * STEP);
        let narrowest = || {
            let above = (1..=WAIST).filter_map(|k| at(front.y + f64::from(k) * STEP));
            above.chain((0..=WAIST).filter_map(below)).reduce(f64::min)
        };
        let cloth_m = match level {
            "waist" => narrowest(),
            _ => (0..STEPS_DOWN).filter(|k| front.y - f64::from(*k) * STEP >= least).filter_map(below).next(),
        }?;
        Some((level.to_owned(), GirthFigures { cloth_m, body_m }))
    };
    LEVELS.iter().filter_map(|level| of(level)).collect()
}

/// Warns of a garment that is too small or too large for its body.
pub(super) fn tell(girths: &BTreeMap<String, GirthFigures>, cx: &Context) {
    for (level, g) in girths {
        let cm = |m: f64| (m * 100.0).round();
        let what = format!(
            "around the {level} there are {} cm of cloth for {} cm of body",
            cm(g.cloth_m),
            cm(g.body_m)
        );
        if g.cloth_m < (1.0 - NARROW) * g.body_m {
            cx.warn(format!("{what}: the garment is too small for this body, or its cloth must stretch"));
        } else if level == "bust" && g.cloth_m > WIDE * g.body_m {
            cx.warn(format!("{what}: is the scale right, and is it this body's garment?"));
        }
    }
}

/// A triangle in a slice: the two mesh edges that it crosses, by their welded vertices, where, and
/// the flat length between.
struct SlicedTriangle {
    edges: [[u32; 2]; 2],
    points: [Point2; 2],
    flat: f64,
}

/// Where the arms' axes pass a height, (x, z).
fn arms(body: &Body, y: f64) -> Vec<Point2> {
    let crossing = |(hand, from, to): (Hand, &str, &str)| {
        let (a, b) = (body.landmark(from, hand)?, body.landmark(to, hand)?);
        let share = (y - a.y) / (b.y - a.y);
        let p = a + (b - a) * share;
        (0.0..=1.0).contains(&share).then(|| Point2::new(p.x, p.z))
    };
    let bones = |hand| [(hand, "shoulder", "elbow"), (hand, "elbow", "wrist")];
    Hand::BOTH.into_iter().flat_map(bones).filter_map(crossing).collect()
}

/// The flat length of the shortest closed loop of the slice at height `y` that goes around `middle`
/// (x, z) and around none of the `arms`.
pub fn around(garment: &Garment, y: f64, middle: Point2, arms: &[Point2]) -> Option<f64> {
    let cuts: Vec<SlicedTriangle> = garment.triangles.iter().filter_map(|t| cut(garment, *t, y)).collect();
    let mut at: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (k, c) in cuts.iter().enumerate() {
        c.edges.iter().for_each(|e| at.entry(*e).or_default().push(k));
    }
    let mut seen = vec![false; cuts.len()];
    let mut best: Option<f64> = None;
    for first in 0..cuts.len() {
        if !seen[first]
            && let Some(ring) = walk(&cuts, &at, first, &mut seen)
            && goes_around(&cuts, &ring, middle)
            && !arms.iter().any(|arm| goes_around(&cuts, &ring, *arm))
        {
            let length = ring.iter().map(|r| cuts[r.0].flat).sum::<f64>();
            best = Some(best.map_or(length, |b| b.min(length)));
        }
    }
    best
}

/// Follows a loop from a cut on: its cuts, each with the end where the loop comes in; `None` where
/// it does not close or branches.
fn walk(
    cuts: &[SlicedTriangle],
    at: &BTreeMap<[u32; 2], Vec<usize>>,
    first: usize,
    seen: &mut [bool],
) -> Option<Vec<(usize, usize)>> {
    let mut ring = Vec::new();
    let (mut k, mut enter) = (first, 0);
    loop {
        seen[k] = true;
        ring.push((k, enter));
        let edge = cuts[k].edges[1 - enter];
        let [a, b] = at.get(&edge)?[..] else { return None };
        let next = if a == k { b } else { a };
        if next == first {
            return (edge == cuts[first].edges[0]).then_some(ring);
        }
        if seen[next] {
            return None;
        }
        enter = usize::from(cuts[next].edges[0] != edge);
        k = next;
    }
}

/// Whether a loop winds around a place.
fn goes_around(cuts: &[SlicedTriangle], ring: &[(usize, usize)], place: Point2) -> bool {
    let turn = |&(k, enter): &(usize, usize)| {
        let (from, to) = (cuts[k].points[enter] - place, cuts[k].points[1 - enter] - place);
        (from.x * to.y - from.y * to.x).atan2(from.dot(&to))
    };
    ring.iter().map(turn).sum::<f64>().abs() > std::f64::consts::PI
}

/// What of a triangle lies in the plane at height `y`.
fn cut(garment: &Garment, t: [u32; 3], y: f64) -> Option<SlicedTriangle> {
    let above = |v: u32| garment.positions[v as usize].y >= y;
    let sides = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let mut crossed = sides.into_iter().filter(|&(a, b)| above(a) != above(b));
    let ends = [crossed.next()?, crossed.next()?].map(|(a, b)| {
        let (p, q) = (garment.positions[a as usize], garment.positions[b as usize]);
        let share = (y - p.y) / (q.y - p.y);
        let (in_space, on_panel) = (p + (q - p) * share, {
            let (p, q) = (garment.rest[a as usize], garment.rest[b as usize]);
            p + (q - p) * share
        });
        let [a, b] = [a, b].map(|v| garment.weld[v as usize]);
        ([a.min(b), a.max(b)], Point2::new(in_space.x, in_space.z), on_panel)
    });
    let [(e, p, a), (f, q, b)] = ends;
    Some(SlicedTriangle { edges: [e, f], points: [p, q], flat: (a - b).norm() })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;
    use toile_fixtures::cloth::{ClothGrid, garment, plain};

    const COLUMNS: usize = 200;

    /// A tube of 95 cm of cloth in waves around the axis, 20 cm high, its ends sewn together if
    /// `sewn`.
    fn tube(sewn: bool) -> Garment {
        let flat = |x: f64, y: f64| Point2::new(0.95 * x, 0.2 * y);
        let grid = ClothGrid { columns: COLUMNS, rows: 4, flat, lift: |p| Point3::new(p.x, p.y, 0.0) };
        let mut tube = garment(&[("skirt", &grid)], &plain(500.0, 50.0, 1e-5));
        for p in &mut tube.positions {
            let angle = p.x / 0.95 * TAU;
            let radius = 0.14 + 0.01 * (12.0 * angle).sin();
            *p = Point3::new(radius * angle.cos(), p.y + 1.0, radius * angle.sin());
        }
        if sewn {
            (0..5).for_each(|row| tube.weld[grid.at(COLUMNS, row) as usize] = grid.at(0, row));
        }
        tube
    }

    /// A body whose bust is 10 cm above the hem of the tube, and whose hip is below it.
    fn body() -> Body {
        let mark = |y: f64, z: f64| Point3::new(0.0, y, z);
        Body {
            positions: Vec::new(),
            triangles: Vec::new(),
            landmarks: BTreeMap::from([
                ("bust_front".into(), mark(1.1, 0.12)),
                ("bust_back".into(), mark(1.1, -0.12)),
                ("hip_front".into(), mark(0.9, 0.12)),
                ("hip_back".into(), mark(0.9, -0.12)),
            ]),
            measurements: BTreeMap::from([("bust".into(), 0.88), ("hip".into(), 0.95)]),
        }
    }

    #[test]
    fn folds_are_spread_out_and_a_level_below_the_hem_has_no_girth() {
        let found = girths(&tube(true), &body());
        assert_eq!(found.keys().collect::<Vec<_>>(), ["bust"]);
        assert!((found["bust"].cloth_m - 0.95).abs() < 1e-6, "{found:?}");
        assert_eq!(found["bust"].body_m, 0.88);
    }

    #[test]
    fn a_waist_is_the_narrowest_place_within_two_centimetres() {
        let mut tube = tube(true);
        // The cloth above 1.11 m is cut narrower.
        for (p, flat) in tube.positions.iter().zip(&mut tube.rest) {
            flat.x *= if p.y > 1.12 { 0.8 } else { 1.0 };
        }
        let mut body = body();
        for side in ["front", "back"] {
            let mark = body.landmarks[&format!("bust_{side}")];
            body.landmarks.insert(format!("waist_{side}"), mark);
        }
        body.measurements.insert("waist".into(), 0.7);
        let found = girths(&tube, &body);
        // At 1.12 m, two fifths of the way from 95 to 76 cm.
        assert!((found["waist"].cloth_m - 0.874).abs() < 1e-6, "{found:?}");
        assert!((found["bust"].cloth_m - 0.95).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn an_open_garment_has_no_girth() {
        assert!(girths(&tube(false), &body()).is_empty());
    }

    #[test]
    fn cloth_beside_the_body_is_not_around_it() {
        let mut tube = tube(true);
        tube.positions.iter_mut().for_each(|p| p.x += 0.4);
        assert!(girths(&tube, &body()).is_empty());
    }

    #[test]
    fn a_loop_that_takes_the_arms_with_it_is_no_girth_of_the_trunk() {
        let mut body = body();
        body.landmarks.insert("shoulder_left".into(), Point3::new(0.10, 1.4, 0.0));
        body.landmarks.insert("elbow_left".into(), Point3::new(0.10, 1.05, 0.0));
        // Its elbow is inside the tube down to 5 cm above the hem: the girth is measured below it.
        let found = girths(&tube(true), &body);
        assert!((found["bust"].cloth_m - 0.95).abs() < 1e-6, "{found:?}");
        body.landmarks.insert("elbow_left".into(), Point3::new(0.10, 0.9, 0.0));
        assert!(girths(&tube(true), &body).is_empty());
    }

    #[test]
    fn too_small_and_too_large_are_told_in_centimetres() {
        let told = |level: &str, cloth_m: f64, body_m: f64| {
            let cx = Context::quiet();
            tell(&BTreeMap::from([(level.to_owned(), GirthFigures { cloth_m, body_m })]), &cx);
            cx.take_remarks().warnings
        };
        let small = "around the bust there are 84 cm of cloth for 96 cm of body: the garment is too small for this body, or its cloth must \
                     stretch";
        assert_eq!(told("bust", 0.84, 0.96), [small]);
        let large = "around the bust there are 160 cm of cloth for 90 cm of body: is the scale right, and is it this body's garment?";
        assert_eq!(told("bust", 1.6, 0.9), [large]);
        assert!(told("bust", 0.95, 0.96).is_empty());
        assert!(told("hip", 3.0, 0.96).is_empty());
    }
}

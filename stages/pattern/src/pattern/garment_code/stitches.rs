//! Stitches of the file as seams of the pattern: which ends meet, what is stitched twice, what runs
//! the wrong way.
//!
//! The start of the first edge meets the end of the second, both as the file gives them, unless
//! `right_wrong` stands with the stitch. A stitch certainly runs the wrong way where
//! - its edges share a vertex of their panel and would not meet there: the legs of a dart;
//! - its mirror image in the file runs the other way, and the placed edges side clearly with that;
//!   where they do not, both are refused;
//! - it has no mirror image, and its placed edges run clearly side by side where they should run
//!   against each other.
//!
//! In 55 files of GarmentCode and its forerunner none of the 1519 stitches is one of these.
//! Panels that stand inside out are turned over before (`inside_out`). Cost: stitches squared.

use super::damage::SpecificationDamage;
use super::inside_out::{inside_out, turned_over};
use super::panel::Made;
use super::read::{RawPanel, RawStitch};
use super::stitch::{Stitch, leaning, shortest};
use std::collections::BTreeMap;
use toile_core::Remarks;
use toile_core::prelude::*;

/// Edges whose directions in space agree by more than this cosine run clearly the same way.
const CLEAR: f64 = 0.5;
/// Shorter edges are placed too loosely to decide, metres.
const SHORTEST: f64 = 0.05;
/// Stitches of one panel that run the wrong way, from which on the panel itself may be turned.
const MANY: usize = 3;
/// Mirror images of edges end this near to each other, metres.
const NEAR: f64 = 0.01;

/// The seams of the stitches. Dropped and turned stitches are reported.
pub(super) fn seams(
    stitches: &[RawStitch],
    panels: &[RawPanel],
    made: &mut [Made],
    told: &mut Remarks,
) -> Result<Vec<PatternSeam>, SpecificationDamage> {
    let mut once = once(stitches, panels, told, &mut Vec::new());
    let over = inside_out(&once, made);
    for &p in &over {
        turned_over(&mut made[p]);
        told.warnings.push(format!(
            "panel \"{}\" stands inside out: it looks at the wearer, and its stitches run side by side with what they are sewn to; it is turned over where it stands",
            panels[p].name
        ));
    }
    for s in &mut once {
        let [(a, _), (b, _)] = s.raw.sides;
        s.start_to_end ^= over.contains(&a) != over.contains(&b);
    }
    let made = &*made;
    let turned: Vec<bool> = wrong_ways(&once, panels, made)?;
    unturned(&once, &turned, panels)?;
    let mut out = Vec::with_capacity(once.len());
    for (s, turn) in once.iter().zip(turned) {
        if turn {
            told.warnings.push(format!(
                "stitch {} ({}) runs the wrong way: turned",
                s.number,
                words(s.raw, panels)
            ));
        }
        out.push(seam(s.raw, s.start_to_end != turn, made));
    }
    Ok(out)
}

/// Edges that more than one stitch sews, and stitches that contradict each other.
pub(super) fn doubled(stitches: &[RawStitch], panels: &[RawPanel]) -> Vec<SpecificationDamage> {
    let mut faults = Vec::new();
    once(stitches, panels, &mut Remarks::default(), &mut faults);
    faults
}

/// Every stitch once; no edge is sewn by two, which is a fault.
fn once<'a>(
    stitches: &'a [RawStitch],
    panels: &[RawPanel],
    told: &mut Remarks,
    faults: &mut Vec<SpecificationDamage>,
) -> Vec<Stitch<'a>> {
    let mut seen: BTreeMap<[(usize, usize); 2], usize> = BTreeMap::new();
    let mut sewn: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut out: Vec<Stitch<'a>> = Vec::new();
    for raw in stitches {
        let number = raw.number;
        let mut key = raw.sides;
        key.sort_unstable();
        match seen.get(&key).map(|&i| &out[i]) {
            None => {
                for side in key {
                    if let Some(stitch) = sewn.insert(side, number) {
                        let (panel, edge) = (panels[side.0].name.clone(), side.1);
                        faults.push(SpecificationDamage::Shared { panel, edge, stitch, other: number });
                    }
                }
                seen.insert(key, out.len());
                out.push(Stitch { number, raw, start_to_end: !raw.right_wrong });
            }
            Some(first) if first.start_to_end != raw.right_wrong => told.warnings.push(format!(
                "stitch {number} ({}) is stitch {} again: left out",
                words(raw, panels),
                first.number
            )),
            Some(first) => {
                faults.push(SpecificationDamage::Contradiction { stitch: first.number, other: number })
            }
        }
    }
    out
}

fn words(s: &RawStitch, panels: &[RawPanel]) -> String {
    let side = |(panel, edge): (usize, usize)| format!("edge {edge} of \"{}\"", panels[panel].name);
    format!("{} to {}", side(s.sides[0]), side(s.sides[1]))
}

fn seam(s: &RawStitch, start_to_end: bool, made: &[Made]) -> PatternSeam {
    let side = |(panel, edge): (usize, usize), against: bool| {
        let piece = &made[panel].piece;
        // Edges without length are never stitched.
        let (k, flipped) = made[panel].edges[edge].unwrap_or((0, false));
        let at = EdgeRef { panel: piece.name.clone(), edge: piece.outer.edges[k].name.clone() };
        EdgeUse { edge: at, reversed: flipped != against }
    };
    let [a, b] = [side(s.sides[0], false), side(s.sides[1], start_to_end)];
    let kind = if is_dart(s, made) { SeamKind::Dart } else { SeamKind::Matched };
    PatternSeam { name: format!("{} + {}", a.edge, b.edge), kind, sides: vec![vec![a], vec![b]] }
}

/// The corner of a piece at which two of its edges meet, as the number of the corner.
fn shared_corner(s: &RawStitch, made: &[Made]) -> Option<usize> {
    let [(p, a), (q, b)] = s.sides;
    let (a, b) = (made[p].edges[a]?.0, made[p].edges.get(b).copied().flatten()?.0);
    let n = made[p].piece.outer.edges.len();
    match p == q {
        true if (a + 1) % n == b => Some(b),
        true if (b + 1) % n == a => Some(a),
        _ => None,
    }
}

/// Two neighbouring edges that make a notch: the piece turns inwards where they meet.
fn is_dart(s: &RawStitch, made: &[Made]) -> bool {
    shared_corner(s, made).is_some_and(|k| {
        let corners = &made[s.sides[0].0].piece.outer.corners;
        let n = corners.len();
        let (before, here, after) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
        (here - before).perp(&(after - here)) < 0.0
    })
}

/// For each stitch whether it certainly runs the wrong way.
///
/// Errors: two mirror images that run in opposite ways, and the placed edges do not show which of
/// them is wrong.
fn wrong_ways(
    stitches: &[Stitch<'_>],
    panels: &[RawPanel],
    made: &[Made],
) -> Result<Vec<bool>, SpecificationDamage> {
    let leans: Vec<f64> = stitches.iter().map(|s| leaning(s, made)).collect();
    let images: Vec<Option<(usize, bool)>> = (0..stitches.len()).map(|i| image(i, stitches, made)).collect();
    let wrong = |i: usize| {
        let s = &stitches[i];
        if let Some(meets) = meets_at_corner(s.raw, panels) {
            return Ok(meets != s.start_to_end);
        }
        match images[i] {
            Some((_, true)) => Ok(false),
            Some((j, false)) => match (leans[i], leans[j]) {
                (own, other) if own > CLEAR && other < -CLEAR => Ok(true),
                (own, other) if own < -CLEAR && other > CLEAR => Ok(false),
                _ => Err(SpecificationDamage::Opposed {
                    stitch: s.number.min(stitches[j].number),
                    other: s.number.max(stitches[j].number),
                }),
            },
            None => Ok(leans[i] > CLEAR && shortest(s.raw, made) > SHORTEST),
        }
    };
    (0..stitches.len()).map(wrong).collect()
}

/// No panel has so many stitches that run the wrong way that it is the panel which lies wrong.
fn unturned(
    stitches: &[Stitch<'_>],
    turned: &[bool],
    panels: &[RawPanel],
) -> Result<(), SpecificationDamage> {
    let wrong = || stitches.iter().zip(turned).filter(|(_, t)| **t).map(|(s, _)| s);
    let at = |p: usize| wrong().filter(|s| s.raw.sides.iter().any(|(q, _)| *q == p)).count();
    let most = (0..panels.len()).map(|p| (at(p), p)).max_by_key(|(count, p)| (*count, std::cmp::Reverse(*p)));
    match most {
        Some((count, p)) if count >= MANY => {
            Err(SpecificationDamage::Turned { panel: panels[p].name.clone(), count })
        }
        _ => Ok(()),
    }
}

/// For neighbouring edges of one panel whether they meet there start to end; none for others, and
/// for both ends.
fn meets_at_corner(s: &RawStitch, panels: &[RawPanel]) -> Option<bool> {
    let [(p, a), (q, b)] = s.sides;
    if p != q {
        return None;
    }
    let [a, b] = [a, b].map(|e| panels[p].edges[e].ends);
    match (a[0] == b[1] || a[1] == b[0], a[0] == b[0] || a[1] == b[1]) {
        (true, false) => Some(true),
        (false, true) => Some(false),
        _ => None,
    }
}

/// Another stitch that is this one's mirror image about the middle of the body, and whether it runs
/// the same way.
fn image(i: usize, stitches: &[Stitch<'_>], made: &[Made]) -> Option<(usize, bool)> {
    let ends = |k: usize| stitches[k].raw.sides.map(|(p, e)| made[p].ends[e]);
    let mirrored = ends(i).map(|side| side.map(|q| Point3::new(-q.x, q.y, q.z)));
    // The same edge, from its start (false) or from its end (true).
    let alike = |x: &[Point3; 2], y: &[Point3; 2]| {
        let near = |a: &Point3, b: &Point3| (a - b).norm() <= NEAR;
        let straight = near(&x[0], &y[0]) && near(&x[1], &y[1]);
        let turned = near(&x[0], &y[1]) && near(&x[1], &y[0]);
        match (straight, turned) {
            (true, false) => Some(false),
            (false, true) => Some(true),
            _ => None,
        }
    };
    let both = |x: &[[Point3; 2]; 2], y: &[[Point3; 2]; 2]| {
        let same = alike(&x[0], &y[0]).zip(alike(&x[1], &y[1]));
        same.or_else(|| alike(&x[0], &y[1]).zip(alike(&x[1], &y[0])))
    };
    let others = (0..stitches.len()).filter(|&j| j != i);
    others.filter_map(|j| both(&mirrored, &ends(j)).map(|turns| (j, turns))).next().map(|(j, (a, b))| {
        // Turning one of the two edges turns which ends meet.
        (j, (stitches[i].start_to_end != (a != b)) == stitches[j].start_to_end)
    })
}

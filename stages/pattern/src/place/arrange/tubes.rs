//! Pieces around an arm, bent to cylinders.

use super::PiecePlaces;
use super::layers::{APART, layer};
use super::limb::Limb;
use super::move_input::MoveInput;
use super::narrow::{ArmGirths, Narrow, TubeLoop, TubePlace, loops, narrowest};
use crate::place::sew::Offsets;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_core::artifact::BodyPart;
use toile_core::prelude::*;

/// Words in a name that tell an arm's piece where the pattern gives no part of the body.
const WORDS: [&str; 3] = ["sleeve", "cuff", "arm"];

/// Slices along a piece in which its middle is looked for.
const SLICES: usize = 12;

/// A piece beside the arm, in the arm's coordinates.
struct ArmPiece {
    name: String,
    /// Before the arm, or behind it.
    is_front: bool,
    /// Along the axis and across it, upwards, metres; a point each vertex.
    flat: Vec<[f64; 2]>,
    /// The middle of its width.
    middle: f64,
    /// Its greatest width.
    width: f64,
}

/// The pieces that the pattern puts around the arm.
pub(super) fn around(limb: &Limb, pattern: &Pattern, places: &PiecePlaces) -> Vec<String> {
    let mine = places.iter().filter(|(name, points)| is_of_arm(pattern, name) && limb.has(&middle(points)));
    mine.map(|(name, _)| name.clone()).collect()
}

/// Pieces that were bent around an arm together.
pub(super) struct Bent {
    /// Their names.
    pub(super) names: String,
    /// What was done, in words.
    pub(super) told: String,
    /// Where they are narrowest beside the arm, if that is known.
    pub(super) narrow: Option<Narrow>,
}

/// Bends pieces around the arm.
pub(super) fn bend(limb: &Limb, mine: &[String], places: &mut PiecePlaces, by: &MoveInput<'_>) -> Vec<Bent> {
    let (seams, offsets) = (by.seams, by.offsets);
    let sewn = sewn(seams, offsets);
    let mut done = Vec::new();
    let girths = ArmGirths::of(limb, by.body);
    for tube in tubes(limb, mine, places, &sewn) {
        let axis = file_axis(limb, &tube, places, seams, offsets);
        let mut sides: Vec<ArmPiece> =
            tube.iter().map(|name| side(limb, &axis, name, &places[name])).collect();
        let girth: f64 = [true, false]
            .map(|front| sides.iter().filter(|s| s.is_front == front).map(|s| s.width).fold(0.0, f64::max))
            .iter()
            .sum();
        let along = || sides.iter().flat_map(|s| &s.flat).map(|p| p[0]);
        let (from, to) = (along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max));
        let outwards = APART * f64::from(layer(by.pattern, &tube[0]));
        let radius = (girth / TAU).max(limb.radius(from, to) + by.clearance) + outwards;
        let is_ring = sides.len() == 1 && sewn.contains(&(tube[0].clone(), tube[0].clone()));
        let around = loops_around(&sides, is_ring, seams, offsets);
        for s in &mut sides {
            // What goes all around has its middle over the arm; halves before and behind it.
            let centre = match (is_ring, s.is_front) {
                (true, _) => FRAC_PI_2,
                (false, true) => 0.0,
                (false, false) => PI,
            };
            let turn = if s.is_front { 1.0 } else { -1.0 };
            let bent = s.flat.iter().map(|[along, across]| {
                let angle = centre + turn * (across - s.middle) / radius;
                limb.root + limb.axis * *along + (limb.front * angle.cos() + limb.up * angle.sin()) * radius
            });
            places.insert(s.name.clone(), bent.collect());
        }
        let names = tube.join(", ");
        let told = format!("{names} around the {} arm, radius {:.0} mm", limb.hand, radius * 1e3);
        done.push(Bent { names, told, narrow: narrowest(&girths, &around) });
    }
    done
}

/// Loops around one piece that is sewn to itself, or two that are sewn to each other on both sides
/// of the arm.
fn loops_around(
    sides: &[ArmPiece],
    is_ring: bool,
    seams: &[GarmentSeam],
    offsets: &Offsets,
) -> Vec<TubeLoop> {
    let at = |s: &ArmPiece, v: u32| {
        let (first, panel) = offsets.get(s.name.as_str())?;
        let own = (v as usize).checked_sub(*first)?;
        Some((*panel.positions.get(own)?, *s.flat.get(own)?))
    };
    let pairs = || seams.iter().flat_map(|s| &s.pairs).filter(|[a, b]| a != b);
    match sides {
        [own] if is_ring => {
            let around = |[a, b]: &[u32; 2]| {
                let ((p, [x, _]), (q, [y, _])) = (at(own, *a)?, at(own, *b)?);
                Some(TubeLoop { girth: (p - q).norm(), along: f64::midpoint(x, y) })
            };
            pairs().filter_map(around).collect()
        }
        [one, other] => {
            let mut found = [Vec::new(), Vec::new()];
            let both = |[a, b]: &[u32; 2]| {
                [(*a, *b), (*b, *a)].into_iter().find_map(|(a, b)| Some((at(one, a)?, at(other, b)?)))
            };
            for ((p, [x, across]), (q, [y, _])) in pairs().filter_map(both) {
                let place = TubePlace { cloth: [p, q], along: f64::midpoint(x, y) };
                found[usize::from(across > one.middle)].push(place);
            }
            loops(&found)
        }
        _ => Vec::new(),
    }
}

fn is_of_arm(pattern: &Pattern, name: &str) -> bool {
    match pattern.piece(name).and_then(|p| p.body_part) {
        Some(part) => part == BodyPart::Arm,
        None => WORDS.iter().any(|w| name.to_lowercase().contains(w)),
    }
}

fn middle(points: &[Point3]) -> Point3 {
    let sum: Vector3 = points.iter().map(|p| p.coords).sum();
    Point3::from(sum / points.len().max(1) as f64)
}

/// Which panels are sewn to which, and to themselves; both ways round.
fn sewn(seams: &[GarmentSeam], offsets: &Offsets) -> BTreeSet<(String, String)> {
    let mut found = BTreeSet::new();
    for [a, b] in seams.iter().flat_map(|s| s.pairs.first()).filter(|[a, b]| a != b) {
        if let (Some(a), Some(b)) = (panel_of(*a, offsets), panel_of(*b, offsets)) {
            found.insert((a.to_owned(), b.to_owned()));
            found.insert((b.to_owned(), a.to_owned()));
        }
    }
    found
}

fn panel_of<'a>(vertex: u32, offsets: &'a Offsets) -> Option<&'a str> {
    let has = |(first, panel): &(usize, &Panel)| {
        (*first..first + panel.positions.len()).contains(&(vertex as usize))
    };
    offsets.iter().find(|(_, p)| has(p)).map(|(name, _)| *name)
}

fn is_front(limb: &Limb, points: &[Point3]) -> bool {
    (middle(points) - limb.root).dot(&limb.front) > 0.0
}

/// The pieces that go around the arm together: those before it with what is sewn to them behind it.
fn tubes(
    limb: &Limb,
    mine: &[String],
    places: &PiecePlaces,
    sewn: &BTreeSet<(String, String)>,
) -> Vec<Vec<String>> {
    let mut group: Vec<usize> = (0..mine.len()).collect();
    for (i, a) in mine.iter().enumerate() {
        for (j, b) in mine.iter().enumerate().skip(i + 1) {
            let apart = is_front(limb, &places[a]) != is_front(limb, &places[b]);
            if apart && sewn.contains(&(a.clone(), b.clone())) {
                let (from, to) = (group[j], group[i]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
    }
    let mut tubes: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    group.iter().zip(mine).for_each(|(g, name)| tubes.entry(*g).or_default().push(name.clone()));
    tubes.into_values().collect()
}

/// The direction of the arm that the pieces were placed for: that of the seams which join front and
/// back.
fn file_axis(
    limb: &Limb,
    tube: &[String],
    places: &PiecePlaces,
    seams: &[GarmentSeam],
    offsets: &Offsets,
) -> Vector3 {
    let of_tube = |v: u32| panel_of(v, offsets).filter(|p| tube.iter().any(|t| t == p));
    let at = |v: u32| {
        let name = panel_of(v, offsets)?;
        places.get(name)?.get(v as usize - offsets.get(name)?.0).copied()
    };
    let mut sum = Vector3::zeros();
    // A band along one edge runs across.
    for seam in seams.iter().filter(|s| s.pairs.iter().any(|[a, b]| a != b)) {
        let (Some(first), Some(last)) = (seam.pairs.first(), seam.pairs.last()) else { continue };
        for k in 0..2 {
            let (one, other) = (of_tube(first[k]), of_tube(first[1 - k]));
            if let (Some(_), Some(_), Some(a), Some(b)) = (one, other, at(first[k]), at(last[k])) {
                let way = b - a;
                // From the trunk to the hand, whichever way the seam runs. The seams of a flounce
                // run more across the arm than along it.
                sum += if way.dot(&limb.axis) < 0.0 { -way } else { way };
            }
        }
    }
    let flat = sum - limb.front * sum.dot(&limb.front);
    flat.try_normalize(1e-6).unwrap_or(limb.axis)
}

/// A piece in the coordinates of an arm that runs along `axis`.
fn side(limb: &Limb, axis: &Vector3, name: &str, points: &[Point3]) -> ArmPiece {
    let up = limb.front.cross(axis) * limb.front.cross(&limb.axis).dot(&limb.up).signum();
    let flat: Vec<[f64; 2]> =
        points.iter().map(|p| [(p - limb.root).dot(axis), (p - limb.root).dot(&up)]).collect();
    let (lo, hi) = bounds(flat.iter().map(|p| p[0]));
    let slice = |s: f64| (((s - lo) / (hi - lo).max(1e-9) * SLICES as f64) as usize).min(SLICES - 1);
    let mut middles = Vec::new();
    for k in 0..SLICES {
        let (low, high) = bounds(flat.iter().filter(|p| slice(p[0]) == k).map(|p| p[1]));
        if low <= high {
            middles.push(0.5 * (low + high));
        }
    }
    let (low, high) = bounds(flat.iter().map(|p| p[1]));
    let middle = middles.iter().sum::<f64>() / middles.len().max(1) as f64;
    ArmPiece { name: name.to_owned(), is_front: is_front(limb, points), flat, middle, width: high - low }
}

fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
}

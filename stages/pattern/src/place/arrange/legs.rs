//! Flat halves of legs that stand beside the body's legs.
//!
//! Trousers lie with their legs more or less spread, the body stands with its own. A half whose
//! rows miss the leg would be sewn beside it. Below the fork its rows are moved sideways, so that
//! the middle of each is before (or behind) the middle of the leg.
//!
//! A label does not tell a leg: GarmentCode calls the panels of skirts `leg`, too. Low down the
//! halves of a leg are sewn to each other, and to nothing across the middle; the panels of a skirt
//! go around both legs. So a piece is one of a leg where all that it is sewn to there lies on its
//! side.

use super::PiecePlaces;
use crate::place::sew::Offsets;
use std::collections::BTreeMap;
use toile_body::slice;
use toile_core::artifact::{BodyPart, join_pairs};
use toile_core::prelude::*;

/// Heights at which legs and pieces are compared, metres.
const STEP: f64 = 0.02;
/// A row covers the leg where the leg's middle lies within this share of it.
const MIDST: f64 = 0.5;
/// From the fork down over so much the move sets in, metres.
const SETS_IN: f64 = 0.25;
/// No piece is moved by less, metres.
const LEAST: f64 = 0.005;

/// Seams count in this lower share of what hangs below the body's fork: the rise of a garment may
/// end below that.
const LOWER: f64 = 0.5;
/// What is so little below the fork is right below it, metres.
const AT_FORK: f64 = 0.1;
/// The middle of what is before one leg lies at least so far beside the body's, metres.
const ASIDE: f64 = 0.02;

/// Moves the flat halves of legs that miss the body's; what was moved, in words.
pub(super) fn swing(
    pattern: &Pattern,
    body: &Body,
    places: &mut PiecePlaces,
    seams: &[GarmentSeam],
    offsets: &Offsets,
) -> Vec<String> {
    let Some(crotch) = body.landmarks.get("crotch").map(|p| p.y) else { return Vec::new() };
    let of_one_leg = of_one_leg(places, seams, offsets, [low(places, crotch), crotch]);
    let mut told = Vec::new();
    for piece in pattern.pieces.iter().filter(|p| p.body_part == Some(BodyPart::Leg)) {
        if of_one_leg.get(&piece.name) != Some(&true) {
            continue;
        }
        let Some(points) = places.get_mut(&piece.name) else { continue };
        let hand = Hand::of(points.iter().map(|p| p.x).sum());
        let rows = rows(points, crotch);
        let legs: BTreeMap<i64, f64> =
            rows.keys().filter_map(|k| Some((*k, leg_at(body, *k as f64 * STEP, hand)?))).collect();
        let misses = |(k, [low, high]): (&i64, &[f64; 2])| {
            let reach = 0.5 * MIDST * (high - low);
            legs.get(k).is_some_and(|x| (x - 0.5 * (low + high)).abs() > reach)
        };
        if !rows.iter().any(misses) {
            continue;
        }
        let away: BTreeMap<i64, f64> =
            legs.iter().map(|(k, x)| (*k, x - 0.5 * (rows[k][0] + rows[k][1]))).collect();
        let mut moved = 0.0f64;
        for p in points.iter_mut().filter(|p| p.y < crotch) {
            let set_in = ((crotch - p.y) / SETS_IN).min(1.0);
            let by = set_in * set_in * (3.0 - 2.0 * set_in) * between(&away, p.y / STEP);
            moved = if by.abs() > moved.abs() { by } else { moved };
            p.x += by;
        }
        if moved.abs() > LEAST {
            let way = if moved * hand.sign() > 0.0 { "outwards" } else { "inwards" };
            told.push(format!(
                "{} is swung {way} by {:.0} mm, to where the body's leg is",
                piece.name,
                moved.abs() * 1e3
            ));
        }
    }
    told
}

/// Whether some piece is one of a leg.
pub(super) fn any_of_one_leg(
    places: &PiecePlaces,
    seams: &[GarmentSeam],
    offsets: &Offsets,
    crotch: f64,
) -> bool {
    of_one_leg(places, seams, offsets, [low(places, crotch), crotch]).values().any(|is_one| *is_one)
}

/// The height below which seams count.
fn low(places: &PiecePlaces, crotch: f64) -> f64 {
    let lowest = places.values().flatten().map(|p| p.y).fold(crotch, f64::min);
    lowest + LOWER * (crotch - lowest)
}

/// For each piece that reaches below the first height, whether it and all that is sewn to it there
/// lie on one side of the middle, there and right below the fork, the second height: a skirt that
/// is longer on one side lies on that side only low down.
fn of_one_leg(
    places: &PiecePlaces,
    seams: &[GarmentSeam],
    offsets: &Offsets,
    [below, fork]: [f64; 2],
) -> BTreeMap<String, bool> {
    let names: Vec<&String> = places.keys().collect();
    let piece_of = |v: u32| {
        let (name, (first, _)) =
            offsets.iter().filter(|(_, (first, _))| *first <= v as usize).max_by_key(|(_, o)| o.0)?;
        let at = places.get(*name)?.get(v as usize - first)?;
        Some((names.iter().position(|n| n == name)?, at.y))
    };
    let mut group: Vec<u32> = (0..names.len() as u32).collect();
    for [a, b] in seams.iter().flat_map(|s| &s.pairs) {
        if let (Some((a, ya)), Some((b, yb))) = (piece_of(*a), piece_of(*b))
            && ya < below
            && yb < below
        {
            join_pairs(&mut group, &[[a as u32, b as u32]]);
        }
    }
    let middle = |k: usize, heights: [f64; 2]| {
        let is_in = |p: &&Point3| p.y >= heights[0] && p.y < heights[1];
        let there: Vec<f64> = places[names[k]].iter().filter(is_in).map(|p| p.x).collect();
        (!there.is_empty()).then(|| there.iter().sum::<f64>() / there.len() as f64)
    };
    let low = [f64::NEG_INFINITY, below];
    let right_below_fork = [fork - AT_FORK, fork];
    let one_sided = |k: usize| {
        let members = (0..names.len()).filter(|l| group[*l] == group[k]);
        let middles: Vec<f64> = members
            .flat_map(|l| [low, right_below_fork].map(|heights| middle(l, heights)))
            .flatten()
            .collect();
        middles.iter().all(|x| *x > ASIDE) || middles.iter().all(|x| *x < -ASIDE)
    };
    let reaching = (0..names.len()).filter(|k| middle(*k, low).is_some());
    reaching.map(|k| (names[k].clone(), one_sided(k))).collect()
}

/// Least and greatest x of a piece's rows below the fork, by their number.
fn rows(points: &[Point3], crotch: f64) -> BTreeMap<i64, [f64; 2]> {
    let mut rows: BTreeMap<i64, [f64; 2]> = BTreeMap::new();
    for p in points.iter().filter(|p| p.y < crotch) {
        let row = rows.entry((p.y / STEP).floor() as i64).or_insert([f64::INFINITY, f64::NEG_INFINITY]);
        *row = [row[0].min(p.x), row[1].max(p.x)];
    }
    rows
}

/// The middle of the body's leg on one side at a height.
fn leg_at(body: &Body, y: f64, hand: Hand) -> Option<f64> {
    let loops = slice(&body.positions, &body.triangles, y);
    // Hands may hang lower than the fork, farther out.
    let own = loops.iter().filter(|l| l.centre().x * hand.sign() > 0.01);
    let leg = own.min_by(|a, b| a.centre().x.abs().total_cmp(&b.centre().x.abs()))?;
    Some(leg.centre().x)
}

/// The move at a height, in rows, between those of the next row below and above; that of the last
/// row beyond it.
fn between(away: &BTreeMap<i64, f64>, at: f64) -> f64 {
    // A row's middle lies half a row above its number.
    let at = at - 0.5;
    let below = away.range(..=at.floor() as i64).next_back();
    let above = away.range(at.floor() as i64 + 1..).next();
    match (below, above) {
        (Some((k, a)), Some((l, b))) => a + (b - a) * (at - *k as f64) / (l - k) as f64,
        (Some((_, by)), None) | (None, Some((_, by))) => *by,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn mannequin() -> Body {
        let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
        toile_fixtures::mannequin(lengths).unwrap()
    }

    /// The half of a left leg from waist to ankle, 20 cm wide, that leaves the middle by so much a
    /// metre.
    fn half(spread: f64) -> (Pattern, PiecePlaces) {
        let row = |k: usize| {
            let y = 0.105 + 0.02 * k as f64;
            let out = spread * (0.8 - y).max(0.0);
            (0..5).map(move |i| Point3::new(out + 0.05 * f64::from(i), y, 0.2))
        };
        let piece =
            Piece { name: "left_leg_front".into(), body_part: Some(BodyPart::Leg), ..Piece::default() };
        let pattern = Pattern { name: "trousers".into(), pieces: vec![piece], seams: vec![] };
        (pattern, BTreeMap::from([("left_leg_front".to_owned(), (0..48).flat_map(row).collect())]))
    }

    #[test]
    fn a_leg_that_is_spread_wide_is_swung_before_the_bodys() {
        let body = mannequin();
        let (pattern, mut places) = half(0.3);
        let told = swing(&pattern, &body, &mut places, &[], &Offsets::new());
        assert!(told[0].starts_with("left_leg_front is swung inwards by "), "{told:?}");
        for k in [2, 6, 12] {
            let row = &places["left_leg_front"][5 * k..5 * k + 5];
            let leg = leg_at(&body, row[0].y, Hand::Left).unwrap();
            assert!((row[2].x - leg).abs() < 0.01, "{} {leg}", row[2].x);
            assert!((row[4].x - row[0].x - 0.2).abs() < 1e-9, "as wide as before");
        }
        let waist = &places["left_leg_front"][5 * 40..];
        assert!(waist.iter().all(|p| p.x < 0.2001), "what is above the fork stays");
    }

    #[test]
    fn a_skirt_that_is_longer_on_one_side_is_no_leg() {
        // From 20 cm on the right to 20 cm on the left at the fork, and only on the left low down.
        let row = |k: usize| {
            let y = 0.105 + 0.02 * k as f64;
            (0..9)
                .map(move |i| Point3::new(-0.2 + 0.05 * f64::from(i), y, 0.2))
                .filter(move |p| p.x > 0.4 - y)
        };
        let piece = Piece { name: "skirt_front".into(), body_part: Some(BodyPart::Leg), ..Piece::default() };
        let pattern = Pattern { name: "skirt".into(), pieces: vec![piece], seams: vec![] };
        let places = BTreeMap::from([("skirt_front".to_owned(), (0..35).flat_map(row).collect::<Vec<_>>())]);
        let low = places["skirt_front"].iter().filter(|p| p.y < 0.4).map(|p| p.x);
        assert!(low.clone().sum::<f64>() / low.count() as f64 > ASIDE, "low down it lies on one side");
        let mut moved = places.clone();
        assert!(swing(&pattern, &mannequin(), &mut moved, &[], &Offsets::new()).is_empty());
        assert_eq!(moved, places);
    }

    #[test]
    fn a_leg_that_covers_the_bodys_stays() {
        let (pattern, places) = half(0.05);
        let mut moved = places.clone();
        assert!(swing(&pattern, &mannequin(), &mut moved, &[], &Offsets::new()).is_empty());
        assert_eq!(moved, places);
    }
}

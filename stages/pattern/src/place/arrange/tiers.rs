//! Gaps between pieces that stand above each other, closed.
//!
//! A file puts a waistband some centimetres below the bodice, a skirt below the waistband, a cuff
//! below the leg. Seams that start so far apart pull the bodice down before its shoulders are
//! closed, and cuffs may start below the feet. Method: every piece of trunk and legs is raised or
//! lowered as a whole, by the heights for which the seams have the least sum of squared vertical
//! gaps; of all that is sewn together, the piece that hangs on the shoulders stays, or the highest.
//! Cost: a dense system of one unknown a piece. Limits: pieces around arms, hoods and collars stay.

use super::PiecePlaces;
use super::move_input::MoveInput;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use toile_core::artifact::{BodyPart, join_pairs};
use toile_core::prelude::*;

/// This start in words.
pub(super) const TOLD: &str = "with the gaps between its tiers closed";

/// Where no piece is moved by more, the places are as good as the file's, metres.
const LEAST: f64 = 0.01;

/// What reaches no farther below the armpits is a hood or a collar, metres.
const NECK: f64 = 0.1;

/// The piece that a vertex of the garment is of, and its number there.
pub(super) fn piece_of<'a>(v: u32, by: &MoveInput<'a>) -> Option<(&'a str, usize)> {
    let of = |(name, (first, panel)): (&&'a str, &(usize, &Panel))| {
        let own = (v as usize).checked_sub(*first).filter(|k| *k < panel.positions.len())?;
        Some((*name, own))
    };
    by.offsets.iter().find_map(of)
}

/// The places with the gaps closed; nothing where no piece is moved by more than [`LEAST`].
pub(super) fn closed(by: &MoveInput<'_>, places: &PiecePlaces) -> Option<PiecePlaces> {
    let armpit = by.body.landmark("armpit", Hand::Left).map_or(f64::INFINITY, |p| p.y);
    let span = |name: &str| {
        let heights = places.get(name).into_iter().flatten().map(|p| p.y);
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], y| [lo.min(y), hi.max(y)])
    };
    let is_moved = |name: &str| {
        let is_sleeve = by.sleeves.is_some_and(|all| all.iter().any(|s| s.0 == name));
        let part = by.pattern.piece(name).and_then(|p| p.body_part);
        let is_neck = span(name)[0] > armpit - NECK;
        !is_sleeve && !is_neck && !matches!(part, Some(BodyPart::Arm | BodyPart::Head))
    };
    let names: Vec<&str> = places.keys().map(String::as_str).filter(|n| is_moved(n)).collect();
    let number: BTreeMap<&str, usize> = names.iter().zip(0..).map(|(n, k)| (*n, k)).collect();
    let at = |v: u32| {
        let (name, own) = piece_of(v, by)?;
        Some((*number.get(name)?, places.get(name)?.get(own)?.y))
    };
    let pairs: Vec<[(usize, f64); 2]> = by
        .seams
        .iter()
        .flat_map(|s| &s.pairs)
        .filter_map(|[a, b]| Some([at(*a)?, at(*b)?]))
        .filter(|[(a, _), (b, _)]| a != b)
        .collect();
    let mut group: Vec<u32> = (0..names.len() as u32).collect();
    pairs.iter().for_each(|[(a, _), (b, _)]| join_pairs(&mut group, &[[*a as u32, *b as u32]]));
    // On the shoulders hangs what reaches above the armpits, and of that what reaches lowest. The
    // halves of a circle skirt lie flat, and reach up as far.
    let rank = |k: &usize| {
        let [low, high] = span(names[*k]);
        match by.pattern.piece(names[*k]).and_then(|p| p.body_part) {
            Some(BodyPart::Leg) => [0.0, high],
            _ if high > armpit => [2.0, -low],
            _ => [1.0, high],
        }
    };
    let fixed = |k: usize| {
        let own = (0..names.len()).filter(|l| group[*l] == group[k]);
        let by_rank = |a: &usize, b: &usize| {
            let ([x, y], [u, v]) = (rank(a), rank(b));
            x.total_cmp(&u).then(y.total_cmp(&v)).then(b.cmp(a))
        };
        own.max_by(by_rank) == Some(k)
    };
    let n = names.len();
    let (mut matrix, mut right) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
    for [(a, ya), (b, yb)] in pairs {
        for (k, l, gap) in [(a, b, yb - ya), (b, a, ya - yb)] {
            matrix[(k, k)] += 1.0;
            matrix[(k, l)] -= 1.0;
            right[k] += gap;
        }
    }
    for k in (0..n).filter(|k| fixed(*k)) {
        matrix.row_mut(k).fill(0.0);
        matrix[(k, k)] = 1.0;
        right[k] = 0.0;
    }
    let heights = matrix.lu().solve(&right)?;
    if heights.iter().all(|h| h.abs() <= LEAST) || heights.iter().any(|h| !h.is_finite()) {
        return None;
    }
    let mut moved = places.clone();
    for (name, height) in names.iter().zip(heights.iter()) {
        moved.get_mut(*name).into_iter().flatten().for_each(|p| p.y += height);
    }
    Some(moved)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::place::sew::Offsets;

    /// A square of 10 cm in the plane, as a panel of four vertices.
    fn square() -> Panel {
        let positions = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]].map(|[x, y]| Point2::new(x, y));
        Panel {
            positions: positions.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            boundary: vec![0, 1, 2, 3],
            holes: Vec::new(),
            edges: Vec::new(),
            inner: Vec::new(),
            photo_px: Vec::new(),
            outline_area: 0.01,
            outline_length: 0.4,
        }
    }

    #[test]
    fn what_hangs_below_is_raised_to_what_holds_it() {
        let panel = square();
        let offsets: Offsets<'_> =
            [("a_bodice", (0, &panel)), ("b_band", (4, &panel)), ("c_skirt", (8, &panel))].into();
        let stand = |y: f64| panel.positions.iter().map(|p| Point3::new(p.x, p.y + y, 0.2)).collect();
        let heights = [("a_bodice", 1.0), ("b_band", 0.85), ("c_skirt", 0.7)];
        let places: PiecePlaces = heights.iter().map(|(n, y)| ((*n).to_owned(), stand(*y))).collect();
        let seam = |pairs: [[u32; 2]; 2]| GarmentSeam {
            name: "waist".into(),
            kind: SeamKind::Matched,
            pairs: pairs.to_vec(),
            state: SeamState::Open,
        };
        // The lower edge of each piece to the upper edge of the next.
        let seams = [seam([[0, 7], [1, 6]]), seam([[4, 11], [5, 10]])];
        let body = Body {
            positions: vec![],
            triangles: vec![],
            landmarks: BTreeMap::new(),
            measurements: BTreeMap::new(),
        };
        let pattern = Pattern { name: "dress".into(), pieces: vec![], seams: vec![] };
        let by = MoveInput {
            body: &body,
            pattern: &pattern,
            seams: &seams,
            offsets: &offsets,
            sleeves: None,
            clearance: 0.02,
        };
        let moved = closed(&by, &places).unwrap();
        let low = |name: &str| moved[name][0].y;
        assert!((low("a_bodice") - 1.0).abs() < 1e-9, "the highest stays");
        assert!((low("b_band") - 0.9).abs() < 1e-9 && (low("c_skirt") - 0.8).abs() < 1e-9);
        assert!(closed(&by, &moved).is_none(), "nothing is left to close");
    }
}

//! Whether the garment is still in its place on the body.
//!
//! Solvers tell how far the upper edge of all that is sewn together has sunk, as a share of the
//! root of its area. Here that way is held against the height of its tallest piece: a wide gathered
//! skirt has much cloth, and lies on the floor all the same once it has sunk by its own height.

use super::parts::{named, parts};
use std::collections::BTreeSet;
use toile_core::artifact::{Garment, Shortfall};
use toile_core::prelude::*;

/// What is no taller than this may sink as far as cloth of this height, metres: a belt settles by
/// some centimetres.
const LEAST_HEIGHT: f64 = 0.15;

/// For each panel the share of it that is still in its place; empty where no solver told.
fn shares(garment: &Garment, part: &[usize]) -> Vec<f64> {
    let height = |p: &GarmentPanel| {
        let y = || garment.rest[p.vertices.clone()].iter().map(|p| p.y);
        y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min)
    };
    let of_part = |k: usize| garment.panels.iter().zip(part).filter(move |(_, p)| **p == k).map(|(p, _)| p);
    let share = |(told, k): (&f64, &usize)| {
        let root = of_part(*k).map(|p| garment.panel_areas(p).0).sum::<f64>().sqrt();
        let tall = of_part(*k).map(height).fold(LEAST_HEIGHT, f64::max);
        (1.0 - (1.0 - told) * (root / tall).max(1.0)).clamp(0.0, 1.0)
    };
    garment.status.on_body.iter().zip(part).map(share).collect()
}

/// The share that is still in its place of the panel that has slid farthest; nothing where no
/// solver told.
pub(super) fn least(garment: &Garment) -> Option<f64> {
    shares(garment, &parts(garment)).into_iter().reduce(f64::min)
}

/// The limits that are missed where less than `limit` of a part of the garment is in its place.
pub(super) fn shortfalls(garment: &Garment, limit: f64) -> Vec<Shortfall> {
    let part = parts(garment);
    let shares = shares(garment, &part);
    let fallen: BTreeSet<usize> =
        shares.iter().zip(&part).filter(|(share, _)| **share < limit).map(|(_, k)| *k).collect();
    let of = |k: usize| {
        shares.iter().zip(&part).filter(move |(_, p)| **p == k).map(|(s, _)| *s).fold(1.0, f64::min)
    };
    let message = |k: usize| {
        let others: Vec<String> = part
            .iter()
            .copied()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .filter(|other| *other != k)
            .map(|other| named(garment, &part, other))
            .collect();
        let remedy = match others.is_empty() {
            true => "cut it narrower where the body is to hold it, or raise the friction".to_owned(),
            false => format!(
                "no seam joins it to {}: add one where they belong together, or cut it narrower where the body is to hold it",
                others.join(" or ")
            ),
        };
        let percent = |share: f64| format!("{:.0} %", share * 1e2);
        format!(
            "{} slid down the body: {} of it is still where it was placed (at least {} is good); {remedy}",
            named(garment, &part, k),
            percent(of(k)),
            percent(limit)
        )
    };
    fallen
        .into_iter()
        .map(|k| Shortfall { code: ErrorCode::StaticEquilibrium, message: message(k) })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use toile_fixtures::cloth::{ClothGrid, garment, plain};

    /// Two squares of a metre, sewn together or not.
    fn worn(on_body: Vec<f64>, sewn: bool) -> Garment {
        let grid =
            || ClothGrid { columns: 1, rows: 1, flat: Point2::new, lift: |p| Point3::new(p.x, p.y, 0.0) };
        let mut garment = garment(&[("front", &grid()), ("back", &grid())], &plain(500.0, 50.0, 1e-5));
        if sewn {
            let pair = [0, garment.panels[1].vertices.start as u32];
            let (name, kind, state) = ("side".to_owned(), SeamKind::Matched, SeamState::Closed);
            garment.seams.push(GarmentSeam { name, kind, pairs: vec![pair], state });
        }
        garment.status.on_body = on_body;
        garment
    }

    fn told(garment: &Garment) -> Vec<String> {
        shortfalls(garment, 0.5).into_iter().map(|s| s.message).collect()
    }

    #[test]
    fn all_that_is_sewn_together_is_judged_by_its_height() {
        // Two square metres sank by half a metre: half of the height of each.
        let share = 1.0 - 0.5 / 2.0_f64.sqrt();
        assert!((least(&worn(vec![share; 2], true)).unwrap() - 0.5).abs() < 1e-12);
        assert!(told(&worn(vec![share + 0.01; 2], true)).is_empty());
        assert_eq!(
            told(&worn(vec![share - 0.1; 2], true)),
            [
                "\"front\" and \"back\" slid down the body: 36 % of it is still where it was placed (at least 50 % is good); cut it narrower \
                 where the body is to hold it, or raise the friction"
            ]
        );
    }

    #[test]
    fn what_no_seam_joins_to_the_rest_is_told_so() {
        assert_eq!(
            told(&worn(vec![0.9, 0.3], false)),
            [
                "\"back\" slid down the body: 30 % of it is still where it was placed (at least 50 % is good); no seam joins it to \"front\": add \
                 one where they belong together, or cut it narrower where the body is to hold it"
            ]
        );
    }

    #[test]
    fn what_no_solver_told_misses_nothing() {
        assert_eq!((least(&worn(vec![], true)), told(&worn(vec![], true))), (None, vec![]));
    }
}

//! Settings of a measurement that keep a wish, and why none does.

use super::Wish;
use crate::front::Cost;
use crate::record::Trade;
use toile_core::{ErrorCode, StageError};

const NEVER: Cost = Cost { time: f64::INFINITY, error: f64::INFINITY };

/// Points that keep a wish, the best first. Where an error is asked: the quickest, of all that miss
/// no quality limit, for what beats another may do so from its own start alone, and that shows only
/// when it is proved. Where a time is asked: the most accurate of the front.
pub fn picks(trade: &Trade, wish: &Wish) -> Vec<usize> {
    if wish.max_error_mm.is_some() { quickest(trade, wish) } else { most_accurate(trade, wish) }
}

fn quickest(trade: &Trade, wish: &Wish) -> Vec<usize> {
    let sound = |i: &usize| trade.points[*i].measured().is_some_and(|m| m.sound);
    let mut picks: Vec<usize> =
        (0..trade.points.len()).filter(|i| sound(i) && keeps(trade, wish, *i)).collect();
    let cost = |i: usize| trade.points[i].measured().map_or(NEVER, |m| m.cost(trade.clock));
    picks.sort_by(|&a, &b| {
        let (a, b) = (cost(a), cost(b));
        a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error))
    });
    picks
}

fn most_accurate(trade: &Trade, wish: &Wish) -> Vec<usize> {
    let front = trade.front.iter().copied().filter(|i| *i < trade.points.len());
    front.rev().filter(|i| keeps(trade, wish, *i)).collect()
}

fn keeps(trade: &Trade, wish: &Wish, point: usize) -> bool {
    let measured = trade.points[point].measured();
    measured.is_some_and(|m| wish.is_kept(m.errors.distance_mm.p95, m.time(trade.clock)))
}

/// Why a wish cannot be proved, before anything runs; none where there are settings to try.
pub fn refusal(trade: &Trade, wish: &Wish) -> Option<StageError> {
    below_floor(trade, wish).or_else(|| picks(trade, wish).is_empty().then(|| none_keeps(trade, wish)))
}

/// The error for a wish below the known accuracy of the reference.
fn below_floor(trade: &Trade, wish: &Wish) -> Option<StageError> {
    let floor = trade.reference.floor()?;
    let asked = wish.max_error_mm.filter(|e| *e < floor.mm)?;
    let message = format!("an error of at most {asked} mm cannot be verified: {}", floor.words());
    // What is printed is what can be asked for.
    let least = (floor.mm * 100.0).ceil() / 100.0;
    let hint = match least.is_finite() {
        true => format!("ask for {least:.2} mm or more; {}", floor.remedy()),
        false => floor.remedy().to_owned(),
    };
    Some(StageError::new(ErrorCode::StaticEquilibrium, message).hint(hint))
}

/// No setting of the front, with the nearest.
fn none_keeps(trade: &Trade, wish: &Wish) -> StageError {
    let points = trade.front.iter().filter_map(|&i| trade.points.get(i)?.measured());
    let costs: Vec<_> = points.map(|m| m.cost(trade.clock)).collect();
    let message = format!("no setting of the measured front keeps {}", wish.words());
    let e = StageError::new(ErrorCode::StaticEquilibrium, message);
    match (costs.last(), costs.first()) {
        (Some(best), Some(quickest)) => e.hint(format!(
            "the most accurate keeps {:.2} mm in {:.2} s, the quickest takes {:.2} s at {:.2} mm",
            best.error, best.time, quickest.time, quickest.error
        )),
        _ => e.hint("nothing was measured; give `toile trade` more time"),
    }
}

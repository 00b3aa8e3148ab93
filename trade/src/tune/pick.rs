//! Settings of a measured front that keep a wish, and why none does.

use super::Wish;
use crate::record::Trade;
use toile_core::{ErrorCode, StageError};

/// Points of the front that keep a wish, the best first: the quickest where an error is asked, else the most accurate.
pub fn picks(trade: &Trade, wish: &Wish) -> Vec<usize> {
    let keeps = |i: &usize| {
        trade.points[*i]
            .measured()
            .is_some_and(|m| wish.is_kept(m.errors.distance_mm.p95, m.time(trade.clock)))
    };
    let picks = trade.front.iter().copied().filter(|i| *i < trade.points.len()).filter(keeps);
    if wish.max_error_mm.is_some() { picks.collect() } else { picks.rev().collect() }
}

/// Why a wish cannot be proved, before anything runs; none where there are settings to try.
pub fn refusal(trade: &Trade, wish: &Wish) -> Option<StageError> {
    below_floor(trade, wish).or_else(|| picks(trade, wish).is_empty().then(|| none_keeps(trade, wish)))
}

/// An error that the reference is too little known for.
fn below_floor(trade: &Trade, wish: &Wish) -> Option<StageError> {
    let floor = trade.reference.floor()?;
    let asked = wish.max_error_mm.filter(|e| *e < floor.mm)?;
    let message = format!("an error of at most {asked} mm cannot be proved: {}", floor.words());
    // What is printed is what can be asked for.
    let least = (floor.mm * 100.0).ceil() / 100.0;
    let hint = format!("ask for {least:.2} mm or more; {}", floor.remedy());
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

//! Whether the garment is still in its place on the body.

use toile_core::artifact::{Garment, Shortfall};
use toile_core::prelude::*;

/// The panel that has slid farthest, and the share of it that is still in its place; nothing where no solver told.
pub(super) fn least(garment: &Garment) -> Option<(&str, f64)> {
    let told = garment.panels.iter().map(|p| p.name.as_str()).zip(garment.status.on_body.iter().copied());
    told.reduce(|a, b| if b.1 < a.1 { b } else { a })
}

/// The limit that is missed where less than `limit` of a panel is in its place.
pub(super) fn shortfall(garment: &Garment, limit: f64) -> Option<Shortfall> {
    let (name, share) = least(garment).filter(|(_, share)| *share < limit)?;
    let percent = |share: f64| format!("{:.0} %", share * 1e2);
    let message = format!(
        "panel \"{name}\" has slid down the body: {} of it is still where it was placed, the limit is {}; cut it narrower where the \
         body is to hold it, or raise the friction",
        percent(share),
        percent(limit)
    );
    Some(Shortfall { code: ErrorCode::StaticEquilibrium, message })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::fixtures::{Grid, garment, plain};

    fn worn(on_body: Vec<f64>) -> Garment {
        let grid = || Grid { columns: 1, rows: 1, flat: Point2::new, lift: |p| Point3::new(p.x, p.y, 0.0) };
        let mut garment = garment(&[("front", &grid()), ("back", &grid())], &plain(500.0, 50.0, 1e-5));
        garment.status.on_body = on_body;
        garment
    }

    #[test]
    fn the_panel_that_slid_farthest_is_judged() {
        assert_eq!(least(&worn(vec![0.9, 0.3])), Some(("back", 0.3)));
        assert_eq!(shortfall(&worn(vec![0.9, 0.5]), 0.5), None);
        assert_eq!(
            shortfall(&worn(vec![0.9, 0.3]), 0.5).unwrap().message,
            "panel \"back\" has slid down the body: 30 % of it is still where it was placed, the limit is 50 %; cut it narrower where the \
             body is to hold it, or raise the friction"
        );
    }

    #[test]
    fn what_no_solver_told_misses_nothing() {
        assert_eq!((least(&worn(vec![])), shortfall(&worn(vec![]), 1.0)), (None, None));
    }
}

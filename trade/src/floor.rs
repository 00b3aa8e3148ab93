//! The error below which figures against a reference mean nothing.
//!
//! It is the greatest of what is known of the reference's own fault: what its finest level still lacks (Richardson), or, where its
//! levels show no order, how far the last refinement moved it, for a next one may move it as far; and how far its own moved
//! starts and its neighbours, a little finer and coarser, end from it.

use crate::record::{Neighbours, OwnSpread, Reference};

/// How well a reference is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// 95 % of the surface, millimetres.
    pub mm: f64,
    /// What it rests on.
    pub by: By,
}

/// What a floor rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// What the finest level still lacks.
    Missing,
    /// How far the last refinement moved it, without an order.
    Moved,
    /// The spread of its moved starts.
    Spread,
    /// How far neighbouring resolutions end from it.
    Neighbours,
    /// Nothing: it was never refined.
    Nothing,
}

impl Floor {
    /// `the reference is known to 8.32 mm only: its last refinement moved it as far, and its levels show no order`.
    pub fn words(&self) -> String {
        let why = match self.by {
            By::Nothing => return "nothing tells how well the reference is known: it was not refined".into(),
            By::Missing => "so much is missing from its finest level to the limit of its order",
            By::Moved => "its last refinement moved it as far, and its levels show no order",
            By::Spread => "starts moved by a little end so far apart, in other states of rest",
            By::Neighbours => {
                "meshes a fiftieth finer or coarser end so far from it, in other states of rest"
            }
        };
        format!("the reference is known to {:.2} mm only: {why}", self.mm)
    }

    /// What can be done to lower it.
    pub fn remedy(&self) -> &'static str {
        match self.by {
            By::Missing | By::Moved => {
                "measure into another --out with a longer --budget, so that it is refined further"
            }
            By::Nothing => {
                "give `toile trade` a knob that is a resolution, such as an edge length, and room to refine it"
            }
            By::Spread | By::Neighbours => "no refinement lowers that: it is the garment's own",
        }
    }
}

impl Reference {
    /// How well it is known; none where neither its levels nor moved starts tell. Of a reference of one level nothing is
    /// known, however well its moved starts agree: the floor is infinite.
    pub fn floor(&self) -> Option<Floor> {
        if self.levels.len() == 1 {
            return Some(Floor { mm: f64::INFINITY, by: By::Nothing });
        }
        let spread = self.spread.as_ref().and_then(OwnSpread::p95).map(|mm| Floor { mm, by: By::Spread });
        let near = self.neighbours.as_ref().and_then(Neighbours::p95);
        let near = near.map(|mm| Floor { mm, by: By::Neighbours });
        self.lacks().into_iter().chain(spread).chain(near).reduce(|a, b| if b.mm > a.mm { b } else { a })
    }

    fn lacks(&self) -> Option<Floor> {
        let moved = || Some(Floor { mm: self.levels.last()?.moved_mm?.p95, by: By::Moved });
        self.p95.map(|o| Floor { mm: o.missing_mm, by: By::Missing }).or_else(moved)
    }

    /// [`Reference::floor`] in millimetres, where it is finite.
    pub fn floor_mm(&self) -> Option<f64> {
        self.floor().map(|f| f.mm).filter(|mm| mm.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::errors::Millimetres;
    use crate::record::{Level, Order};

    fn moved(p95: Option<f64>) -> Level {
        let moved_mm = p95.map(|p95| Millimetres { p95, ..Millimetres::default() });
        Level { moved_mm, ..Level::default() }
    }

    fn reference(levels: Vec<Level>, missing: Option<f64>, start: Option<f64>) -> Reference {
        let p95 = missing.map(|missing_mm| Order { order: Some(1.0), missing_mm });
        let starts_mm: Vec<Millimetres> =
            start.into_iter().map(|p95| Millimetres { p95, ..Millimetres::default() }).collect();
        let spread = OwnSpread { jitter_mm: 1.0, level: 0, starts_mm, failed: Vec::new() };
        Reference { levels, p95, spread: Some(spread), ..Reference::default() }
    }

    #[test]
    fn the_greatest_fault_of_the_reference_is_its_floor() {
        let levels = || vec![moved(None), moved(Some(6.3)), moved(Some(8.32))];
        let floor = |missing, start| reference(levels(), missing, start).floor();
        assert_eq!(floor(Some(0.2), Some(5.8)), Some(Floor { mm: 5.8, by: By::Spread }));
        assert_eq!(floor(Some(0.2), Some(0.0)), Some(Floor { mm: 0.2, by: By::Missing }));
        // Levels that do not come nearer: quiet starts do not make them a reference.
        assert_eq!(floor(None, Some(0.0)), Some(Floor { mm: 8.32, by: By::Moved }));
        // Quiet starts of one level do not make it known.
        let alone = reference(vec![moved(None)], None, Some(0.1));
        assert_eq!(alone.floor(), Some(Floor { mm: f64::INFINITY, by: By::Nothing }));
        assert_eq!((alone.floor_mm(), Reference::default().floor()), (None, None));
        // Levels that come nearer, while the mesh picks the state of rest.
        let apart_mm = [0.4, 6.9].map(|p95| Millimetres { p95, ..Millimetres::default() }).to_vec();
        let near = Some(Neighbours { apart_mm, ..Neighbours::default() });
        let picked = Reference { neighbours: near, ..reference(levels(), Some(0.2), Some(0.1)) };
        assert_eq!(picked.floor(), Some(Floor { mm: 6.9, by: By::Neighbours }));
    }

    #[test]
    fn words_and_remedies() {
        let words = |by| Floor { mm: 8.321, by }.words();
        assert_eq!(
            words(By::Moved),
            "the reference is known to 8.32 mm only: its last refinement moved it as far, and its levels show no order"
        );
        assert_eq!(
            words(By::Missing),
            "the reference is known to 8.32 mm only: so much is missing from its finest level to the limit of its order"
        );
        assert_eq!(words(By::Nothing), "nothing tells how well the reference is known: it was not refined");
        assert_eq!(
            words(By::Spread),
            "the reference is known to 8.32 mm only: starts moved by a little end so far apart, in other states of rest"
        );
        assert_eq!(
            words(By::Neighbours),
            "the reference is known to 8.32 mm only: meshes a fiftieth finer or coarser end so far from it, in other states of rest"
        );
    }
}

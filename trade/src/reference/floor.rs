//! The error below which figures against a reference mean nothing.
//!
//! It is the greatest of what is known of the reference's own fault: what its finest level still
//! lacks (Richardson), or, where its levels show no order, what it would lack if its last
//! refinement were one of first order; and how far its own moved starts and its neighbours, a
//! little finer and coarser, end from it.
//!
//! Why first order: the last move alone says too little. A vest whose last refinement, of 4 to 6
//! parts of an edge, moved it by 0.39 mm lay 0.84 mm from one of 16 parts (0.78 at first order),
//! and one whose last refinement by a root of two moved it by 3.9 mm went on by 20 mm (9.4).

use crate::record::{NeighbourLevels, OwnSpread, Reference};
use crate::reference::richardson::{RefinementStep, at_first_order};

/// How well a reference is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// 95 % of the surface, millimetres.
    pub mm: f64,
    /// What it rests on.
    pub by: FloorBasis,
}

/// What a floor rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FloorBasis {
    /// What the finest level still lacks.
    Missing,
    /// What it would lack at first order by its last refinement, for its levels show none.
    Unordered,
    /// The spread of its moved starts.
    Spread,
    /// How far neighbouring resolutions end from it.
    Neighbours,
    /// Nothing: it was never refined.
    Nothing,
}

impl Floor {
    /// "the reference is known to 8.32 mm only: its levels show no order, and at first order so
    /// much is missing".
    pub fn words(&self) -> String {
        let why = match self.by {
            FloorBasis::Nothing => {
                return "nothing tells how well the reference is known: it was not refined".into();
            }
            FloorBasis::Missing => "so much is missing from its finest level to the limit of its order",
            FloorBasis::Unordered => "its levels show no order, and at first order so much is missing",
            FloorBasis::Spread => "starts moved by a little end so far apart, in other states of rest",
            FloorBasis::Neighbours => {
                "meshes a fiftieth finer or coarser end so far from it, in other states of rest"
            }
        };
        format!("the reference is known to {:.2} mm only: {why}", self.mm)
    }

    /// What can be done to lower it.
    pub fn remedy(&self) -> &'static str {
        match self.by {
            FloorBasis::Missing | FloorBasis::Unordered => {
                "measure into another --out with a longer --budget, so that it is refined further"
            }
            FloorBasis::Nothing => {
                "give `toile trade` a knob that is a resolution, such as an edge length, and room to refine it"
            }
            FloorBasis::Spread | FloorBasis::Neighbours => {
                "no refinement lowers that: it is the garment's own"
            }
        }
    }
}

impl Reference {
    /// How well it is known; none where neither its levels nor moved starts tell. Of a reference of
    /// one level nothing is known, however well its moved starts agree: the floor is infinite.
    pub fn floor(&self) -> Option<Floor> {
        if self.levels.len() == 1 {
            return Some(Floor { mm: f64::INFINITY, by: FloorBasis::Nothing });
        }
        let spread =
            self.spread.as_ref().and_then(OwnSpread::p95).map(|mm| Floor { mm, by: FloorBasis::Spread });
        let near = self.neighbours.as_ref().and_then(NeighbourLevels::p95);
        let near = near.map(|mm| Floor { mm, by: FloorBasis::Neighbours });
        self.lacks().into_iter().chain(spread).chain(near).reduce(|a, b| if b.mm > a.mm { b } else { a })
    }

    fn lacks(&self) -> Option<Floor> {
        let unordered = || Some(Floor { mm: self.missing_at_first_order()?, by: FloorBasis::Unordered });
        self.p95.map(|o| Floor { mm: o.missing_mm, by: FloorBasis::Missing }).or_else(unordered)
    }

    fn missing_at_first_order(&self) -> Option<f64> {
        let level = self.levels.last()?;
        let finer = level.finer.unwrap_or(self.ratio);
        Some(at_first_order(RefinementStep { distance: level.moved_mm?.p95, ratio: finer }))
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
    use crate::record::{Order, ReferenceLevel};

    fn moved(p95: Option<f64>) -> ReferenceLevel {
        let moved_mm = p95.map(|p95| Millimetres { p95, ..Millimetres::default() });
        ReferenceLevel { moved_mm, finer: moved_mm.map(|_| 1.5), ..ReferenceLevel::default() }
    }

    fn reference(levels: Vec<ReferenceLevel>, missing: Option<f64>, start: Option<f64>) -> Reference {
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
        assert_eq!(floor(Some(0.2), Some(5.8)), Some(Floor { mm: 5.8, by: FloorBasis::Spread }));
        assert_eq!(floor(Some(0.2), Some(0.0)), Some(Floor { mm: 0.2, by: FloorBasis::Missing }));
        // Levels that do not come nearer: quiet starts do not make them a reference. Half as fine
        // again would be a third of the way to the limit at first order.
        assert_eq!(floor(None, Some(0.0)), Some(Floor { mm: 2.0 * 8.32, by: FloorBasis::Unordered }));
        // Quiet starts of one level do not make it known.
        let alone = reference(vec![moved(None)], None, Some(0.1));
        assert_eq!(alone.floor(), Some(Floor { mm: f64::INFINITY, by: FloorBasis::Nothing }));
        assert_eq!((alone.floor_mm(), Reference::default().floor()), (None, None));
        // Levels that come nearer, while the mesh picks the state of rest.
        let apart_mm = [0.4, 6.9].map(|p95| Millimetres { p95, ..Millimetres::default() }).to_vec();
        let near = Some(NeighbourLevels { apart_mm, ..NeighbourLevels::default() });
        let picked = Reference { neighbours: near, ..reference(levels(), Some(0.2), Some(0.1)) };
        assert_eq!(picked.floor(), Some(Floor { mm: 6.9, by: FloorBasis::Neighbours }));
    }

    #[test]
    fn words_and_remedies() {
        let words = |by| Floor { mm: 8.321, by }.words();
        assert_eq!(
            words(FloorBasis::Unordered),
            "the reference is known to 8.32 mm only: its levels show no order, and at first order so much is missing"
        );
        assert_eq!(
            words(FloorBasis::Missing),
            "the reference is known to 8.32 mm only: so much is missing from its finest level to the limit of its order"
        );
        assert_eq!(
            words(FloorBasis::Nothing),
            "nothing tells how well the reference is known: it was not refined"
        );
        assert_eq!(
            words(FloorBasis::Spread),
            "the reference is known to 8.32 mm only: starts moved by a little end so far apart, in other states of rest"
        );
        assert_eq!(
            words(FloorBasis::Neighbours),
            "the reference is known to 8.32 mm only: meshes a fiftieth finer or coarser end so far from it, in other states of rest"
        );
    }
}

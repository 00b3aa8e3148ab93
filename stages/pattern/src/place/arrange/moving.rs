//! Pieces that are moved to the body's limbs, and the start without that.
//!
//! Whether a piece is one of a leg is guessed from labels, seams and places. So that move has its
//! alternative: the pieces where the pattern puts them. The stage that sews the garment tries both.
//! Sleeves have none: flat beside the arm, they sew worse in all garments that were tried.

use super::limb::Limb;
use super::{PiecePlaces, legs, tubes};
use crate::place::sew::Offsets;
use toile_core::prelude::*;

/// What the moves go by.
pub(super) struct Moving<'a> {
    pub(super) body: &'a Body,
    pub(super) pattern: &'a Pattern,
    pub(super) seams: &'a [GarmentSeam],
    pub(super) offsets: &'a Offsets<'a>,
    /// The sleeves of a pattern without places, each with the hand of its arm.
    pub(super) sleeves: Option<&'a [(String, Hand)]>,
    /// Least distance of a bent piece from the arm, metres.
    pub(super) clearance: f64,
}

/// Places, and what was moved, in words.
type Moved = (PiecePlaces, Vec<String>);

impl Moving<'_> {
    /// The pieces moved to legs and arms; and, where legs were moved, the places without that, in
    /// words.
    pub(super) fn moved_and_others(&self, places: &PiecePlaces) -> (Moved, Vec<(&'static str, PiecePlaces)>) {
        let (swung, mut told) = self.swung(places.clone());
        let others = match told.is_empty() {
            true => Vec::new(),
            false => vec![("with the legs where the pattern puts them", self.bent(places.clone()).0)],
        };
        let (places, of_arms) = self.bent(swung);
        told.extend(of_arms);
        ((places, told), others)
    }

    /// Halves of legs that miss the body's, swung before them.
    fn swung(&self, mut places: PiecePlaces) -> Moved {
        let told = legs::swing(self.pattern, self.body, &mut places, self.seams, self.offsets);
        (places, told)
    }

    /// Sleeves and cuffs, bent around the arms.
    fn bent(&self, mut places: PiecePlaces) -> Moved {
        let mut told = Vec::new();
        for limb in Limb::arms(self.body) {
            let mine = match self.sleeves {
                Some(all) => all.iter().filter(|s| s.1 == limb.hand).map(|s| s.0.clone()).collect(),
                None => tubes::around(&limb, self.pattern, &places),
            };
            let sewn = tubes::bend(&limb, &mine, &mut places, self.seams, self.offsets, self.clearance);
            told.extend(sewn);
        }
        (places, told)
    }
}

//! Pieces that are moved to the body's limbs, and the start without that.
//!
//! Whether a piece is one of a leg is guessed from labels, seams and places. So that move has its
//! alternative: the pieces where the pattern puts them. The stage that sews the garment tries both.
//! Sleeves have none: flat beside the arm, they sew worse in all garments that were tried.

use super::limb::Limb;
use super::move_input::MoveInput;
use super::narrow::Narrow;
use super::{PiecePlaces, legs, tubes};

/// Pieces that were moved.
pub(super) struct Moved {
    pub(super) places: PiecePlaces,
    /// What was moved, in words.
    pub(super) told: Vec<String>,
    /// What is narrowest beside the arm that it goes around: the names of the pieces, and where.
    pub(super) narrowest: Option<(String, Narrow)>,
}

/// Places without a move that was made, in words.
pub(super) type Others = Vec<(&'static str, PiecePlaces)>;

impl MoveInput<'_> {
    /// The pieces moved to legs and arms; and, where legs were moved, the places without that, in
    /// words.
    pub(super) fn moved_and_others(&self, places: &PiecePlaces) -> (Moved, Others) {
        let (swung, told) = self.swung(places.clone());
        let others = match told.is_empty() {
            true => Vec::new(),
            false => vec![(
                "with the legs where the pattern puts them",
                self.bent(places.clone(), Vec::new()).places,
            )],
        };
        (self.bent(swung, told), others)
    }

    /// Halves of legs that miss the body's, swung before them.
    fn swung(&self, mut places: PiecePlaces) -> (PiecePlaces, Vec<String>) {
        let told = legs::swing(self.pattern, self.body, &mut places, self.seams, self.offsets);
        (places, told)
    }

    /// Sleeves and cuffs, bent around the arms.
    pub(super) fn bent(&self, mut places: PiecePlaces, mut told: Vec<String>) -> Moved {
        let mut narrowest: Option<(String, Narrow)> = None;
        for limb in Limb::arms(self.body) {
            let mine = match self.sleeves {
                Some(all) => all.iter().filter(|s| s.1 == limb.hand).map(|s| s.0.clone()).collect(),
                None => tubes::around(&limb, self.pattern, &places),
            };
            let done = tubes::bend(&limb, &mine, &mut places, self);
            for tube in done {
                told.push(tube.told);
                let is_more = |n: &Narrow| narrowest.as_ref().is_none_or(|m| n.stretch() > m.1.stretch());
                if let Some(narrow) = tube.narrow.filter(is_more) {
                    narrowest = Some((tube.names, narrow));
                }
            }
        }
        Moved { places, told, narrowest }
    }
}

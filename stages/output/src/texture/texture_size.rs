//! Rule `texture-size`: textures of no more pixels than are requested.
//!
//! Fact: the photos' longer side has more pixels than `size`, by more than what the room around the
//! garment may account for. Then the panel's part of its photo is scaled down, and everything
//! behind it (bleeding, light, files) works on so many pixels. Tolerance: the root mean square
//! difference of the texture in grey levels; the scaled texture lacks the grain of camera and weave
//! below its own pixels. Source: area average (Williams 1983).

use toile_core::Known;
use toile_core::cost::{Quantity, Size};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};
use toile_image::photo::frames;

/// How much longer than the garment a photo's frame may be.
const ROOM: f64 = 1.25;
/// Largest size that the parameter takes, px.
pub(super) const LARGEST: u32 = 8192;
/// Grey levels that grain and weave make up.
const GRAIN: f64 = 4.0;

/// The decision for textures of at most `size` px, where the photos are larger.
pub(super) fn rule(known: &Known<'_>, size: u32) -> Option<Decision> {
    if !known.is_wired("photos") {
        return None;
    }
    let read = |node: &toile_core::Node| frames(node.card.name, &node.stage.params(), known.cx);
    let longest = known.before().find_map(read)?.iter().map(|((w, h), _)| *w.max(h)).max()?;
    is_larger(longest, size).then(|| Decision {
        rule: "texture-size".into(),
        state: State::Simplified,
        what: format!("textures: at most {size} px to a side"),
        fact: format!("the photos' longer side has {longest} px"),
        tolerance: Tolerance::Texture(GRAIN),
        saves: Saves::Modelled,
        source: "area average: Williams 1983".into(),
        turn: Turn::Param { name: "size".into(), value: LARGEST.to_string() },
    })
}

/// Texels of a photo's pixel: the garment's box; and of a texture's square.
const SHARES: [f64; 2] = [0.8, 0.85];

/// The sizes behind the stage: textures have what the photos hold, and no more than is requested.
pub(super) fn foreseen(given: &Size, size: u32) -> Option<Size> {
    let (pixels, pieces) = (given.get(Quantity::Pixels)?, given.get(Quantity::Pieces)?);
    let most = SHARES[1] * f64::from(size) * f64::from(size) * pieces;
    Some(given.clone().with(Quantity::Texels, (SHARES[0] * pixels).min(most)))
}

fn is_larger(longest: u32, size: u32) -> bool {
    f64::from(longest) > ROOM * f64::from(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_photo_is_larger_by_more_than_the_room_around_the_garment() {
        assert!(is_larger(2561, 2048));
        assert!(!is_larger(2560, 2048));
    }
}

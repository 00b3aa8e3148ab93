//! Rule `joined-pixels`: image work at no more resolution than the garment's mesh can hold.
//!
//! Fact: the photos' pixels are so fine that several of them, joined, are still no wider than
//! `pixel` (half a millimetre: a thirtieth of the usual edge length). Then the photos are joined
//! for all that looks for the outline; textures are taken from the photos as they were read.
//! Tolerance: an edge is found within a fraction of a pixel of its place (Canny 1986), so 95 % of
//! the outline stay within [`MOST_MOVED`]. Source: sampling at what is to be resolved (Nyquist
//! 1928; Shannon 1949).

use super::join::joint_of;
use crate::photo::frames;
use toile_core::Known;
use toile_core::cost::{Quantity, Size, garment_area};
use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};

/// What 95 % of the outline keep, metres.
const MOST_MOVED: f64 = 1e-3;

/// The decision on the photos before the stage, where they are large enough.
pub(super) fn rule(known: &Known<'_>, pixel: f64) -> Option<Decision> {
    let read = |node: &toile_core::Node| frames(node.card.name, &node.stage.params(), known.cx);
    let frames = known.before().find_map(read)?;
    let joint =
        |((w, h), width): &((u32, u32), f64)| (joint_of((*w, *h), *width, pixel), width / f64::from(*w));
    let (n, finest) = frames.iter().map(joint).max_by(|a, b| a.0.cmp(&b.0))?;
    (n > 1).then(|| Decision {
        rule: "joined-pixels".into(),
        state: State::Simplified,
        what: format!("photos for the outline: {n} x {n} pixels joined"),
        fact: format!(
            "pixels of about {:.2} mm, no more than {:.2} mm is asked for",
            finest * 1e3,
            pixel * 1e3
        ),
        tolerance: Tolerance::Outline(MOST_MOVED),
        saves: Saves::Modelled,
        source: "sampling: Nyquist 1928; Canny 1986".into(),
        turn: Turn::Param { name: "pixel".into(), value: "\"0 mm\"".into() },
    })
}

/// The sizes behind the stage, by the area and the pixels of the photos, all sides alike.
pub(super) fn foreseen(given: &Size, pixel: f64) -> Option<Size> {
    let [pixels, area, pieces] =
        [Quantity::Pixels, Quantity::Area, Quantity::Pieces].map(|q| given.get(q).filter(|a| *a > 0.0));
    let (pixels, each_area, each) = (pixels?, area? / pieces?, pixels? / pieces?);
    // A frame as high as it is wide has this width, px and metres.
    let (side, width) = (each.sqrt(), (each_area / garment_area(1.0, 1.0, 1.0)).sqrt());
    let n = f64::from(joint_of((side as u32, side as u32), width, pixel));
    Some(given.clone().with(Quantity::Pixels, pixels / (n * n)))
}

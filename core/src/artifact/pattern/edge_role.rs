//! What an edge of a piece is to a tailor.

use crate::artifact::Hand;
use std::fmt::{Display, Formatter};

/// What an edge of a garment's piece is, in a tailor's word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeRole {
    /// The lowest edge of a garment.
    Hem,
    /// From hem or waist to armpit.
    Side,
    /// Of a dress, from hem to waist.
    Skirt,
    /// From the fork to the hem, on the inside of a leg.
    Inseam,
    /// From the hem to the hip, on the outside of a leg.
    Outseam,
    /// From side or outseam to the waist.
    Hip,
    /// Around the waist.
    Waist,
    /// From the fork to the waist, in the middle of trousers.
    Rise,
    /// From armpit to shoulder, on the trunk.
    Armhole,
    /// From armpit to shoulder, on the sleeve.
    Cap,
    /// From armpit to cuff.
    Underarm,
    /// Around the wrist, or where a sleeve ends.
    Cuff,
    /// From cuff to shoulder, along the top of a sleeve.
    Top,
    /// From armhole or sleeve to neck.
    Shoulder,
    /// Around the neck.
    Neck,
    /// Of a hood, from the neck over the head to its opening, where its halves are sewn together.
    Crown,
    /// Of a hood, its opening.
    Face,
    /// Where the halves of a front are closed.
    Middle,
    /// Of a band, where it is sewn to what it holds.
    Joint,
    /// Of a band, its short edge.
    End,
}

impl EdgeRole {
    /// A tailor's word.
    pub const fn word(self) -> &'static str {
        match self {
            EdgeRole::Hem => "hem",
            EdgeRole::Side => "side",
            EdgeRole::Skirt => "skirt",
            EdgeRole::Inseam => "inseam",
            EdgeRole::Outseam => "outseam",
            EdgeRole::Hip => "hip",
            EdgeRole::Waist => "waist",
            EdgeRole::Rise => "rise",
            EdgeRole::Armhole => "armhole",
            EdgeRole::Cap => "cap",
            EdgeRole::Underarm => "underarm",
            EdgeRole::Cuff => "cuff",
            EdgeRole::Top => "top",
            EdgeRole::Shoulder => "shoulder",
            EdgeRole::Neck => "neck",
            EdgeRole::Crown => "crown",
            EdgeRole::Face => "face",
            EdgeRole::Middle => "middle",
            EdgeRole::Joint => "joint",
            EdgeRole::End => "end",
        }
    }

    /// The name of an edge; with its side where the piece has one such edge on each: `side_left`.
    pub fn name(self, hand: Option<Hand>) -> String {
        hand.map_or_else(|| self.word().to_owned(), |hand| hand.name(self.word()))
    }
}

impl Display for EdgeRole {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

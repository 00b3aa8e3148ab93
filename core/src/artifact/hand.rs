//! The two sides of a body.

use std::fmt::{Display, Formatter};

/// A side of the body, as its wearer calls it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Hand {
    /// At positive x.
    Left,
    /// At negative x.
    Right,
}

impl Hand {
    /// Both, the left one first.
    pub const BOTH: [Hand; 2] = [Hand::Left, Hand::Right];

    /// `left` or `right`.
    pub const fn word(self) -> &'static str {
        if matches!(self, Hand::Left) { "left" } else { "right" }
    }

    /// The sign of x there.
    pub const fn sign(self) -> f64 {
        if matches!(self, Hand::Left) { 1.0 } else { -1.0 }
    }

    /// The side on which `x` lies, a distance from the middle of the body.
    pub fn of(x: f64) -> Hand {
        if x > 0.0 { Hand::Left } else { Hand::Right }
    }

    /// The other side.
    pub const fn other(self) -> Hand {
        if matches!(self, Hand::Left) { Hand::Right } else { Hand::Left }
    }

    /// The name of what a body or a piece has on both sides: `shoulder_left`.
    pub fn name(self, of: &str) -> String {
        format!("{of}_{self}")
    }

    /// What [`Hand::name`] made a name of; a name without a side is its own.
    pub fn split(name: &str) -> (&str, Option<Hand>) {
        let on = |hand: Hand| Some((name.strip_suffix(hand.word())?.strip_suffix('_')?, Some(hand)));
        Hand::BOTH.into_iter().find_map(on).unwrap_or((name, None))
    }
}

impl Display for Hand {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split_into_what_they_were_made_of() {
        for hand in Hand::BOTH {
            assert_eq!(Hand::split(&hand.name("neck")), ("neck", Some(hand)));
            assert_eq!((hand.other().other(), Hand::of(hand.sign())), (hand, hand));
        }
        assert_eq!(Hand::split("waist_front"), ("waist_front", None));
        assert_eq!(Hand::split("left"), ("left", None));
    }
}

//! What the pieces of a block are.

use toile_core::artifact::{BodyPart, Hand};

/// The layer of a garment: before the wearer or behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layer {
    Front,
    Back,
}

impl Layer {
    pub(crate) const BOTH: [Layer; 2] = [Layer::Front, Layer::Back];

    pub(crate) const fn word(self) -> &'static str {
        match self {
            Layer::Front => "front",
            Layer::Back => "back",
        }
    }

    /// The layer of a panel of that name.
    pub(crate) fn of_name(panel: &str) -> Layer {
        if panel.to_lowercase().contains(Layer::Back.word()) { Layer::Back } else { Layer::Front }
    }

    /// The wearer's side that lies at positive u, or at negative.
    pub(crate) fn hand(self, k: usize) -> Hand {
        match (self, k) {
            (Layer::Front, 0) | (Layer::Back, 1) => Hand::Left,
            _ => Hand::Right,
        }
    }
}

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PieceRole {
    /// Front or back from side to side.
    Whole(Layer),
    /// A half of it, closed along the middle.
    Half(Layer, Hand),
    Sleeve(Layer, Hand),
    Leg(Layer, Hand),
    /// Half of a hood, which the photo of the front shows.
    Hood(Hand),
    /// The waistband of a layer.
    Band(Layer),
}

impl PieceRole {
    /// The name that people know it by.
    pub(crate) fn name(self) -> String {
        match self {
            PieceRole::Whole(layer) => layer.word().to_owned(),
            PieceRole::Half(layer, hand) => format!("{hand}_{}", layer.word()),
            PieceRole::Sleeve(layer, hand) => format!("{hand}_sleeve_{}", layer.word()),
            PieceRole::Leg(layer, hand) => format!("{hand}_leg_{}", layer.word()),
            PieceRole::Hood(hand) => format!("{hand}_hood_{}", Layer::Front.word()),
            PieceRole::Band(layer) => format!("band_{}", layer.word()),
        }
    }

    /// The piece behind one in front; none behind one that is at the back. Both halves of a front
    /// have one back.
    pub(crate) fn behind(self) -> Option<PieceRole> {
        Some(match self {
            PieceRole::Whole(Layer::Front) | PieceRole::Half(Layer::Front, _) => {
                PieceRole::Whole(Layer::Back)
            }
            PieceRole::Sleeve(Layer::Front, hand) => PieceRole::Sleeve(Layer::Back, hand),
            PieceRole::Leg(Layer::Front, hand) => PieceRole::Leg(Layer::Back, hand),
            PieceRole::Band(Layer::Front) => PieceRole::Band(Layer::Back),
            _ => return None,
        })
    }

    /// What of the body it covers.
    pub(crate) fn part(self) -> BodyPart {
        match self {
            PieceRole::Sleeve(..) => BodyPart::Arm,
            PieceRole::Leg(..) => BodyPart::Leg,
            PieceRole::Hood(_) => BodyPart::Head,
            PieceRole::Whole(_) | PieceRole::Half(..) | PieceRole::Band(_) => BodyPart::Body,
        }
    }
}

//! How much of what there is.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Share of a photo's frame that the garment's outline encloses, the scale being such that the
/// garment is as wide as the frame.
const FILL: f64 = 0.745;

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Sides of the garment: photos, outlines, panels.
    Pieces,
    /// Pixels of photos and masks.
    Pixels,
    /// Bytes of the files that are read.
    Bytes,
    /// Pixels of the files that are read: a side that is another's mirror image reads none.
    Decoded,
    /// Area of the garment's pattern, square metres.
    Area,
    /// Points of outlines.
    Points,
    /// Triangles of panels and garments.
    Triangles,
    /// Triangles of the body.
    BodyTriangles,
    /// Pixels of the model's textures.
    Texels,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Quantity; 9] = [
        Quantity::Pieces,
        Quantity::Pixels,
        Quantity::Bytes,
        Quantity::Decoded,
        Quantity::Area,
        Quantity::Points,
        Quantity::Triangles,
        Quantity::BodyTriangles,
        Quantity::Texels,
    ];
}

/// Named amounts. What something is made of counts with it: a garment has the pixels of its photos.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Size(BTreeMap<Quantity, f64>);

impl Size {
    /// Nothing known.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with an amount; one that is no finite number of at least 0 is left out.
    #[must_use]
    pub fn with(mut self, quantity: Quantity, amount: f64) -> Self {
        if amount.is_finite() && amount >= 0.0 {
            self.0.insert(quantity, amount);
        }
        self
    }

    /// An amount, where it is known.
    pub fn get(&self, quantity: Quantity) -> Option<f64> {
        self.0.get(&quantity).copied().filter(|a| a.is_finite() && *a >= 0.0)
    }

    /// Both together, as of two entries of a set: amounts add up.
    #[must_use]
    pub fn plus(self, other: &Size) -> Self {
        other.iter().fold(self, |sum, (q, a)| {
            let own = sum.get(q).unwrap_or(0.0);
            sum.with(q, own + a)
        })
    }

    /// Both together, as of two ports that may go back to the same photo: of each quantity the
    /// greater.
    #[must_use]
    pub fn joined(self, other: &Size) -> Self {
        other.iter().fold(self, |all, (q, a)| {
            let own = all.get(q).unwrap_or(0.0);
            all.with(q, own.max(a))
        })
    }

    /// The same where `better` knows nothing, and else what that knows.
    #[must_use]
    pub fn corrected(self, better: &Size) -> Self {
        better.iter().fold(self, |all, (q, a)| all.with(q, a))
    }

    /// Its amounts in order.
    pub fn iter(&self) -> impl Iterator<Item = (Quantity, f64)> + '_ {
        Quantity::ALL.into_iter().filter_map(|q| Some((q, self.get(q)?)))
    }

    /// True where nothing is known.
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }
}

/// A guess at a garment's area, square metres, from its photo's size, px, and its real width,
/// metres.
///
/// The garment fills its photo about as well from side to side as from top to bottom.
pub fn garment_area(width_px: f64, height_px: f64, garment_width: f64) -> f64 {
    let ratio = (height_px / width_px).clamp(0.3, 3.0);
    FILL * garment_width * garment_width * ratio
}

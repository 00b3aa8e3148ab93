//! How likely each style is by what the network sees in the photo.
//!
//! The network names the kind of a garment as people do; a style is a way to cut one. A kind gives
//! its probability to every style that cuts garments of that kind. Beside the fit of a template to
//! the outline, which tells forms apart that look alike in a photo, it tells what an outline
//! cannot: shorts whose legs touch from a skirt. Cost: that of `toile_recognise::see`, some 40 ms.

use super::BlockStyle;
use toile_core::prelude::*;
use toile_recognise::{GarmentKind, SeenGarment};

/// What a style's improbability adds to the score of its fit, by the natural logarithm.
const WEIGHT: f64 = 0.4;
/// No style is less probable than this: the network was trained on few garments of some kinds.
const LEAST: f64 = 0.002;
/// So many of the likeliest kinds are tried before the others.
const FIRST: usize = 3;
/// What is less probable is no guess.
const SHOWN: f64 = 0.05;
/// From this probability of a style on, the network says what the garment is.
const SURE: f64 = 0.6;
/// A style that is less probable cuts another garment than the network sees, where that one is
/// sure. Of 558 photos of senders kept out of training, the right style of 7 is contradicted so,
/// and 74 % of wrong styles are.
const ANOTHER: f64 = 0.1;
/// And so does a style that is less probable than this, whether the network is sure or not.
const NEVER: f64 = 0.03;

/// A photo, and what the network sees in it; nothing where it is not to look.
pub(in crate::style) struct SeenPhoto<'p> {
    pub photo: &'p Photo,
    pub seen: Option<SeenGarment>,
}

impl<'p> SeenPhoto<'p> {
    /// Of a photo; `network` says whether the network is to look.
    pub(super) fn of(photo: &'p Photo, network: bool) -> Result<Self, StageError> {
        let threads = rayon::current_num_threads();
        let look = |photo: &Photo| toile_recognise::see(&photo.pixels, threads);
        let seen = network.then(|| look(photo)).transpose();
        let seen = seen.map_err(|e| StageError::internal(format!("the network: {e}")))?;
        Ok(SeenPhoto { photo, seen })
    }
}

/// How likely each kind is.
pub(super) struct Likely(Vec<(GarmentKind, f64)>);

impl Likely {
    /// Of what the network sees.
    pub(super) fn of(seen: &SeenGarment) -> Likely {
        Likely(seen.kinds().to_vec())
    }

    /// The probability that a garment of that style was seen.
    pub(super) fn style(&self, name: &str) -> f64 {
        let cuts = |kind: &GarmentKind| styles(*kind).iter().any(|s| s.name() == name);
        self.0.iter().filter(|(kind, _)| cuts(kind)).map(|(_, p)| p).sum()
    }

    /// The usual styles of the kinds, likeliest first.
    fn usual_styles(&self) -> Vec<(&'static str, f64)> {
        let mut all: Vec<(&'static str, f64)> = Vec::new();
        for (kind, p) in &self.0 {
            let name = styles(*kind)[0].name();
            match all.iter_mut().find(|(other, _)| *other == name) {
                Some((_, sum)) => *sum += p,
                None => all.push((name, *p)),
            }
        }
        all.retain(|(_, p)| *p >= SHOWN);
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all
    }

    /// Whether it cuts garments of one of the likeliest kinds.
    pub(super) fn is_likely(&self, name: &str) -> bool {
        let first = self.0.iter().take(FIRST).filter(|(_, p)| *p >= LEAST);
        first.flat_map(|(kind, _)| styles(*kind)).any(|s| s.name() == name)
    }

    /// What its improbability adds to the score of a fit.
    pub(super) fn price(&self, name: &str) -> f64 {
        -WEIGHT * self.style(name).max(LEAST).ln()
    }

    /// Whether the network says that the garment is of that style.
    pub(super) fn is_sure_of(&self, name: &str) -> bool {
        self.style(name) >= SURE
    }

    /// The kind that the network sees instead of that style, with its probability.
    pub(super) fn instead_of(&self, name: &str) -> Option<(GarmentKind, f64)> {
        let first = self.0.first().copied()?;
        let is_sure = BlockStyle::NAMED.iter().any(|(_, other, _)| self.is_sure_of(other));
        let least = if is_sure { ANOTHER } else { NEVER };
        (self.style(name) < least).then_some(first)
    }
}

/// The styles that a network sees in a photo, likeliest first, each with its probability from 0.05
/// to 1. A kind of garment counts for the style that is the usual way to cut it.
///
/// Errors: the network cannot be run.
pub fn seen_styles(photo: &Photo) -> Result<Vec<(&'static str, f64)>, StageError> {
    let seen = SeenPhoto::of(photo, true)?.seen;
    Ok(seen.map_or_else(Vec::new, |seen| Likely::of(&seen).usual_styles()))
}

/// The styles that cut garments of a kind, the usual one first.
fn styles(kind: GarmentKind) -> &'static [BlockStyle] {
    use BlockStyle as S;
    match kind {
        GarmentKind::Tshirt => &[S::TShirt, S::GrownSleeve],
        GarmentKind::Polo => &[S::TShirt, S::GrownSleeve],
        GarmentKind::Longsleeve => &[S::LongSleeve],
        // A hood may lie folded behind the neck.
        GarmentKind::Hoodie => &[S::Hooded, S::LongSleeve],
        GarmentKind::Shirt => &[S::LongSleeve, S::TShirt],
        GarmentKind::Jacket => &[S::LongSleeve, S::Hooded, S::Vest],
        GarmentKind::Sleeveless => &[S::Vest, S::GrownSleeve],
        // Without a waist it is cut as a long top.
        GarmentKind::Dress => &[S::Dress, S::SleevedDress, S::Vest, S::TShirt, S::LongSleeve, S::GrownSleeve],
        GarmentKind::Skirt => &[S::Skirt],
        GarmentKind::Trousers | GarmentKind::Shorts => &[S::Trousers],
        GarmentKind::Onepiece => &[S::Onepiece, S::SleevelessOnepiece],
    }
}

/// A kind with its article.
pub(super) fn word(kind: GarmentKind) -> &'static str {
    match kind {
        GarmentKind::Tshirt => "a T-shirt",
        GarmentKind::Polo => "a polo shirt",
        GarmentKind::Longsleeve => "a top with long sleeves",
        GarmentKind::Shirt => "a shirt",
        GarmentKind::Sleeveless => "a top without sleeves",
        GarmentKind::Dress => "a dress",
        GarmentKind::Skirt => "a skirt",
        GarmentKind::Trousers => "a pair of trousers",
        GarmentKind::Shorts => "a pair of shorts",
        GarmentKind::Jacket => "a jacket",
        GarmentKind::Hoodie => "a top with a hood",
        GarmentKind::Onepiece => "a one-piece",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn likely(kinds: &[(GarmentKind, f64)]) -> Likely {
        Likely(kinds.to_vec())
    }

    #[test]
    fn every_style_cuts_some_kind_and_every_kind_is_cut() {
        for (_, name, _) in BlockStyle::NAMED {
            assert!(GarmentKind::ALL.iter().any(|k| styles(*k).iter().any(|s| s.name() == name)), "{name}");
        }
        assert!(GarmentKind::ALL.iter().all(|k| !styles(*k).is_empty()));
    }

    #[test]
    fn kinds_count_for_the_usual_way_to_cut_them() {
        let seen = likely(&[
            (GarmentKind::Tshirt, 0.5),
            (GarmentKind::Dress, 0.3),
            (GarmentKind::Polo, 0.16),
            (GarmentKind::Skirt, 0.04),
        ]);
        let styles = seen.usual_styles();
        assert_eq!(styles.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["TShirt", "Dress"]);
        assert!((styles[0].1 - 0.66).abs() < 1e-12);
    }

    #[test]
    fn kinds_that_are_cut_alike_add_up() {
        let seen =
            likely(&[(GarmentKind::Longsleeve, 0.5), (GarmentKind::Jacket, 0.4), (GarmentKind::Skirt, 0.1)]);
        assert!((seen.style("LongSleeve") - 0.9).abs() < 1e-12);
        assert!(seen.is_sure_of("LongSleeve") && !seen.is_sure_of("Skirt"));
        assert!(seen.price("LongSleeve") < seen.price("Skirt"));
    }

    #[test]
    fn only_a_network_that_is_sure_contradicts_an_outline() {
        let doubtful =
            likely(&[(GarmentKind::Shorts, 0.5), (GarmentKind::Tshirt, 0.45), (GarmentKind::Skirt, 0.05)]);
        assert_eq!(doubtful.instead_of("Skirt"), None);
        assert_eq!(doubtful.instead_of("Onepiece"), Some((GarmentKind::Shorts, 0.5)));
        let sure = likely(&[(GarmentKind::Shorts, 0.97), (GarmentKind::Skirt, 0.03)]);
        assert_eq!(sure.instead_of("Skirt"), Some((GarmentKind::Shorts, 0.97)));
        assert_eq!(sure.instead_of("Trousers"), None);
    }
}

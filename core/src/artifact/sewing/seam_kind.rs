//! How the sides of a seam meet: one list for patterns, plans and garments.
//!
//! A stage that acts on a kind matches it without a wildcard, so that a new kind is found by the
//! compiler; one that cannot carry a kind out refuses it by [`SeamKind::word`].

use crate::artifact::store::sound::{Sound, finite_figure, positive};

/// How a pleat is laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PleatFold {
    /// All folds to one side.
    Knife,
    /// Two folds towards each other.
    Box,
}

/// How the sides of a seam meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeamKind {
    /// Equal lengths, point by point; a difference of up to 3 % is eased in evenly.
    Matched,
    /// The longer side is gathered evenly onto the shorter.
    Gathered,
    /// The two legs of a dart, which end in one point.
    Dart,
    /// Two lines of one piece are laid on each other and sewn, the cloth between them folded
    /// behind. The first side is a fold that is seen; of a box pleat the second is, too, and they
    /// meet in the middle.
    Pleat(PleatFold),
    /// A band that is shorter than the edge that it is sewn to and draws it in. Of one side it lies
    /// along an edge or an inner line; of more sides these are sewn to each other, too, and the
    /// first counts.
    Elastic {
        /// The band's length at rest as a share of the edge's, above 0.
        ratio: f64,
        /// Its stiffness: the force that stretches it to twice its length, N.
        stiffness: f64,
    },
    /// The edge of a piece that lies on another (the first side), sewn to a line inside that (the
    /// second).
    Patch,
    /// Matched, and pressed to stay folded.
    Folded {
        /// The angle between the sides' outsides at rest, radians: pi lies flat, 0 face to face.
        angle: f64,
    },
}

impl SeamKind {
    /// Its word in messages and records, such as `knife pleat`.
    pub fn word(self) -> &'static str {
        match self {
            SeamKind::Matched => "matched",
            SeamKind::Gathered => "gathered",
            SeamKind::Dart => "dart",
            SeamKind::Pleat(PleatFold::Knife) => "knife pleat",
            SeamKind::Pleat(PleatFold::Box) => "box pleat",
            SeamKind::Elastic { .. } => "elastic",
            SeamKind::Patch => "patch",
            SeamKind::Folded { .. } => "folded",
        }
    }

    /// Its figures, in the order in which they are declared.
    pub fn figures(self) -> Vec<f64> {
        match self {
            SeamKind::Matched
            | SeamKind::Gathered
            | SeamKind::Dart
            | SeamKind::Pleat(_)
            | SeamKind::Patch => Vec::new(),
            SeamKind::Elastic { ratio, stiffness } => vec![ratio, stiffness],
            SeamKind::Folded { angle } => vec![angle],
        }
    }

    /// The kind after it in the order of declaration, with figures that are to be replaced: a new
    /// kind is named here by the compiler.
    fn next(self) -> Option<Self> {
        Some(match self {
            SeamKind::Matched => SeamKind::Gathered,
            SeamKind::Gathered => SeamKind::Dart,
            SeamKind::Dart => SeamKind::Pleat(PleatFold::Knife),
            SeamKind::Pleat(PleatFold::Knife) => SeamKind::Pleat(PleatFold::Box),
            SeamKind::Pleat(PleatFold::Box) => SeamKind::Elastic { ratio: 1.0, stiffness: 1.0 },
            SeamKind::Elastic { .. } => SeamKind::Patch,
            SeamKind::Patch => SeamKind::Folded { angle: 1.0 },
            SeamKind::Folded { .. } => return None,
        })
    }

    /// The same kind with these figures; nothing where there are too many or too few.
    fn with(self, figures: &[f64]) -> Option<Self> {
        match (self, figures) {
            (SeamKind::Elastic { .. }, [ratio, stiffness]) => {
                Some(SeamKind::Elastic { ratio: *ratio, stiffness: *stiffness })
            }
            (SeamKind::Folded { .. }, [angle]) => Some(SeamKind::Folded { angle: *angle }),
            (kind, []) if kind.figures().is_empty() => Some(kind),
            _ => None,
        }
    }

    /// Every kind once, with figures that can be.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::successors(Some(SeamKind::Matched), |k| k.next())
    }

    /// The kind of such a word and figures.
    ///
    /// Errors: one sentence on a word that is none, or a wrong number of figures.
    pub fn of(word: &str, figures: &[f64]) -> Result<Self, String> {
        let Some(kind) = Self::all().find(|k| k.word() == word) else {
            return Err(format!("`kind` is \"{word}\", which is not one of its values"));
        };
        kind.with(figures)
            .ok_or_else(|| format!("`kind` is \"{word}\", to which {} figures do not belong", figures.len()))
    }

    /// Its figures can be.
    pub(crate) fn check(self) -> Sound {
        match self {
            SeamKind::Matched
            | SeamKind::Gathered
            | SeamKind::Dart
            | SeamKind::Pleat(_)
            | SeamKind::Patch => Ok(()),
            SeamKind::Elastic { ratio, stiffness } => {
                positive("ratio of an elastic band", ratio)?;
                positive("stiffness of an elastic band", stiffness)
            }
            SeamKind::Folded { angle } => finite_figure("angle of a folded seam", angle),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_comes_back_from_its_word_and_figures() {
        for kind in SeamKind::all() {
            assert_eq!(SeamKind::of(kind.word(), &kind.figures()).unwrap(), kind);
            assert!(kind.check().is_ok());
        }
        assert_eq!(SeamKind::all().count(), 8);
    }

    #[test]
    fn words_and_figures_that_are_none_are_refused() {
        let refused = |word, figures: &[f64]| SeamKind::of(word, figures).unwrap_err();
        assert_eq!(refused("glued", &[]), "`kind` is \"glued\", which is not one of its values");
        assert_eq!(refused("elastic", &[1.0]), "`kind` is \"elastic\", to which 1 figures do not belong");
        assert_eq!(refused("dart", &[1.0]), "`kind` is \"dart\", to which 1 figures do not belong");
        assert_eq!(
            SeamKind::Elastic { ratio: 0.0, stiffness: 1.0 }.check().unwrap_err(),
            "the ratio of an elastic band is 0, it must be above 0 and at most 1e9"
        );
    }
}

//! Which kinds of seams a solver carries out.

use toile_core::prelude::*;

/// Refuses a kind of seam that a stepping solver does not carry out. All join the pairs of seams,
/// some take elastic `bands`.
pub(crate) fn carries_out(kind: SeamKind, name: &str, bands: bool) -> Result<(), StageError> {
    match kind {
        SeamKind::Elastic { .. } if bands => Ok(()),
        SeamKind::Matched | SeamKind::Gathered | SeamKind::Dart | SeamKind::Pleat(_) | SeamKind::Patch => {
            Ok(())
        }
        SeamKind::Elastic { .. } | SeamKind::Folded { .. } => {
            let message = format!(
                "the seam {name} is of the kind \"{}\", which this solver does not carry out",
                kind.word()
            );
            Err(StageError::invalid(message)
                .hint("sew and drape with `StaticEquilibrium()`, or make it a matched seam"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_that_are_more_than_joined_pairs_are_refused_by_name() {
        for kind in [SeamKind::Elastic { ratio: 0.8, stiffness: 30.0 }, SeamKind::Folded { angle: 1.0 }] {
            let e = carries_out(kind, "a.b + c.d", false).err().map(|e| (e.message, e.hint));
            let message = format!(
                "the seam a.b + c.d is of the kind \"{}\", which this solver does not carry out",
                kind.word()
            );
            let hint = Some("sew and drape with `StaticEquilibrium()`, or make it a matched seam".to_owned());
            assert_eq!(e, Some((message, hint)));
        }
        let elastic = SeamKind::Elastic { ratio: 0.8, stiffness: 30.0 };
        assert!(carries_out(elastic, "a.b + c.d", true).is_ok(), "a band is an energy");
        let joined = [
            SeamKind::Matched,
            SeamKind::Gathered,
            SeamKind::Dart,
            SeamKind::Pleat(PleatFold::Knife),
            SeamKind::Pleat(PleatFold::Box),
            SeamKind::Patch,
        ];
        for kind in joined {
            assert!(carries_out(kind, "a.b + c.d", false).is_ok());
        }
    }
}

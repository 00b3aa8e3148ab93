//! Which kinds of seams a solver carries out.

use toile_core::prelude::*;

/// Refuses a kind of seam for solvers that join the pairs of seams, and do nothing else.
pub(crate) fn only_joins(kind: SeamKind, name: &str) -> Result<(), StageError> {
    match kind {
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
            let e = only_joins(kind, "a.b + c.d").err().map(|e| (e.message, e.hint));
            let message = format!(
                "the seam a.b + c.d is of the kind \"{}\", which this solver does not carry out",
                kind.word()
            );
            let hint = Some("sew and drape with `StaticEquilibrium()`, or make it a matched seam".to_owned());
            assert_eq!(e, Some((message, hint)));
        }
        let joined = [
            SeamKind::Matched,
            SeamKind::Gathered,
            SeamKind::Dart,
            SeamKind::Pleat(PleatFold::Knife),
            SeamKind::Pleat(PleatFold::Box),
            SeamKind::Patch,
        ];
        for kind in joined {
            assert!(only_joins(kind, "a.b + c.d").is_ok());
        }
    }
}

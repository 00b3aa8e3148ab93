//! Which kinds of seams the solvers carry out.

use toile_core::prelude::*;

/// Refuses a kind of seam that no solver carries out: all of them join its pairs, and do nothing else.
pub(crate) fn joined(kind: SeamKind, name: &str) -> Result<(), StageError> {
    match kind {
        SeamKind::Matched | SeamKind::Gathered | SeamKind::Dart => Ok(()),
        SeamKind::Pleat(_) | SeamKind::Elastic { .. } | SeamKind::Patch | SeamKind::Folded { .. } => {
            let message =
                format!("the seam {name} is of the kind \"{}\", which no solver carries out", kind.word());
            Err(StageError::invalid(message).hint("make it a matched or gathered seam, or take it out"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_that_no_solver_carries_out_are_refused_by_name() {
        let kinds = [
            SeamKind::Pleat(PleatFold::Knife),
            SeamKind::Pleat(PleatFold::Box),
            SeamKind::Elastic { ratio: 0.8, stiffness: 30.0 },
            SeamKind::Patch,
            SeamKind::Folded { angle: 1.0 },
        ];
        for kind in kinds {
            let e = joined(kind, "a.b + c.d").err().map(|e| (e.message, e.hint));
            let message =
                format!("the seam a.b + c.d is of the kind \"{}\", which no solver carries out", kind.word());
            let hint = Some("make it a matched or gathered seam, or take it out".to_owned());
            assert_eq!(e, Some((message, hint)));
        }
        for kind in [SeamKind::Matched, SeamKind::Gathered, SeamKind::Dart] {
            assert!(joined(kind, "a.b + c.d").is_ok());
        }
    }
}

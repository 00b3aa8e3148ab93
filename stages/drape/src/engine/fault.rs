//! The engine's errors as stage errors.

use toile_cloth::error::ClothError;
use toile_cloth::scene::{FieldFault, SceneError};
use toile_core::{ErrorCode, StageError, hint};
use toile_geometry::obj::OBJ_HINT;

/// A fault of the numbers that the engine was given.
pub fn cloth_error(error: &ClothError) -> StageError {
    let code = match error {
        ClothError::DegenerateTriangle { .. } | ClothError::ZeroLengthEdge { .. } => {
            ErrorCode::DegenerateTriangles
        }
        ClothError::InvalidParameter { .. } | ClothError::TimeStepUnstable { .. } => {
            ErrorCode::InvalidParameter
        }
        ClothError::StrainLimitExceeded { .. }
        | ClothError::NotConverged { .. }
        | ClothError::Factorization { .. }
        | ClothError::Diverged { .. } => ErrorCode::StaticEquilibrium,
        _ => ErrorCode::InvalidInput,
    };
    let text = error.to_string();
    match error {
        ClothError::Wind { .. } | ClothError::TriangleTwice { .. } => split(code, &text),
        _ => StageError::new(code, text),
    }
}

/// A scene file that cannot be used.
pub fn scene_error(error: &SceneError) -> StageError {
    let code = match error {
        SceneError::Cloth(e) => return cloth_error(e),
        SceneError::Fields(faults) => {
            let message = format!("not a garment-scene-1: {error}");
            return StageError::new(ErrorCode::PatternLoading, message).hint(meant(faults));
        }
        SceneError::File { .. } | SceneError::Form { .. } | SceneError::Format { .. } => {
            return StageError::new(ErrorCode::PatternLoading, error.to_string())
                .hint("docs/reference/scene.md describes the format");
        }
        SceneError::Obj(_) => {
            return StageError::new(ErrorCode::PatternLoading, error.to_string()).hint(OBJ_HINT);
        }
        SceneError::Unmerged { .. } => {
            let e = split(ErrorCode::InvalidInput, &error.to_string());
            let remedy = e.hint.clone().unwrap_or_default();
            return e.hint(format!("{remedy}, or let `weld: true` join them"));
        }
        _ => ErrorCode::InvalidInput,
    };
    split(code, &error.to_string())
}

/// An error of the engine, whose remedy stands behind the semicolon of its words.
pub fn split(code: ErrorCode, text: &str) -> StageError {
    match text.split_once("; ") {
        Some((text, hint)) => StageError::new(code, text).hint(hint),
        None => StageError::new(code, text),
    }
}

/// The names that were probably meant.
fn meant(faults: &[FieldFault]) -> String {
    let hint = |f: &FieldFault| match f.known {
        [] => format!("keep one `{}`", f.field),
        known => hint(&f.field, &format!("{} has", f.of), known)
            .unwrap_or_else(|| "docs/reference/scene.md describes the format".into()),
    };
    let mut hints: Vec<String> = faults.iter().map(hint).collect();
    hints.dedup();
    hints.join("; ")
}

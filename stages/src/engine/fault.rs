//! The engine's errors as stage errors.

use toile_cloth::error::ClothError;
use toile_cloth::scene::SceneError;
use toile_core::{ErrorCode, StageError};

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
    match (error, text.split_once("; ")) {
        (ClothError::Wind { .. }, Some((text, hint))) => StageError::new(code, text).hint(hint),
        _ => StageError::new(code, text),
    }
}

/// A scene file that cannot be used.
pub fn scene_error(error: &SceneError) -> StageError {
    match error {
        SceneError::Cloth(e) => cloth_error(e),
        SceneError::File { .. } | SceneError::Form { .. } | SceneError::Format { .. } => {
            StageError::new(ErrorCode::PatternLoading, error.to_string())
                .hint("docs/scene.md describes the format")
        }
        _ => StageError::invalid(error.to_string()),
    }
}

//! Faults of the flattening library as errors of stages.

use toile_core::prelude::*;
use toile_flatten::{FlattenError, SurfaceError};

/// The fault of a mesh whose triangles have these numbers in the file.
pub(super) fn surface_fault(e: SurfaceError, numbers: &[u32]) -> StageError {
    let of = |t: usize| numbers.get(t).map_or(t, |n| *n as usize);
    let in_file = match e {
        SurfaceError::Closed { triangle } => SurfaceError::Closed { triangle: of(triangle) },
        SurfaceError::NotOrientable { triangle } => SurfaceError::NotOrientable { triangle: of(triangle) },
        SurfaceError::Degenerate { triangle, quality } => {
            SurfaceError::Degenerate { triangle: of(triangle), quality }
        }
        other => other,
    };
    let code = match in_file {
        SurfaceError::Degenerate { .. } => ErrorCode::DegenerateTriangles,
        _ => ErrorCode::InvalidInput,
    };
    StageError::new(code, in_file.to_string()).hint(in_file.remedy())
}

/// The fault of flattening a piece.
pub(super) fn flatten_fault(e: &FlattenError, piece: &str) -> StageError {
    let code = match e {
        FlattenError::InvalidParameter { .. } => ErrorCode::InvalidParameter,
        FlattenError::Surface(SurfaceError::Degenerate { .. }) => ErrorCode::DegenerateTriangles,
        _ => ErrorCode::InvalidInput,
    };
    let of = if piece.is_empty() { String::new() } else { format!("piece \"{piece}\": ") };
    let error = StageError::new(code, format!("{of}{e}"));
    match e.remedy() {
        Some(remedy) => error.hint(remedy),
        None => error,
    }
}

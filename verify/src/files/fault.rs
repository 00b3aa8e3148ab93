//! The error of a file that cannot be read.

use toile_core::{ErrorCode, StageError};

/// Of a file, in one sentence.
pub(super) fn unreadable(what: String) -> StageError {
    StageError::new(ErrorCode::PatternLoading, what)
}

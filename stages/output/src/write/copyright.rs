//! A note of the rights to a file.

use toile_core::StageError;

/// Refuses a note that says nothing or would break a format of text.
pub(super) fn check_copyright(note: Option<&str>) -> Result<(), StageError> {
    let fault = match note {
        Some(note) if note.trim().is_empty() => "is empty",
        Some(note) if note.chars().any(char::is_control) => "has a line break or another control character",
        _ => return Ok(()),
    };
    Err(StageError::new(toile_core::ErrorCode::InvalidParameter, format!("the `copyright` {fault}"))
        .at("copyright")
        .hint("give one line such as \"2026 A. Tailor, all rights reserved\", or leave it out"))
}

//! Names that are safe in a file system and in a text format.

use toile_core::StageError;

/// A longer file stem is refused: with an extension it would pass some file systems' limit.
const LONGEST_NAME: usize = 100;

/// Refuses a file stem that would leave the output folder or not exist on some system.
pub(crate) fn check_name(name: &str) -> Result<(), StageError> {
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    let fault = match () {
        () if name.is_empty() => "is empty",
        () if name.len() > LONGEST_NAME => "is longer than 100 bytes",
        () if !name.chars().all(plain) => {
            "has a character other than letters, digits, space, '-', '_' and '.'"
        }
        () if name.starts_with(['.', ' ']) || name.ends_with(['.', ' ']) => {
            "begins or ends with a dot or a space"
        }
        () => return Ok(()),
    };
    let text = format!("the file name {name:?} {fault}");
    Err(StageError::new(toile_core::ErrorCode::InvalidParameter, text)
        .at("name")
        .hint("give a plain name without folder or extension, like \"garment\""))
}

/// Names for a format that knows no quoting: letters, digits, `-` and `_`; no two alike, none
/// empty.
pub(crate) fn plain_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken: Vec<String> = Vec::new();
    for name in names {
        let base = plain(name);
        let numbered = |n: usize| if n == 1 { base.clone() } else { format!("{base}_{n}") };
        // One of so many numbers is free, since each name before took one.
        let free = (1..=taken.len() + 1).map(numbered).find(|n| !taken.contains(n));
        taken.push(free.unwrap_or(base));
    }
    taken
}

/// At most 60 characters, so that a prefix and an extension still fit.
fn plain(name: &str) -> String {
    let keep = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let text: String = name.chars().take(60).map(keep).collect();
    if text.is_empty() { "part".to_owned() } else { text }
}

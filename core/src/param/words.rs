//! What is wrong with a text, in words.

use super::range::check_number;
use super::{ParamDoc, ParamFault};
use crate::near;

/// The longest piece of a file that a message repeats, characters.
const MAX_SHOWN: usize = 24;

/// The fault of a text that is no value of the parameter's type.
pub(super) fn type_fault(text: &str, doc: &ParamDoc, e: &ron::error::SpannedError) -> ParamFault {
    use ron::Error as E;
    let (reason, offset) = ron_fault(text, e);
    let (name, wants) = (doc.name, article(&doc.kind));
    let message = match &e.code {
        E::IntegerOutOfBounds => {
            let range = text.parse().ok().and_then(|x| check_number(x, doc).err());
            range.unwrap_or_else(|| format!("`{name}` must be {wants}: {reason}"))
        }
        // The type's own message names the value; that of the parser names what it expected.
        E::Message(_) => format!("`{name}`: {reason}"),
        E::NoSuchStructField { .. } | E::DuplicateStructField { .. } => format!("{reason} in `{name}`"),
        E::InvalidValueForType { expected, found } => format!("`{name}` must be {expected}, found {found}"),
        code if expected(code).is_some() => {
            format!("`{name}` must be {wants}, found {}", found(text, offset, code))
        }
        _ => format!("`{name}` must be {wants}: {reason}"),
    };
    ParamFault { message, reason, hint: ron_hint(&e.code), offset }
}

/// What `ron` says is wrong, in lower case, and the byte of the text where it is.
pub fn ron_fault(text: &str, e: &ron::error::SpannedError) -> (String, Option<usize>) {
    use ron::Error as E;
    let at = byte_offset(text, &e.span.start);
    // ron points behind the name of a field that it does not know.
    let name_at = |name: &str| text.get(..byte_offset(text, &e.span.end)?)?.rfind(name).or(at);
    match &e.code {
        E::NoSuchStructField { found, .. } => (format!("unknown field `{found}`"), name_at(found)),
        E::DuplicateStructField { field, .. } => {
            (format!("the field `{field}` is given twice"), name_at(field))
        }
        E::MissingStructField { field, .. } => (format!("the field `{field}` is missing"), at),
        E::NoSuchEnumVariant { found, .. } => (format!("there is no choice `{found}`"), at),
        E::InvalidValueForType { expected, found } => (format!("expected {expected}, found {found}"), at),
        E::ExpectedDifferentLength { expected, found } => (length_words(expected, *found), at),
        code => match expected(code) {
            Some(words) => (format!("expected {words}, found {}", found(text, at, code)), at),
            None => (lower_first(&code.to_string()), at),
        },
    }
}

/// What the parser expected, where its message says only that.
fn expected(e: &ron::Error) -> Option<&'static str> {
    use ron::Error as E;
    match e {
        E::ExpectedInteger => Some("a whole number"),
        E::ExpectedFloat => Some("a number"),
        E::ExpectedBoolean => Some("`true` or `false`"),
        E::ExpectedString => Some("text in quotes"),
        E::ExpectedIdentifier | E::InvalidIdentifier(_) | E::SuggestRawIdentifier(_) => Some("a name"),
        E::ExpectedArray => Some("a list"),
        E::ExpectedMap => Some("a map"),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => Some("`(...)`"),
        E::TrailingCharacters => Some("one value"),
        _ => None,
    }
}

/// `2 values, found 1`, out of serde's `tuple variant SeamLine::Match with 2 elements`.
fn length_words(expected: &str, found: usize) -> String {
    let wanted = expected.split(|c: char| !c.is_ascii_digit()).rfind(|s| !s.is_empty());
    wanted
        .map_or_else(|| format!("it holds {found} values"), |n| format!("it needs {n} values, found {found}"))
}

/// What stands there: a short piece of the text.
fn found(text: &str, at: Option<usize>, e: &ron::Error) -> String {
    let from = if matches!(e, ron::Error::TrailingCharacters) { 0 } else { at.unwrap_or(0) };
    let rest = text.get(from..).unwrap_or("");
    let word = match rest.chars().next() {
        Some('"') => rest[1..].find('"').map_or(rest, |end| &rest[..end + 2]),
        Some('(') => "(...)",
        Some('[') => "[...]",
        Some('{') => "{...}",
        _ => rest.split([',', ')', ']', '}', '\n']).next().unwrap_or("").trim(),
    };
    match word.char_indices().nth(MAX_SHOWN) {
        _ if word.is_empty() => "nothing".into(),
        Some((end, _)) => format!("`{}...`", &word[..end]),
        None => format!("`{word}`"),
    }
}

/// The nearest name, and all of them, where the fault is a name.
fn ron_hint(e: &ron::Error) -> Option<String> {
    match e {
        ron::Error::NoSuchEnumVariant { expected, found, .. } => near::hint(found, "there is", expected),
        ron::Error::NoSuchStructField { expected, found, .. } => near::hint(found, "there is", expected),
        _ => None,
    }
}

fn article(kind: &str) -> String {
    let plural = kind.contains('|') || kind.starts_with('{') || kind.starts_with('(');
    if plural || kind == "text" { kind.to_owned() } else { format!("a {kind}") }
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map(|c| c.to_lowercase().chain(chars).collect()).unwrap_or_default()
}

/// The byte at a line and column that ron reports (both from 1, columns in characters).
fn byte_offset(text: &str, at: &ron::error::Position) -> Option<usize> {
    let start: usize = text.split_inclusive('\n').take(at.line.checked_sub(1)?).map(str::len).sum();
    let line = text.get(start..)?;
    Some(line.char_indices().nth(at.col.checked_sub(1)?).map_or(text.len(), |(i, _)| start + i))
}

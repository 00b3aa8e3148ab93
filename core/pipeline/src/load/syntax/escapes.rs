//! Backslashes in texts: `"C:\Users\me\tee.jpg"` is a path of Windows to whoever writes it, and
//! holds escapes to RON.
//!
//! `\U` and `\P` are no escapes at all, which the parser refuses; `\t` and `\n` are, and would put
//! a tab into a path. No text of a pipeline needs a control character, so these are refused as
//! well.

use crate::load::fault::Fault;
use crate::load::syntax::tree::{ValueShape, ValueTree};
use std::ops::Range;

/// The longest text that a hint writes anew, bytes.
const MOST_SHOWN: usize = 80;

/// The most bytes of one character.
const MOST_BYTES: usize = 4;

/// The length of the escape with which `rest` begins, and the character that it stands for; `\xC3`
/// and its kin are read up to the end of their character. None where it is no escape.
pub(crate) fn escape(rest: &str) -> Option<(usize, char)> {
    let after = rest.strip_prefix('\\')?;
    let simple = |c| Some((2, c));
    match after.chars().next()? {
        c @ ('\'' | '"' | '\\') => simple(c),
        'n' => simple('\n'),
        'r' => simple('\r'),
        't' => simple('\t'),
        '0' => simple('\0'),
        'x' => bytes(rest),
        'u' => {
            let digits = after.strip_prefix("u{")?.split_once('}')?.0;
            let is_short = (1..=6).contains(&digits.len()) && digits.chars().all(|c| c.is_ascii_hexdigit());
            let c = u32::from_str_radix(digits, 16).ok().and_then(char::from_u32).filter(|_| is_short)?;
            Some((digits.len() + 4, c))
        }
        _ => None,
    }
}

/// A character by its bytes: `\x41`, `\xC3\xBC`.
fn bytes(rest: &str) -> Option<(usize, char)> {
    let mut found = Vec::new();
    while found.len() < MOST_BYTES {
        let digits = rest.get(4 * found.len()..)?.strip_prefix("\\x")?.get(..2)?;
        let is_hex = digits.chars().all(|c| c.is_ascii_hexdigit());
        found.push(u8::from_str_radix(digits, 16).ok().filter(|_| is_hex)?);
        if let Some(c) = std::str::from_utf8(&found).ok().and_then(|s| s.chars().next()) {
            return Some((4 * found.len(), c));
        }
    }
    None
}

/// What is to be said of a backslash that begins no escape, at its byte; the text around it has
/// that content.
pub(crate) fn no_escape(rest: &str, content: &str) -> (String, String) {
    let next = rest.chars().nth(1).filter(|c| !c.is_control() && !c.is_whitespace());
    let shown: String = std::iter::once('\\').chain(next).collect();
    (format!("a backslash begins an escape in a text, and `{shown}` is none"), remedy(content))
}

/// What is to be said of a text that ends with a backslash before its quote.
pub(crate) fn quoted_end(content: &str) -> (String, String) {
    let message = "a backslash begins an escape in a text, and `\\\"` is a quote inside of it";
    (message.to_owned(), remedy(content))
}

/// How a path is written.
fn remedy(content: &str) -> String {
    let path = content.replace("\\\\", "/").replace('\\', "/");
    match path.len() <= MOST_SHOWN && !path.contains('\n') {
        true => format!("write / or two backslashes: \"{path}\""),
        false => "write / or two backslashes".to_owned(),
    }
}

/// Reports every text with a control character that is written as an escape; such a text is broken,
/// and nothing more is said of it.
pub(crate) fn controls(text: &str, tree: &mut ValueTree, faults: &mut Vec<Fault>) {
    let before = faults.len();
    match &mut tree.shape {
        ValueShape::Literal => faults.extend(control(text, &tree.span)),
        ValueShape::Group { entries, .. } => {
            for entry in entries {
                faults.extend(entry.key.iter().filter_map(|key| control(text, key)));
                controls(text, &mut entry.value, faults);
            }
        }
        ValueShape::Name | ValueShape::Broken => {}
    }
    tree.is_broken |= faults.len() > before;
}

/// The first such character of a text in quotes.
fn control(text: &str, span: &Range<usize>) -> Option<Fault> {
    let written = text.get(span.clone())?;
    let content = written.strip_prefix('"')?.strip_suffix('"')?;
    let mut at = 0;
    while let Some(offset) = content.get(at..)?.find('\\') {
        at += offset;
        let (length, c) = escape(&content[at..])?;
        if c.is_control() {
            let escape = &content[at..at + length];
            let message = format!("a backslash begins an escape in a text, and `{escape}` is {}", word(c));
            let from = span.start + 1 + at;
            return Some(Fault::new("syntax", message).at(&(from..from + length), "").hint(remedy(content)));
        }
        at += length;
    }
    None
}

/// A control character in words.
fn word(c: char) -> &'static str {
    match c {
        '\n' => "a line's end",
        '\t' => "a tab",
        '\r' => "a carriage return",
        '\0' => "a zero byte",
        _ => "a control character",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_those_of_ron() {
        for (written, expected) in [
            (r"\n.", Some((2, '\n'))),
            (r#"\""#, Some((2, '"'))),
            (r"\\U", Some((2, '\\'))),
            (r"\x41B", Some((4, 'A'))),
            (r"\xC3\xBC", Some((8, 'ü'))),
            (r"\u{fc}", Some((6, 'ü'))),
            (r"\U", None),
            (r"\users", None),
            (r"\u{}", None),
            (r"\u{1234567}", None),
            (r"\u{d800}", None),
            (r"\xmas", None),
            (r"\xfe\data", None),
            (r"\x4ü", None),
            ("\\", None),
        ] {
            assert_eq!(escape(written), expected, "{written}");
            let text = format!("\"{}\"", written.strip_suffix('.').unwrap_or(written));
            let read = toile_core::param::ron_options().from_str::<String>(&text);
            assert!(expected.is_none() || written == r#"\""# || read.is_ok(), "{text}");
            assert!(expected.is_some() || read.is_err(), "{text}");
        }
    }
}

//! Places at which entries of a group are taken out of a text.

use super::tree::GroupEntry;
use std::ops::Range;

/// The place of an entry with its comma and the white space that only it needed; comments stay.
pub(crate) fn whole(text: &str, entries: &[GroupEntry], i: usize) -> Range<usize> {
    let entry = &entries[i];
    let mut start = entry.key.as_ref().map_or(entry.value.span.start, |k| k.start);
    let mut end = entry.value.span.end;
    let after = |at: usize| text.get(at..).unwrap_or("");
    let blank = |rest: &str| rest.len() - rest.trim_start_matches([' ', '\t']).len();
    let comma = blank(after(end));
    if after(end + comma).starts_with(',') {
        end += comma + 1;
        end += blank(after(end));
    } else if let Some(before) = i.checked_sub(1).map(|b| entries[b].value.span.end) {
        // The last of a list without a last comma takes the comma before it.
        let between = text.get(before..start).unwrap_or("");
        if between.trim() == "," {
            start = before;
        }
    }
    let line = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let alone = text[line..start].trim().is_empty();
    match after(end).find('\n') {
        Some(rest) if alone && after(end)[..rest].trim().is_empty() => line..end + rest + 1,
        _ => start..end,
    }
}

/// The text without an entry of a group; comments stay.
pub(crate) fn removed(text: &str, entries: &[GroupEntry], i: usize) -> String {
    let span = whole(text, entries, i);
    let mut out = text.to_owned();
    // A comma behind a comment is no part of the entry's place.
    let comma = comma_after(text, entries[i].value.span.end).filter(|comma| *comma > span.end);
    if let Some(comma) = comma {
        out.replace_range(comma - 1..comma, "");
    }
    out.replace_range(span, "");
    out
}

/// The place behind the comma that follows a value, if one does; comments are skipped.
pub(crate) fn comma_after(text: &str, from: usize) -> Option<usize> {
    let mut at = from;
    loop {
        let rest = &text[at..];
        let skipped = rest.len() - rest.trim_start().len();
        let rest = rest.trim_start();
        at += skipped;
        if rest.starts_with(',') {
            return Some(at + 1);
        }
        at += match (rest.starts_with("//"), rest.starts_with("/*")) {
            (true, _) => rest.find('\n')?,
            (_, true) => comment(rest)?,
            _ => return None,
        };
    }
}

/// The length of a block comment, with those in it.
fn comment(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        let rest = text.get(at..)?;
        let step = match (rest.starts_with("/*"), rest.starts_with("*/")) {
            (true, _) => {
                depth += 1;
                2
            }
            (_, true) => {
                depth -= 1;
                2
            }
            _ => rest.chars().next().map_or(1, char::len_utf8),
        };
        at += step;
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

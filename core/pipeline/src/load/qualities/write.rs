//! Qualities written into a pipeline's text; comments, order and all else stay.

use super::read::field;
use super::{Quality, named};
use crate::load::fault::Fault;
use crate::load::parse;
use crate::load::syntax::cut::comma_after;
use crate::load::syntax::tree::{GroupEntry, ValueShape, ValueTree};
use std::ops::Range;
use toile_core::param::ron_text;

/// The text with qualities in its field: those of a name that is there take its place, others
/// follow, in their order.
///
/// Errors: the text is no RON, or no pipeline file.
pub fn fill(text: &str, qualities: &[Quality]) -> Result<String, Box<Fault>> {
    let mut text = text.to_owned();
    for quality in qualities {
        text = put(&text, quality)?;
    }
    Ok(text)
}

/// The text without the field.
///
/// Errors: the text is no RON.
pub fn without(text: &str) -> Result<String, Box<Fault>> {
    let tree = parse(text).map_err(Box::new)?;
    let Some(GroupEntry { key: Some(key), value }) = field(text, &tree) else { return Ok(text.to_owned()) };
    let comma = comma_after(text, value.span.end).unwrap_or(value.span.end);
    Ok(cut(text, key.start..comma))
}

/// Cuts a span out, with its line where nothing else stands there.
fn cut(text: &str, span: Range<usize>) -> String {
    let (before, after) = (&text[..span.start], &text[span.end..]);
    let from = before.rfind('\n').map_or(0, |i| i + 1);
    let blank = |s: &str| s.chars().all(|c| c == ' ' || c == '\t' || c == '\r');
    match after.find('\n') {
        Some(end) if blank(&before[from..]) && blank(&after[..end]) => {
            format!("{}{}", &before[..from], &after[end + 1..])
        }
        _ => format!("{before}{after}"),
    }
}

fn put(text: &str, quality: &Quality) -> Result<String, Box<Fault>> {
    let tree = parse(text).map_err(Box::new)?;
    let wrong =
        || Box::new(Fault::new("not_a_pipeline", "the text is no pipeline file").at(&tree.head(), ""));
    let Some(GroupEntry { value, .. }) = field(text, &tree) else {
        let ValueShape::Group { entries, .. } = &tree.shape else { return Err(wrong()) };
        let block = format!("    qualities: [\n{}\n    ],\n", written(quality));
        return Ok(last_in(text, &tree, entries, &block));
    };
    let ValueShape::Group { entries, .. } = &value.shape else { return Err(wrong()) };
    let same = named(text).into_iter().find(|q| q.name == quality.name);
    let is_it = |e: &&GroupEntry| same.as_ref().is_some_and(|q| covers(&e.value.span, &q.place));
    match entries.iter().find(is_it) {
        Some(entry) => {
            let new = written(quality);
            let new = new.trim_start().trim_end_matches(',');
            let (from, to) = (entry.value.span.start, entry.value.span.end);
            Ok(format!("{}{new}{}", &text[..from], &text[to..]))
        }
        None => Ok(last_in(text, value, entries, &format!("{}\n", written(quality)))),
    }
}

fn covers(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// An entry of the field, with its comma.
fn written(quality: &Quality) -> String {
    let set: Vec<String> = quality.set.iter().map(|o| ron_text(&format!("{}={}", o.path, o.value))).collect();
    let mut lines = vec![
        format!(
            "        Quality(name: {}, max_error: {},",
            ron_text(&quality.name),
            ron_text(&quality.max_error)
        ),
        format!("            set: [{}]", set.join(", ")),
    ];
    let measured = quality.measured.as_ref().map(|m| ("measured", ron_text(m)));
    let basis = quality.basis.as_ref().map(|b| ("measured_for", ron_text(&b.to_string())));
    for (field, value) in measured.into_iter().chain(basis) {
        if let Some(last) = lines.last_mut() {
            last.push(',');
        }
        lines.push(format!("            {field}: {value}"));
    }
    lines.join("\n") + "),"
}

/// Appends whole lines to a group, before its closing bracket, and adds a comma after the last
/// entry where it has none.
fn last_in(text: &str, group: &ValueTree, entries: &[GroupEntry], lines: &str) -> String {
    let close = group.span.end.saturating_sub(1);
    let comma = entries.last().map(|e| e.value.span.end).filter(|end| comma_after(text, *end).is_none());
    let mut out = text.to_owned();
    // Insertions go from the end to the start, so that earlier offsets stay valid.
    let line = text[..close].rfind('\n').map_or(0, |i| i + 1);
    match text[line..close].trim().is_empty() && line > 0 {
        true => out.insert_str(line, lines),
        false => out.insert_str(close, &format!("\n{lines}")),
    }
    if let Some(end) = comma {
        out.insert(end, ',');
    }
    out
}

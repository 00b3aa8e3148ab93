//! Where two values differ, field by field.

use super::parse;
use crate::load::syntax::tree::{Bracket, ValueShape, ValueTree};
use std::ops::Range;

/// A part of a value that is otherwise in another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Differing {
    /// Names with dots between them, `photos.front.width`; empty for the whole value.
    pub path: String,
    /// Its text in the first; none where it is not there.
    pub was: Option<String>,
    /// Its text in the second; none where it is not there.
    pub is: Option<String>,
}

/// The innermost parts in which two RON values differ, in their order.
pub fn differing(was: &str, is: &str) -> Vec<Differing> {
    let mut found = Vec::new();
    match (parse(was), parse(is)) {
        (Ok(a), Ok(b)) => walk("", (was, &a), (is, &b), &mut found),
        _ if was == is => {}
        _ => {
            found.push(Differing { path: String::new(), was: Some(was.to_owned()), is: Some(is.to_owned()) })
        }
    }
    found
}

type TextAndTree<'a> = (&'a str, &'a ValueTree);

fn walk(path: &str, a: TextAndTree<'_>, b: TextAndTree<'_>, found: &mut Vec<Differing>) {
    let (was, is) = (written(a.0, &a.1.span), written(b.0, &b.1.span));
    if was == is {
        return;
    }
    if head(a) != head(b) || head(a).is_none() {
        found.push(Differing { path: path.to_owned(), was: Some(was), is: Some(is) });
        return;
    }
    let keys = |(text, tree): TextAndTree<'_>| {
        let key = |(i, e): (usize, &crate::load::syntax::tree::GroupEntry)| {
            e.key.as_ref().map_or_else(|| i.to_string(), |k| written(text, k).trim_matches('"').to_owned())
        };
        tree.entries().iter().enumerate().map(key).collect::<Vec<String>>()
    };
    let mut all = keys(a);
    all.extend(keys(b).into_iter().filter(|key| a.1.entry(a.0, key).is_none()));
    for key in all {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let text =
            |(text, tree): TextAndTree<'_>| tree.entry(text, &key).map(|e| written(text, &e.value.span));
        match (a.1.entry(a.0, &key), b.1.entry(b.0, &key)) {
            (Some(x), Some(y)) => walk(&path, (a.0, &x.value), (b.0, &y.value), found),
            _ => found.push(Differing { path, was: text(a), is: text(b) }),
        }
    }
}

/// The kind of group that a value is; none where it is no group.
fn head((text, tree): TextAndTree<'_>) -> Option<(String, Bracket)> {
    match &tree.shape {
        ValueShape::Group { name, bracket, .. } => {
            Some((name.as_ref().map_or_else(String::new, |n| written(text, n)), *bracket))
        }
        _ => None,
    }
}

fn written(text: &str, span: &Range<usize>) -> String {
    text.get(span.clone()).unwrap_or("").to_owned()
}

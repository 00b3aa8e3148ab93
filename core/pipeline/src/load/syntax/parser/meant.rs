//! What may have been meant where the parser cannot go on.

use super::repairs::{Meant, Repair, SyntaxFault};
use super::{Parser, fault, is_name};
use crate::load::syntax::escapes;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use std::ops::Range;

/// The longest value that a message repeats, characters.
const MAX_SHOWN: usize = 24;

impl Parser<'_> {
    /// An entry is followed by neither a comma nor the bracket's end.
    pub(super) fn after_entry(
        &self,
        bracket: Bracket,
        opened: &Range<usize>,
        entries: &[GroupEntry],
    ) -> SyntaxFault {
        let plain = self.unclosed(opened, &format!("`,` or `{}`", bracket.close()));
        let (Some(entry), Some(c)) = (entries.last(), self.peek()) else {
            return self.closed(plain, bracket, opened, entries);
        };
        if matches!(c, ')' | ']' | '}') {
            return self.closed(plain, bracket, opened, entries);
        }
        if c == ':' && bracket == Bracket::Square {
            let at = entry.value.span.start;
            let name = &self.text[entry.value.span.clone()];
            let hint = Some(format!("write `]` before `{name}`"));
            let words = ("this `[` is never closed".to_owned(), hint, opened.clone());
            return plain.meant(Repair::Close(at), Some(words));
        }
        let (value, end) = (&entry.value, entry.value.span.end);
        let shown = shown(self.text, value);
        let here = self.here();
        if c == ';' || c == '.' {
            let words = (format!("expected `,`, found `{c}`"), None, here.clone());
            return plain.meant(Repair::CommaFor(end, here), Some(words));
        }
        let mut fault = plain;
        if let Some(text) = self.text_before(value) {
            fault = self.quoted_end(text.clone()).into_iter().fold(fault, SyntaxFault::or);
            let to = self.text_end(text.start + 1);
            let hint = Some("write `\"` at its end".to_owned());
            let words = ("this text is never closed".to_owned(), hint, text.start..text.start + 1);
            fault = fault.meant(Repair::Value(text.start..to), Some(words));
        }
        // A bare word or number and more words: a text without its quotes.
        let bare = matches!(value.shape, ValueShape::Literal | ValueShape::Name)
            && !self.text[value.span.clone()].contains('"');
        let same_line = !self.text[end..self.at].contains('\n');
        let to = self.bare_end();
        if bare && same_line && (entry.key.is_some() || bracket != Bracket::Round) && !self.is_field_next() {
            let words = self.text[value.span.start..to].trim_end_matches('"').to_owned();
            let hint = Some(format!("write `\"{words}\"`"));
            let message = format!("`{words}` is a text and stands in quotes");
            fault =
                fault.meant(Repair::Value(value.span.start..to), Some((message, hint, value.span.start..to)));
        }
        if bracket == Bracket::Round && entry.key.is_none() && value.shape == ValueShape::Name {
            let name = &self.text[value.span.clone()];
            let message = match c {
                '=' => format!("expected `:` after `{name}`, found `=`"),
                _ => format!("a colon is missing after `{name}`"),
            };
            let hint = Some(format!("write `{name}: ...`"));
            let at = if c == '=' { here } else { end..end };
            fault = fault.meant(Repair::Colon(end), Some((message, hint, at)));
        }
        let words = (format!("a comma is missing after {shown}"), None, end..end);
        fault.meant(Repair::Comma(end), Some(words))
    }

    /// A comma stands where an entry was to begin.
    pub(super) fn no_entry(&self, bracket: Bracket, opened: &Range<usize>) -> SyntaxFault {
        let words = format!("this `{}` is never closed", &self.text[opened.clone()]);
        let hint = Some(format!("write `{}` before this comma", bracket.close()));
        let fault = fault("expected a value, found `,`", self.here()).meant(Repair::Skip(self.here()), None);
        fault.meant(Repair::Close(self.at), Some((words, hint, opened.clone())))
    }

    /// What may have been meant where another bracket stands than the one that closes.
    pub(super) fn closed(
        &self,
        fault: SyntaxFault,
        bracket: Bracket,
        opened: &Range<usize>,
        entries: &[GroupEntry],
    ) -> SyntaxFault {
        let early = self.early_end(opened, entries).map(|at| {
            let next =
                self.text.get(at..).and_then(|t| t.split(['(', ':', '\n']).next()).unwrap_or("").trim();
            let hint = Some(format!("write `{}` before `{next}`", bracket.close()));
            let message = format!("this `{}` is never closed", &self.text[opened.clone()]);
            (at, (message, hint, opened.clone()))
        });
        let fault = match early {
            Some((at, words)) => fault.meant(Repair::Close(at), Some(words)),
            None => fault,
        };
        match self.peek() {
            // What else the file was to hold is not known, unless only its last bracket is missing.
            None if opened.start == self.first => fault.meant(Repair::Close(self.at), None),
            None => fault,
            Some(_) => {
                let here = self.here();
                let fault =
                    fault.meant(Repair::Closer(here.clone()), None).meant(Repair::Close(self.at), None);
                fault.meant(Repair::Skip(here), None)
            }
        }
    }

    /// Where a bracket that was never closed probably ends: before the first entry on a later line
    /// that is of another form than those before it.
    fn early_end(&self, opened: &Range<usize>, entries: &[GroupEntry]) -> Option<usize> {
        let start = |e: &GroupEntry| e.key.as_ref().map_or(e.value.span.start, |k| k.start);
        let form = |e: &GroupEntry| match &e.key {
            None => 0,
            Some(key) if self.text[key.clone()].starts_with('"') => 1,
            Some(_) => 2,
        };
        let later = |e: &&GroupEntry| self.text[opened.end..start(e)].contains('\n');
        let first = entries.first()?;
        let is_round = self.text[opened.clone()] == *"(";
        // A stage's arguments stand on its line, or have names.
        let lone = is_round && form(first) == 0 && later(&first);
        if lone {
            Some(start(first))
        } else {
            entries.iter().filter(later).find(|e| form(e) != form(first)).map(start)
        }
    }

    /// At the end of the file the bracket is at fault, else what stands here.
    pub(super) fn unclosed(&self, opened: &Range<usize>, expected: &str) -> SyntaxFault {
        match self.peek() {
            None => {
                let words = format!("this `{}` is never closed", &self.text[opened.clone()]);
                SyntaxFault { at: self.at, ..fault(words, opened.clone()) }
            }
            Some(_) => {
                let message = format!("expected {expected}, found {}", self.found());
                let mut also = vec![(opened.clone(), "opened here")];
                also.extend(
                    self.long_text.iter().map(|t| (t.clone(), "this text runs over the end of its line")),
                );
                SyntaxFault { also, ..fault(message, self.here()) }
            }
        }
    }

    /// A backslash before the parser begins no escape, in a text that begins at `from` with its
    /// content at `inside`: the text ends at its closing quote, or at the first quote at all, as a
    /// folder's path of Windows does.
    pub(super) fn no_escape(&self, from: usize, inside: usize, close: char) -> SyntaxFault {
        let at = self.at - 1;
        let content = self.text.get(inside..).unwrap_or("");
        let line = content.split('\n').next().unwrap_or("");
        let to_end = |length: Option<usize>| {
            length.map_or_else(|| self.text_end(inside), |length| inside + length + close.len_utf8())
        };
        let literal = line.find(close);
        let mut escaped = false;
        let closes = |c: char| {
            let is_end = c == close && !escaped;
            escaped = c == '\\' && !escaped;
            is_end
        };
        let (whole, first) = (to_end(line.find(closes)), to_end(literal));
        let (message, hint) = escapes::no_escape(&self.text[at..], &line[..literal.unwrap_or(line.len())]);
        let span = at..self.here().end;
        let fault = SyntaxFault { hint: Some(hint), ..fault(message, span) };
        fault.meant(Repair::Value(from..whole), None).meant(Repair::Value(from..first), None)
    }

    /// What may have been meant by a text with a quote after a backslash: that it ends there.
    pub(super) fn quoted_end(&self, text: Range<usize>) -> Option<Meant> {
        let content = self.text.get(text.clone())?.strip_prefix('"')?;
        let length = content.find("\\\"").filter(|length| !content[..*length].contains('\n'))?;
        let at = text.start + 1 + length;
        let (message, hint) = escapes::quoted_end(&content[..=length]);
        Some(Meant {
            repair: Repair::Value(text.start..at + 2),
            words: Some((message, Some(hint), at..at + 2)),
        })
    }

    /// A text that ended just before: it may have run on beyond its end.
    fn text_before(&self, value: &ValueTree) -> Option<Range<usize>> {
        let text = self.last_text.clone().filter(|t| *t == value.span)?;
        let runs_on = self.text[text.clone()].contains('\n') || text.end == self.at;
        runs_on.then_some(text)
    }

    /// Where a text that lacks its closing quote probably ends: before the comma or bracket behind
    /// it, on its own line.
    pub(super) fn text_end(&self, from: usize) -> usize {
        let line = self.text.get(from..).unwrap_or("").split('\n').next().unwrap_or("");
        from + line.find([',', ')', ']', '}']).unwrap_or(line.trim_end().len())
    }

    /// The end of what stands here up to a comma, a bracket or the end of the line.
    pub(super) fn word_end(&self) -> usize {
        let line = self.rest().split('\n').next().unwrap_or("");
        let end = line.find([',', ')', ']', '}', '(', '[', '{']).unwrap_or(line.len());
        let end = self.at + line[..end].trim_end().len();
        end.max(self.here().end)
    }

    /// The end of a text without quotes, which may have one at its end.
    fn bare_end(&self) -> usize {
        let end = self.word_end();
        let line = self.text.get(end..).unwrap_or("");
        if line.starts_with('"') { end + 1 } else { end }
    }

    /// Whether `name:` comes.
    fn is_field_next(&self) -> bool {
        let rest = self.rest();
        let name = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
        name > 0 && rest[name..].trim_start().starts_with(':')
    }
}

/// A value as a message names it: short ones whole, of a group its head.
fn shown(text: &str, value: &ValueTree) -> String {
    let own = text.get(value.span.clone()).unwrap_or("");
    let whole = own.chars().count() <= MAX_SHOWN && !own.contains('\n');
    match &value.shape {
        _ if whole => format!("`{own}`"),
        ValueShape::Group { name: Some(name), .. } => {
            format!("`{}(...)`", text.get(name.clone()).unwrap_or(""))
        }
        ValueShape::Group { bracket: Bracket::Round, .. } => "`(...)`".into(),
        ValueShape::Group { bracket: Bracket::Square, .. } => "`[...]`".into(),
        ValueShape::Group { bracket: Bracket::Curly, .. } => "`{...}`".into(),
        _ => "this value".into(),
    }
}

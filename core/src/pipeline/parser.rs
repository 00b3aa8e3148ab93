//! From RON text to its syntax tree.
//!
//! The parser knows brackets, names, literals and comments, and leaves the meaning of literals to
//! `ron`. It exists because `ron` forgets places once a value is read, and because its own
//! messages cannot name the bracket that was never closed. Cost: one pass over the text. Limits:
//! nesting up to [`MAX_DEPTH`].

use super::tree::{Bracket, Entry, Shape, Tree};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The deepest nesting; far beyond any pipeline, and safe for the stack.
pub(super) const MAX_DEPTH: usize = 60;

/// Why a text is no RON.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SyntaxFault {
    pub(super) message: String,
    pub(super) hint: Option<String>,
    pub(super) span: Range<usize>,
    /// Other places that it is about, with what is there.
    pub(super) also: Vec<(Range<usize>, &'static str)>,
    /// Where the parser stood.
    at: usize,
    /// What may have been meant.
    pub(super) meant: Vec<Meant>,
}

/// One thing that may have been meant: how the text is to be read, and what is to be said of it then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Meant {
    pub(super) repair: Repair,
    /// Message, hint and place in those words; none where those of the fault serve.
    pub(super) words: Option<(String, Option<String>, Range<usize>)>,
}

/// How a faulty text is read all the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Repair {
    /// There is a comma at that byte.
    Comma(usize),
    /// There is a comma at that byte in place of what stands there.
    CommaFor(usize, Range<usize>),
    /// There is a colon at that byte.
    Colon(usize),
    /// The bracket at work is closed at that byte.
    Close(usize),
    /// All brackets are closed at the end of the text.
    CloseAll,
    /// What stands there is not there.
    Skip(Range<usize>),
    /// What stands there closes the bracket at work.
    Closer(Range<usize>),
    /// What stands there is one value.
    Value(Range<usize>),
}

/// Repairs of a text, each at its byte.
#[derive(Debug, Clone, Default)]
pub(super) struct Repairs {
    commas: BTreeSet<usize>,
    colons: BTreeSet<usize>,
    /// How many brackets are closed.
    closes: BTreeMap<usize, usize>,
    skips: BTreeMap<usize, usize>,
    values: BTreeMap<usize, usize>,
    /// Whether the end of the text closes all brackets.
    end: bool,
}

impl Repairs {
    /// The same with one more.
    pub(super) fn with(&self, repair: &Repair) -> Self {
        let mut all = self.clone();
        match repair {
            Repair::Comma(at) => {
                all.commas.insert(*at);
            }
            Repair::CommaFor(at, span) => {
                all.commas.insert(*at);
                all.skips.insert(span.start, span.end);
            }
            Repair::Colon(at) => {
                all.colons.insert(*at);
            }
            Repair::Close(at) => *all.closes.entry(*at).or_default() += 1,
            Repair::CloseAll => all.end = true,
            Repair::Skip(span) => {
                all.skips.insert(span.start, span.end);
            }
            Repair::Closer(span) => {
                *all.closes.entry(span.start).or_default() += 1;
                all.skips.insert(span.start, span.end);
            }
            Repair::Value(span) => {
                all.values.insert(span.start, span.end);
            }
        }
        all
    }
}

impl SyntaxFault {
    /// Where the parser stood: the farther, the better a text was understood.
    pub(super) fn reached(&self) -> usize {
        self.at
    }

    fn meant(mut self, repair: Repair, words: Option<(String, Option<String>, Range<usize>)>) -> Self {
        self.meant.push(Meant { repair, words });
        self
    }
}

/// Parses a whole text: one value, with comments and white space around it.
pub(super) fn parse(text: &str) -> Result<Tree, SyntaxFault> {
    repaired(text, &Repairs::default())
}

/// Parses a text as it is with the repairs.
pub(super) fn repaired(text: &str, repairs: &Repairs) -> Result<Tree, SyntaxFault> {
    let mut p =
        Parser { text, at: 0, long_text: None, last_text: None, lenient: false, repairs: repairs.clone() };
    p.eat("\u{feff}");
    p.attributes()?;
    if p.rest().is_empty() {
        return Err(fault("there is nothing in it", p.at..p.at));
    }
    let tree = p.value(0)?;
    p.space()?;
    match p.peek() {
        None => Ok(tree),
        Some(_) => {
            let rest = p.at..text.len();
            let fault = fault(format!("expected the end, found {}", p.found()), p.here());
            Err(fault.meant(Repair::Skip(rest), None))
        }
    }
}

fn fault(message: impl Into<String>, span: Range<usize>) -> SyntaxFault {
    let at = span.start;
    SyntaxFault { message: message.into(), hint: None, span, also: Vec::new(), at, meant: Vec::new() }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    /// The opening quote of the last text that runs over a line's end: often one that was to end
    /// on its line.
    long_text: Option<Range<usize>>,
    /// The last text in quotes that was read, whole.
    last_text: Option<Range<usize>>,
    /// True after a bracket that a repair closed: its comma may stand before that place.
    lenient: bool,
    repairs: Repairs,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn eat(&mut self, prefix: &str) -> bool {
        let found = self.rest().starts_with(prefix);
        self.at += if found { prefix.len() } else { 0 };
        found
    }

    fn eat_while(&mut self, keep: impl Fn(char) -> bool) -> Range<usize> {
        let from = self.at;
        self.at += self.rest().find(|c| !keep(c)).unwrap_or(self.rest().len());
        from..self.at
    }

    /// The place of the next character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.peek().map_or(0, char::len_utf8)
    }

    fn found(&self) -> String {
        self.peek().map_or("the end of the file".into(), |c| format!("`{}`", c.escape_debug()))
    }

    /// Skips white space and comments.
    fn space(&mut self) -> Result<(), SyntaxFault> {
        loop {
            self.eat_while(is_space);
            if let Some(end) = self.repairs.skips.get(&self.at)
                && !self.repairs.closes.contains_key(&self.at)
            {
                self.at = *end;
            } else if self.eat("//") {
                self.eat_while(|c| c != '\n');
            } else if self.rest().starts_with("/*") {
                self.block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    /// Block comments nest.
    fn block_comment(&mut self) -> Result<(), SyntaxFault> {
        let (from, mut depth) = (self.at, 0usize);
        loop {
            if self.eat("/*") {
                depth += 1;
            } else if self.eat("*/") {
                depth -= 1;
                if depth == 0 {
                    return Ok(());
                }
            } else if self.peek().is_none() {
                return Err(fault("this comment is never closed", from..from + 2));
            } else {
                self.at = self.here().end;
            }
        }
    }

    /// Skips `#![enable(...)]` at the head of a file, which `ron` reads.
    fn attributes(&mut self) -> Result<(), SyntaxFault> {
        self.space()?;
        while self.rest().starts_with("#![") {
            self.eat_while(|c| c != ']');
            self.eat("]");
            self.space()?;
        }
        Ok(())
    }

    fn value(&mut self, depth: usize) -> Result<Tree, SyntaxFault> {
        self.space()?;
        let from = self.at;
        if depth > MAX_DEPTH {
            return Err(fault(format!("nested deeper than {MAX_DEPTH} brackets"), self.here()));
        }
        if let Some(end) = self.repairs.values.get(&self.at) {
            self.at = *end;
            return Ok(Tree { span: from..self.at, shape: Shape::Broken });
        }
        let Some(c) = self.peek() else {
            return Err(fault("expected a value, found the end of the file", self.here()));
        };
        if let Some(bracket) = Bracket::open(c) {
            return self.group(None, from, bracket, depth);
        }
        if self.literal(c)? {
            return Ok(Tree { span: from..self.at, shape: Shape::Literal });
        }
        let Some(name) = self.name() else {
            let fault = fault(format!("expected a value, found {}", self.found()), self.here());
            return Err(match c {
                ',' => fault.meant(Repair::Skip(self.here()), None),
                _ => fault.meant(Repair::Value(self.at..self.word_end()), None),
            });
        };
        self.space()?;
        match self.peek() {
            Some('(') => self.group(Some(name), from, Bracket::Round, depth),
            _ => {
                self.at = name.end;
                Ok(Tree { span: name, shape: Shape::Name })
            }
        }
    }

    fn name(&mut self) -> Option<Range<usize>> {
        let from = self.at;
        if self.rest().starts_with("r#")
            && !self.rest().starts_with("r#\"")
            && !self.rest().starts_with("r##")
        {
            self.at += 2;
            self.eat_while(|c| is_name(c) || matches!(c, '.' | '+' | '-'));
            return Some(from..self.at);
        }
        let first = self.peek().filter(|c| *c == '_' || c.is_alphabetic());
        first.map(|_| self.eat_while(is_name))
    }

    /// Skips a number, text or character, if there is one.
    fn literal(&mut self, c: char) -> Result<bool, SyntaxFault> {
        let rest = self.rest();
        let quote = ["b\"", "b'", "\"", "'"].into_iter().find(|q| rest.starts_with(q));
        if let Some(quote) = quote {
            return self.quoted(quote.len()).map(|()| true);
        }
        let hashes =
            rest.trim_start_matches('b').strip_prefix('r').map(|r| r.len() - r.trim_start_matches('#').len());
        if let Some(hashes) = hashes {
            let open = rest.find('r').unwrap_or(0) + 1 + hashes;
            if open <= hashes + 2 && rest[open..].starts_with('"') {
                return self.raw(open + 1, hashes).map(|()| true);
            }
        }
        let number = c.is_ascii_digit() || matches!(c, '+' | '-' | '.');
        if number {
            self.eat_while(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '+' | '-'));
        }
        Ok(number)
    }

    /// A text or character; its closing quote is the last of `open`'s characters.
    fn quoted(&mut self, open: usize) -> Result<(), SyntaxFault> {
        let from = self.at;
        self.at += open;
        let close = self.text[from..self.at].chars().last().unwrap_or('"');
        while let Some(c) = self.peek() {
            self.at += c.len_utf8();
            match c {
                '\\' => self.at = self.here().end,
                c if c == close => {
                    self.last_text = Some(from..self.at);
                    if self.text[from..self.at].contains('\n') {
                        self.long_text = Some(from..from + open);
                    }
                    return Ok(());
                }
                '\n' if close == '\'' => break,
                _ => {}
            }
        }
        let end = self.text_end(from + open);
        let words = "this text is never closed".to_owned();
        let hint = Some(format!("write `{close}` at its end"));
        let fault = fault(words.clone(), from..from + open);
        Err(fault.meant(Repair::Value(from..end), Some((words, hint, from..from + open))))
    }

    /// Where a text that lacks its closing quote probably ends: before the comma or bracket behind it, on its own line.
    fn text_end(&self, from: usize) -> usize {
        let line = self.text.get(from..).unwrap_or("").split('\n').next().unwrap_or("");
        from + line.find([',', ')', ']', '}']).unwrap_or(line.trim_end().len())
    }

    /// The end of what stands here up to a comma, a bracket or the end of the line.
    fn word_end(&self) -> usize {
        let line = self.rest().split('\n').next().unwrap_or("");
        let end = line.find([',', ')', ']', '}', '(', '[', '{']).unwrap_or(line.len());
        let end = self.at + line[..end].trim_end().len();
        end.max(self.here().end)
    }

    fn raw(&mut self, open: usize, hashes: usize) -> Result<(), SyntaxFault> {
        let from = self.at;
        let close = format!("\"{}", "#".repeat(hashes));
        match self.rest()[open..].find(&close) {
            Some(length) => {
                self.at += open + length + close.len();
                Ok(())
            }
            None => Err(fault("this text is never closed", from..from + open)),
        }
    }

    fn group(
        &mut self,
        name: Option<Range<usize>>,
        from: usize,
        bracket: Bracket,
        depth: usize,
    ) -> Result<Tree, SyntaxFault> {
        let opened = self.here();
        self.at = opened.end;
        let (inside, mut entries) = (self.at, Vec::new());
        loop {
            self.space()?;
            if self.close(bracket, &opened, &entries)? {
                break;
            }
            self.lenient = false;
            let entry = self.entry(bracket, depth)?;
            let end = entry.value.span.end;
            let missing = self.repairs.commas.contains(&end);
            entries.push(entry);
            self.space()?;
            if !self.eat(",") && !missing && !self.closes(bracket) && !self.lenient {
                return Err(self.after_entry(bracket, &opened, &entries));
            }
        }
        Ok(Tree { span: from..self.at, shape: Shape::Group { name, bracket, inside, entries } })
    }

    /// Whether the bracket ends here.
    fn closes(&self, bracket: Bracket) -> bool {
        match self.peek() {
            _ if self.repairs.closes.contains_key(&self.at) => true,
            None => self.repairs.end,
            Some(c) => c == bracket.close(),
        }
    }

    fn close(
        &mut self,
        bracket: Bracket,
        opened: &Range<usize>,
        entries: &[Entry],
    ) -> Result<bool, SyntaxFault> {
        if let Some(times) = self.repairs.closes.get_mut(&self.at) {
            *times -= 1;
            if *times == 0 {
                self.repairs.closes.remove(&self.at);
            }
            self.lenient = true;
            return Ok(true);
        }
        match self.peek() {
            Some(c) if c == bracket.close() => {
                self.at += c.len_utf8();
                Ok(true)
            }
            None if self.repairs.end => Ok(true),
            None | Some(')' | ']' | '}') => {
                let fault = self.unclosed(opened, &format!("`{}`", bracket.close()));
                Err(self.closed(fault, bracket, opened, entries))
            }
            Some(_) => Ok(false),
        }
    }

    /// What may have been meant where another bracket stands than the one that closes.
    fn closed(
        &self,
        fault: SyntaxFault,
        bracket: Bracket,
        opened: &Range<usize>,
        entries: &[Entry],
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
            None => fault.meant(Repair::CloseAll, None),
            Some(_) => {
                let here = self.here();
                let fault =
                    fault.meant(Repair::Closer(here.clone()), None).meant(Repair::Close(self.at), None);
                fault.meant(Repair::Skip(here), None)
            }
        }
    }

    /// Where a bracket that was never closed probably ends: before the first entry on a later line that is of another form than
    /// those before it.
    fn early_end(&self, opened: &Range<usize>, entries: &[Entry]) -> Option<usize> {
        let start = |e: &Entry| e.key.as_ref().map_or(e.value.span.start, |k| k.start);
        let form = |e: &Entry| match &e.key {
            None => 0,
            Some(key) if self.text[key.clone()].starts_with('"') => 1,
            Some(_) => 2,
        };
        let later = |e: &&Entry| self.text[opened.end..start(e)].contains('\n');
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
    fn unclosed(&self, opened: &Range<usize>, expected: &str) -> SyntaxFault {
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

    /// An entry is followed by neither a comma nor the bracket's end.
    fn after_entry(&self, bracket: Bracket, opened: &Range<usize>, entries: &[Entry]) -> SyntaxFault {
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
            let to = self.text_end(text.start + 1);
            let hint = Some("write `\"` at its end".to_owned());
            let words = ("this text is never closed".to_owned(), hint, text.start..text.start + 1);
            fault = fault.meant(Repair::Value(text.start..to), Some(words));
        }
        // A bare word or number and more words: a text without its quotes.
        let bare = matches!(value.shape, Shape::Literal | Shape::Name)
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
        if bracket == Bracket::Round && entry.key.is_none() && value.shape == Shape::Name {
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

    /// A text that ended just before: it may have run on beyond its end.
    fn text_before(&self, value: &Tree) -> Option<Range<usize>> {
        let text = self.last_text.clone().filter(|t| *t == value.span)?;
        let runs_on = self.text[text.clone()].contains('\n') || text.end == self.at;
        runs_on.then_some(text)
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

    fn entry(&mut self, bracket: Bracket, depth: usize) -> Result<Entry, SyntaxFault> {
        let key = match bracket {
            Bracket::Square => None,
            Bracket::Round => self.field()?,
            Bracket::Curly => Some(self.key(depth)?),
        };
        Ok(Entry { key, value: self.value(depth + 1)? })
    }

    /// `name:`, if that is what comes.
    fn field(&mut self) -> Result<Option<Range<usize>>, SyntaxFault> {
        let from = self.at;
        if let Some(name) = self.name() {
            self.space()?;
            if self.eat(":") || self.colon(&name) {
                return Ok(Some(name));
            }
        }
        self.at = from;
        Ok(None)
    }

    /// Whether a colon was meant after a key.
    fn colon(&mut self, key: &Range<usize>) -> bool {
        let meant = self.repairs.colons.contains(&key.end);
        if meant {
            self.eat("=");
        }
        meant
    }

    fn key(&mut self, depth: usize) -> Result<Range<usize>, SyntaxFault> {
        let key = self.value(depth + 1)?.span;
        self.space()?;
        match self.eat(":") || self.colon(&key) {
            true => Ok(key),
            false => {
                let fault = fault(format!("expected `:` after the key, found {}", self.found()), self.here());
                Err(match self.peek() {
                    Some('}') | None => fault,
                    Some(_) => fault.meant(Repair::Colon(key.end), None),
                })
            }
        }
    }
}

/// A value as a message names it: short ones whole, of a group its head.
fn shown(text: &str, value: &Tree) -> String {
    let own = text.get(value.span.clone()).unwrap_or("");
    let whole = own.chars().count() <= MAX_SHOWN && !own.contains('\n');
    match &value.shape {
        _ if whole => format!("`{own}`"),
        Shape::Group { name: Some(name), .. } => format!("`{}(...)`", text.get(name.clone()).unwrap_or("")),
        Shape::Group { bracket: Bracket::Round, .. } => "`(...)`".into(),
        Shape::Group { bracket: Bracket::Square, .. } => "`[...]`".into(),
        Shape::Group { bracket: Bracket::Curly, .. } => "`{...}`".into(),
        _ => "this value".into(),
    }
}

/// The longest value that a message repeats, characters.
const MAX_SHOWN: usize = 24;

/// What may follow in a name; beyond ASCII also marks that join a letter.
fn is_name(c: char) -> bool {
    c == '_' || c.is_alphanumeric() || !(c.is_ascii() || is_space(c))
}

/// White space as `ron` has it.
fn is_space(c: char) -> bool {
    matches!(
        c,
        ' ' | '\t'
            | '\n'
            | '\r'
            | '\x0B'
            | '\x0C'
            | '\u{85}'
            | '\u{200E}'
            | '\u{200F}'
            | '\u{2028}'
            | '\u{2029}'
    )
}

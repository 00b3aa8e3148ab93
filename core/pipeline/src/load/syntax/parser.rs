//! From RON text to its syntax tree.
//!
//! The parser knows brackets, names, literals and comments, and leaves the meaning of literals to
//! `ron`. It exists because `ron` forgets places once a value is read, and because its own
//! messages cannot name the bracket that was never closed. Cost: one pass over the text. Limits:
//! nesting up to [`MAX_DEPTH`].

mod meant;
mod repairs;

pub(crate) use repairs::{Meant, SyntaxFault, TextRepairs};

use crate::load::syntax::escapes;
use crate::load::syntax::tree::{Bracket, GroupEntry, ValueShape, ValueTree};
use repairs::Repair;
use std::ops::Range;

/// The deepest nesting; far beyond any pipeline, and safe for the stack.
pub(crate) const MAX_DEPTH: usize = 60;

/// Parses a whole text: one value, with comments and white space around it.
pub(crate) fn parse(text: &str) -> Result<ValueTree, SyntaxFault> {
    repaired(text, &TextRepairs::default())
}

/// Parses a text as it is with the repairs.
pub(crate) fn repaired(text: &str, repairs: &TextRepairs) -> Result<ValueTree, SyntaxFault> {
    let mut p = Parser {
        text,
        at: 0,
        long_text: None,
        last_text: None,
        first: 0,
        lenient: false,
        repairs: repairs.clone(),
    };
    p.eat("\u{feff}");
    p.attributes()?;
    p.first = p.at;
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
    /// Where the text's own value begins.
    first: usize,
    /// True after a bracket that a repair closed: its comma may stand before that place.
    lenient: bool,
    repairs: TextRepairs,
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

    fn value(&mut self, depth: usize) -> Result<ValueTree, SyntaxFault> {
        self.space()?;
        let from = self.at;
        if depth > MAX_DEPTH {
            return Err(fault(format!("nested deeper than {MAX_DEPTH} brackets"), self.here()));
        }
        if let Some(end) = self.repairs.values.get(&self.at) {
            self.at = *end;
            return Ok(ValueTree::new(from..self.at, ValueShape::Broken));
        }
        let Some(c) = self.peek() else {
            return Err(fault("expected a value, found the end of the file", self.here()));
        };
        if let Some(bracket) = Bracket::open(c) {
            return self.group(None, from, bracket, depth);
        }
        if self.literal(c)? {
            return Ok(ValueTree::new(from..self.at, ValueShape::Literal));
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
                Ok(ValueTree::new(name, ValueShape::Name))
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
                '\\' => match escapes::escape(&self.text[self.at - 1..]) {
                    Some((length, _)) => self.at += length - 1,
                    None => return Err(self.no_escape(from, from + open, close)),
                },
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
        let fault = self.quoted_end(from..end).into_iter().fold(fault, SyntaxFault::or);
        Err(fault.meant(Repair::Value(from..end), Some((words, hint, from..from + open))))
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
    ) -> Result<ValueTree, SyntaxFault> {
        let opened = self.here();
        self.at = opened.end;
        let (inside, mut entries) = (self.at, Vec::new());
        loop {
            self.space()?;
            if self.close(bracket, &opened, &entries)? {
                break;
            }
            self.lenient = false;
            if self.peek() == Some(',') {
                return Err(self.no_entry(bracket, &opened));
            }
            let entry = self.entry(bracket, depth)?;
            let end = entry.value.span.end;
            let missing = self.repairs.commas.contains(&end);
            entries.push(entry);
            self.space()?;
            if !self.eat(",") && !missing && !self.closes(bracket) && !self.lenient {
                return Err(self.after_entry(bracket, &opened, &entries));
            }
        }
        Ok(ValueTree::new(from..self.at, ValueShape::Group { name, bracket, inside, entries }))
    }

    /// Whether the bracket ends here.
    fn closes(&self, bracket: Bracket) -> bool {
        match self.peek() {
            _ if self.repairs.closes.contains_key(&self.at) => true,
            c => c == Some(bracket.close()),
        }
    }

    fn close(
        &mut self,
        bracket: Bracket,
        opened: &Range<usize>,
        entries: &[GroupEntry],
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
            None | Some(')' | ']' | '}') => {
                let fault = self.unclosed(opened, &format!("`{}`", bracket.close()));
                Err(self.closed(fault, bracket, opened, entries))
            }
            Some(_) => Ok(false),
        }
    }

    fn entry(&mut self, bracket: Bracket, depth: usize) -> Result<GroupEntry, SyntaxFault> {
        let key = match bracket {
            Bracket::Square => None,
            Bracket::Round => self.field()?,
            Bracket::Curly => Some(self.key(depth)?),
        };
        Ok(GroupEntry { key, value: self.value(depth + 1)? })
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

//! The syntax tree of a RON text, with the place of every name and value.

use std::ops::Range;

/// A value and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ValueTree {
    /// From its first to its last character.
    pub(crate) span: Range<usize>,
    /// What it is.
    pub(crate) shape: ValueShape,
    /// True where something in it has a fault of syntax, which was told: nothing more is to be said
    /// of its text.
    pub(crate) is_broken: bool,
}

/// What a value is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ValueShape {
    /// A number, a text or a character.
    Literal,
    /// A bare name: `Otsu`, `true`.
    Name,
    /// A value that cannot be read.
    Broken,
    /// `Name(...)`, `(...)`, `[...]` or `{...}`.
    Group {
        /// The name before the bracket.
        name: Option<Range<usize>>,
        /// Which bracket.
        bracket: Bracket,
        /// The byte after the opening bracket.
        inside: usize,
        /// What stands in it.
        entries: Vec<GroupEntry>,
    },
}

/// A pair of brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bracket {
    Round,
    Square,
    Curly,
}

/// One value of a group, with its field name or map key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct GroupEntry {
    pub(crate) key: Option<Range<usize>>,
    pub(crate) value: ValueTree,
}

impl ValueTree {
    /// Its entries; none for a literal or a name.
    pub(crate) fn entries(&self) -> &[GroupEntry] {
        match &self.shape {
            ValueShape::Group { entries, .. } => entries,
            _ => &[],
        }
    }

    /// A value in which nothing is broken.
    pub(crate) fn new(span: Range<usize>, shape: ValueShape) -> Self {
        ValueTree { span, shape, is_broken: false }
    }

    /// The entry of that key, or of that number where entries have none.
    pub(crate) fn entry(&self, text: &str, name: &str) -> Option<&GroupEntry> {
        let is_it = |(i, e): &(usize, &GroupEntry)| match &e.key {
            Some(key) => text.get(key.clone()).is_some_and(|k| k.trim_matches('"') == name),
            None => i.to_string() == name,
        };
        self.entries().iter().enumerate().find(is_it).map(|(_, e)| e)
    }

    /// What to underline where a whole group would be too much: its name, or its bracket.
    pub(crate) fn head(&self) -> Range<usize> {
        match &self.shape {
            ValueShape::Group { name: Some(name), .. } => name.clone(),
            ValueShape::Group { .. } => self.span.start..self.span.start + 1,
            _ => self.span.clone(),
        }
    }

    /// What a fault at the byte `at` should underline: a field's name where it lies there, else the
    /// smallest value that covers it (of a named group, the name), with the field that holds it.
    pub(crate) fn locate(&self, at: usize) -> (Range<usize>, Option<Range<usize>>) {
        let (mut tree, mut key) = (self, None);
        while let Some(e) = tree.entries().iter().find(|e| covers(e, at)) {
            if let Some(k) = e.key.as_ref().filter(|k| k.contains(&at)) {
                return (k.clone(), None);
            }
            key = e.key.clone().or(key);
            tree = &e.value;
        }
        match &tree.shape {
            ValueShape::Group { name: Some(name), .. } if name.contains(&at) => (name.clone(), key),
            _ => (tree.span.clone(), key),
        }
    }
}

fn covers(e: &GroupEntry, at: usize) -> bool {
    let from = e.key.as_ref().map_or(e.value.span.start, |k| k.start);
    (from..e.value.span.end).contains(&at)
}

impl Bracket {
    /// The character that closes it.
    pub(crate) fn close(self) -> char {
        match self {
            Bracket::Round => ')',
            Bracket::Square => ']',
            Bracket::Curly => '}',
        }
    }

    /// The bracket that a character opens.
    pub(crate) fn open(c: char) -> Option<Self> {
        match c {
            '(' => Some(Bracket::Round),
            '[' => Some(Bracket::Square),
            '{' => Some(Bracket::Curly),
            _ => None,
        }
    }
}

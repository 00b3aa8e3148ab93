//! Faults of syntax, what may have been meant at one, and how a text is read with that.

use crate::load::syntax::tree::{ValueShape, ValueTree};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Why a text is no RON.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SyntaxFault {
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
    pub(crate) span: Range<usize>,
    /// Other places that it is about, with what is there.
    pub(crate) also: Vec<(Range<usize>, &'static str)>,
    /// Where the parser stood.
    pub(super) at: usize,
    /// What may have been meant.
    pub(crate) meant: Vec<Meant>,
}

/// One thing that may have been meant: how the text is to be read, and what is to be said of it
/// then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Meant {
    pub(crate) repair: Repair,
    /// Message, hint and place in those words; none where those of the fault serve.
    pub(crate) words: Option<(String, Option<String>, Range<usize>)>,
}

/// How a faulty text is read all the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Repair {
    /// There is a comma at that byte.
    Comma(usize),
    /// There is a comma at that byte in place of what stands there.
    CommaFor(usize, Range<usize>),
    /// There is a colon at that byte.
    Colon(usize),
    /// The bracket at work is closed at that byte.
    Close(usize),
    /// What stands there is not there.
    Skip(Range<usize>),
    /// What stands there closes the bracket at work.
    Closer(Range<usize>),
    /// What stands there is one value.
    Value(Range<usize>),
}

impl Repair {
    /// Whether the text of a value has it inside.
    fn is_in(&self, value: &Range<usize>) -> bool {
        match self {
            Repair::Close(at) => (value.start..=value.end).contains(at),
            Repair::Comma(at) | Repair::CommaFor(at, _) | Repair::Colon(at) => value.contains(at),
            Repair::Skip(span) | Repair::Closer(span) | Repair::Value(span) => value.contains(&span.start),
        }
    }
}

/// Repairs of a text, each at its byte.
#[derive(Debug, Clone, Default)]
pub(crate) struct TextRepairs {
    pub(super) commas: BTreeSet<usize>,
    pub(super) colons: BTreeSet<usize>,
    /// How many brackets are closed.
    pub(super) closes: BTreeMap<usize, usize>,
    pub(super) skips: BTreeMap<usize, usize>,
    pub(super) values: BTreeMap<usize, usize>,
    list: Vec<Repair>,
}

impl TextRepairs {
    /// Says of every value whether something in it was repaired.
    pub(crate) fn mark(&self, tree: &mut ValueTree) {
        tree.is_broken = self.list.iter().any(|r| r.is_in(&tree.span));
        if let (true, ValueShape::Group { entries, .. }) = (tree.is_broken, &mut tree.shape) {
            entries.iter_mut().for_each(|e| self.mark(&mut e.value));
        }
    }

    /// The same with one more.
    pub(crate) fn with(&self, repair: &Repair) -> Self {
        let mut all = self.clone();
        all.list.push(repair.clone());
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
    pub(crate) fn reached(&self) -> usize {
        self.at
    }

    /// Adds what may have been meant, with the words for it.
    pub(super) fn meant(self, repair: Repair, words: Option<(String, Option<String>, Range<usize>)>) -> Self {
        self.or(Meant { repair, words })
    }

    /// Adds what may have been meant.
    pub(super) fn or(mut self, meant: Meant) -> Self {
        self.meant.push(meant);
        self
    }
}

//! Where each part of a changed text comes from: the file as it stands, a `--set` of the command
//! line, or a quality.
//!
//! A pipeline is checked and run with its overrides spliced in; what is wrong is shown where the
//! user wrote it. Cost: linear in the overrides for each place.

use super::fault::{Fault, Label};
use std::ops::Range;

/// What was put into a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct InsertedText {
    /// Where it stands now.
    pub(super) span: Range<usize>,
    /// The length of what stands in it before its value, a key with its colon.
    pub(super) before: usize,
    /// The number of the override.
    pub(super) number: usize,
    /// Who wrote it.
    pub(super) writer: Writer,
}

/// Who wrote an override.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Writer {
    /// The command line: the option as it is written, and where its value stands in it.
    Option(String, usize),
    /// A quality of that name.
    Quality(String),
}

/// A replaced part of a text: its start, and its length before and after.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Splice {
    start: usize,
    was: usize,
    is: usize,
}

/// The changes of a text, in their order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct TextChanges {
    regions: Vec<InsertedText>,
    splices: Vec<Splice>,
}

impl TextChanges {
    /// Notes that `at` was replaced by a text of the length `is`, in which the region stands.
    pub(super) fn note(&mut self, at: &Range<usize>, is: usize, region: InsertedText) {
        let moved = |x: usize| if x >= at.end { x + is - at.len() } else { x.min(at.start) };
        for r in &mut self.regions {
            r.span = moved(r.span.start)..moved(r.span.end);
        }
        self.regions.retain(|r| !r.span.is_empty());
        self.splices.push(Splice { start: at.start, was: at.len(), is });
        self.regions.push(region);
    }

    /// The number of the override in whose value a fault lies.
    pub(super) fn number(&self, fault: &Fault) -> Option<usize> {
        self.region(fault.start()).map(|r| r.number)
    }

    /// A fault of the changed text as one of the file or of an option.
    pub(super) fn told(&self, mut fault: Fault) -> Fault {
        let main = self.region(fault.start()).map(|r| (r, r.writer.clone()));
        match main {
            _ if fault.option.is_some() || fault.labels.is_empty() => fault,
            Some((region, Writer::Option(option, value))) => {
                let inside = |l: &Label| covers(&region.span, &l.span);
                let labels = fault.labels.iter().filter(|l| inside(l));
                let in_option =
                    |l: &Label| Label { span: in_option(region, &option, value, l), text: l.text.clone() };
                fault.labels = labels.map(in_option).collect();
                if fault.labels.is_empty() {
                    fault.labels.push(Label { span: value..option.len(), text: String::new() });
                }
                fault.of_option(option)
            }
            main => {
                if let Some((_, Writer::Quality(name))) = main {
                    fault.message.push_str(&format!(" (from the quality `{name}`)"));
                }
                // What stands in an option has no place in the file.
                let mut first = true;
                fault.labels.retain(|l| std::mem::take(&mut first) || self.region(l.span.start).is_none());
                for label in &mut fault.labels {
                    let start = self.before(label.span.start);
                    label.span = start..self.before(label.span.end).max(start);
                }
                fault
            }
        }
    }

    /// The last change in which a place lies.
    fn region(&self, at: usize) -> Option<&InsertedText> {
        self.regions.iter().rev().find(|r| r.span.contains(&at))
    }

    /// A place of the changed text in the text as it was.
    fn before(&self, at: usize) -> usize {
        self.splices.iter().rev().fold(at, |at, s| match at {
            at if at < s.start => at,
            at if at >= s.start + s.is => at - s.is + s.was,
            _ => s.start,
        })
    }
}

fn covers(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// A label in an option's value; one in the key is put at all of the option.
fn in_option(region: &InsertedText, option: &str, value: usize, label: &Label) -> Range<usize> {
    let from = region.span.start + region.before;
    let whole = value..option.len();
    match label.span.start.checked_sub(from) {
        None => 0..option.len(),
        Some(offset) => {
            let span = value + offset..value + offset + label.span.len();
            // Where another option changed the value, its places are not this option's.
            if option.get(span.clone()).is_some() { span } else { whole }
        }
    }
}

//! What is wrong with a pipeline file, and where.
//!
//! One list of faults has three faces: a line each for logs (`vest.ron:12:5: message; hint`), a
//! picture with underlined source for people, and records for `--json`.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, Severity, SourceCode};
use serde::Serialize;
use std::fmt::{self, Display, Formatter, Write};
use std::ops::Range;

/// The most faults that are drawn with their source; a file with more has one cause for most.
const MAX_DRAWN: usize = 50;

/// Lines longer than this, bytes, are not drawn: nobody could read them.
const MAX_LINE: usize = 2000;

/// A place in the pipeline's text, with what is to be said of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Bytes of the text, on character boundaries.
    pub span: Range<usize>,
    /// What is there: `takes a mask`. Empty where the message says it all.
    pub text: String,
}

/// One fault of a pipeline file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// A stable word that scripts can match: `unknown_stage`.
    pub code: &'static str,
    /// One sentence in lower case, without a full stop.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
    /// Its places; the first is the main one.
    pub labels: Vec<Label>,
    /// The option of the command line that its places are in, as the user wrote it:
    /// `--set body.height=3`; none where they are in the file.
    pub option: Option<String>,
}

impl Fault {
    /// A fault with a code and a sentence, at no place yet.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Fault { code, message: message.into(), hint: None, labels: Vec::new(), option: None }
    }

    /// Adds a place: the first call gives the main one.
    pub fn at(mut self, span: &Range<usize>, text: impl Into<String>) -> Self {
        self.labels.push(Label { span: span.clone(), text: text.into() });
        self
    }

    /// Adds a hint, where there is one.
    pub fn hint(mut self, hint: impl Into<Option<String>>) -> Self {
        self.hint = hint.into();
        self
    }

    /// Says that its places are in an option of the command line.
    pub fn of_option(mut self, option: impl Into<String>) -> Self {
        self.option = Some(option.into());
        self
    }

    /// The first byte of its main place.
    pub fn start(&self) -> usize {
        self.labels.first().map_or(0, |l| l.span.start)
    }
}

/// All faults of one pipeline file, in the order of their places.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Faults {
    /// The file's name as the user gave it.
    pub file: String,
    /// The file's text, which the places refer to that are in no option.
    pub text: String,
    /// At least one.
    pub faults: Vec<Fault>,
}

/// One fault for machines.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FaultRecord {
    /// The file's name; of a fault in an option of the command line, that option.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The stable word.
    pub code: &'static str,
    /// The sentence.
    pub message: String,
    /// What the user may do about it.
    pub hint: Option<String>,
}

impl Faults {
    /// Faults in the order of their places; those of options, in the options' order, come first.
    pub fn new(file: &str, text: &str, mut faults: Vec<Fault>) -> Self {
        faults.sort_by_key(|f| (f.option.is_none(), if f.option.is_none() { f.start() } else { 0 }));
        Faults { file: file.to_owned(), text: text.to_owned(), faults }
    }

    /// The machine form.
    pub fn records(&self) -> Vec<FaultRecord> {
        let lines = LineStarts::of(&self.text);
        let record = |f: &Fault| {
            let (line, column) = match &f.option {
                Some(option) => LineStarts::of(option).position(option, f.start()),
                None => lines.position(&self.text, f.start()),
            };
            FaultRecord {
                file: f.option.as_ref().unwrap_or(&self.file).clone(),
                line,
                column,
                code: f.code,
                message: f.message.clone(),
                hint: f.hint.clone(),
            }
        };
        self.faults.iter().map(record).collect()
    }

    /// The faults with their source lines, every place underlined; in colour where `colour` is set.
    pub fn render(&self, colour: bool) -> String {
        let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
        let handler = GraphicalReportHandler::new_themed(theme).with_width(100).with_links(false);
        let mut out = String::new();
        for (fault, line) in self.faults.iter().zip(self.lines()).take(MAX_DRAWN) {
            out.push_str(if out.is_empty() { "" } else { "\n" });
            let drawn = self.can_draw(fault)
                && handler.render_report(&mut out, &DrawnFault { fault, of: self }).is_ok();
            if !drawn {
                let _ = writeln!(out, "  {line}");
            }
        }
        if self.faults.len() > MAX_DRAWN {
            let _ = writeln!(out, "... and {} more faults", self.faults.len() - MAX_DRAWN);
        }
        out
    }
}

impl Faults {
    /// Each fault as one line: `vest.ron:12:5: message; hint`, or
    /// `--set body.height=3: message; hint`.
    pub fn lines(&self) -> Vec<String> {
        let line = |(r, fault): (FaultRecord, &Fault)| {
            let hint = r.hint.map_or_else(String::new, |h| format!("; {h}"));
            match &fault.option {
                Some(option) => format!("{option}: {}{hint}", r.message),
                None => format!("{}:{}:{}: {}{hint}", r.file, r.line, r.column, r.message),
            }
        };
        self.records().into_iter().zip(&self.faults).map(line).collect()
    }

    /// The text that a fault's places are in.
    fn source<'a>(&'a self, fault: &'a Fault) -> &'a str {
        fault.option.as_ref().unwrap_or(&self.text)
    }

    fn can_draw(&self, fault: &Fault) -> bool {
        let text = self.source(fault);
        let fits = |l: &Label| {
            let before = text.get(..l.span.start).and_then(|t| t.rfind('\n')).map_or(0, |i| i + 1);
            let rest = text.get(l.span.end..).unwrap_or("");
            let after = rest.find('\n').unwrap_or(rest.len());
            (l.span.end + after).saturating_sub(before) <= MAX_LINE
        };
        !text.is_empty() && fault.labels.iter().all(fits)
    }
}

impl Display for Faults {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines().join("\n"))
    }
}

impl std::error::Error for Faults {}

/// Where each line of a text starts.
pub(super) struct LineStarts(Vec<usize>);

impl LineStarts {
    /// The lines of `text`.
    pub(super) fn of(text: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        LineStarts(std::iter::once(0).chain(ends).collect())
    }

    /// Line and column (characters) of a byte, both from 1. A byte order mark has no column.
    pub(super) fn position(&self, text: &str, at: usize) -> (usize, usize) {
        let line = self.0.partition_point(|start| *start <= at);
        let start = self.0.get(line.saturating_sub(1)).copied().unwrap_or(0);
        let before = text.get(start..at.max(start)).unwrap_or("").trim_start_matches('\u{feff}');
        (line.max(1), before.chars().count() + 1)
    }
}

/// One fault as miette draws it.
struct DrawnFault<'a> {
    fault: &'a Fault,
    of: &'a Faults,
}

impl fmt::Debug for DrawnFault<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.fault.fmt(f)
    }
}

impl Display for DrawnFault<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.fault.message)
    }
}

impl std::error::Error for DrawnFault<'_> {}

impl Diagnostic for DrawnFault<'_> {
    fn severity(&self) -> Option<Severity> {
        Some(Severity::Error)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.fault.hint.as_ref().map(|h| Box::new(h) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let labeled = |(i, l): (usize, &Label)| {
            let text = (!l.text.is_empty()).then(|| l.text.clone());
            match i {
                0 => LabeledSpan::new_primary_with_span(text, l.span.clone()),
                _ => LabeledSpan::new_with_span(text, l.span.clone()),
            }
        };
        Some(Box::new(self.fault.labels.iter().enumerate().map(labeled)))
    }
}

impl SourceCode for DrawnFault<'_> {
    fn read_span<'a>(
        &'a self,
        span: &miette::SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn miette::SpanContents<'a> + 'a>, miette::MietteError> {
        let inner = self.of.source(self.fault).read_span(span, before, after)?;
        let name = if self.fault.option.is_some() { "command line" } else { &self.of.file };
        Ok(Box::new(miette::MietteSpanContents::new_named(
            name.to_owned(),
            inner.data(),
            *inner.span(),
            inner.line(),
            inner.column(),
            inner.line_count(),
        )))
    }
}

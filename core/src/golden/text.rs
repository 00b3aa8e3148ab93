//! A sheet as text and back.

use super::{Section, Sheet, SheetMeasure};
use std::fmt::Write;

/// A line of a sheet that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct SheetError {
    /// Its number, from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

impl std::fmt::Display for Sheet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for section in &self.0 {
            writeln!(f, "[{}]", section.title())?;
            for m in &section.measures {
                writeln!(f, "{} = {}", m.name, value_text(m))?;
            }
            writeln!(f, "digest = {}\n", section.digest)?;
        }
        Ok(())
    }
}

fn value_text(m: &SheetMeasure) -> String {
    let mut s = tidy(m.value);
    if !m.unit.is_empty() {
        let _ = write!(s, " {}", m.unit);
    }
    let _ = write!(s, " +- {}", tidy(m.tolerance));
    s
}

/// Six significant decimals are finer than any tolerance, and keep the sheet readable.
fn tidy(x: f64) -> String {
    let text = format!("{x:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Reads a sheet.
///
/// Errors: the first line that is neither a heading, a measure, a digest, empty nor a comment.
pub fn parse(text: &str) -> Result<Sheet, SheetError> {
    let mut sheet = Sheet::default();
    for (i, line) in text.lines().enumerate() {
        let fault = |message: &str| SheetError { line: i + 1, message: message.to_owned() };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(title) = line.strip_prefix('[') {
            let title = title.strip_suffix(']').ok_or_else(|| fault("a heading ends with `]`"))?;
            sheet.0.push(heading(title).ok_or_else(|| fault("a heading is `[STAGE KIND NAME]`"))?);
            continue;
        }
        let section = sheet.0.last_mut().ok_or_else(|| fault("a measure stands before the first heading"))?;
        let (name, value) =
            line.split_once(" = ").ok_or_else(|| fault("a measure is `NAME = VALUE UNIT +- TOLERANCE`"))?;
        match name {
            "digest" => section.digest = value.to_owned(),
            _ => section.measures.push(
                measure(name, value).ok_or_else(|| fault("a measure is `NAME = VALUE UNIT +- TOLERANCE`"))?,
            ),
        }
    }
    Ok(sheet)
}

fn heading(title: &str) -> Option<Section> {
    let mut words = title.splitn(3, ' ');
    let (stage, kind) = (words.next()?.to_owned(), words.next()?.replace('_', " "));
    let entry = words.next().unwrap_or("").to_owned();
    Some(Section { stage, kind, entry, measures: Vec::new(), digest: String::new() })
}

fn measure(name: &str, text: &str) -> Option<SheetMeasure> {
    let (value, tolerance) = text.split_once(" +- ")?;
    let (number, unit) = value.split_once(' ').unwrap_or((value, ""));
    Some(SheetMeasure {
        name: name.to_owned(),
        value: number.parse().ok()?,
        unit: unit.to_owned(),
        tolerance: tolerance.trim().parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    const EXAMPLE: &str = "[GridMesher panel front]\narea = 2412.31 cm2 +- 1\nboundary_loops = 1 +- 0\ndigest = 5f2a\n\n[Place garment]\nvertices = 2 +- 0.02\ndigest = 00ff\n\n";

    #[test]
    fn a_sheet_reads_back_as_it_was_written() {
        assert_eq!(parse(EXAMPLE).unwrap().to_string(), EXAMPLE);
    }

    #[test]
    fn a_fault_names_its_line() {
        let fault = parse("[A panel]\narea 12").unwrap_err();
        assert_eq!(fault.to_string(), "line 2: a measure is `NAME = VALUE UNIT +- TOLERANCE`");
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "[\\[\\]a-z0-9 =+\\-.\n#]{0,200}") {
            let _ = parse(&text);
        }
    }
}

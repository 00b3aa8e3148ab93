//! What the writers of patterns have in common.

use crate::file_names::check_name;
use toile_core::prelude::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::{DrawingOptions, WriteError, Written};

/// The widest seam allowance, metres.
const WIDEST: f64 = 0.2;

/// Cloth beyond the lines that are sewn.
#[params]
#[derive(Copy)]
pub(crate) struct SeamAllowances {
    /// Seam allowance of edges that are sewn.
    #[param(default = Length::mm(10.0), min = 0.0, max = WIDEST)]
    pub(crate) seam_allowance: Length,
    /// Allowance of edges that are not sewn, such as hems.
    #[param(default = Length::mm(20.0), min = 0.0, max = WIDEST)]
    pub(crate) hem_allowance: Length,
}

impl SeamAllowances {
    /// The options of a drawing with these allowances.
    pub(crate) fn options(&self, size: &str) -> DrawingOptions {
        let (sewn, free) = (self.seam_allowance.metres(), self.hem_allowance.metres());
        DrawingOptions {
            allowances: Allowances { sewn, free, ..Allowances::default() },
            size: size.to_owned(),
            ..DrawingOptions::default()
        }
    }
}

/// The file and the file of its seams; what the format cannot hold is reported.
pub(crate) fn files(
    name: &str,
    ending: &str,
    written: Result<Written, WriteError>,
    cx: &Context,
) -> Result<OutputFiles, StageError> {
    check_name(name)?;
    let Written { bytes, seams, notes, warnings } = written.map_err(refused)?;
    folded(notes).into_iter().for_each(|what| cx.note(what));
    folded(warnings).into_iter().for_each(|what| cx.warn(what));
    let mut files = vec![OutputFile::new(format!("{name}{ending}"), bytes)];
    if !seams.is_empty() {
        files.push(OutputFile::new(format!("{name}{ending}.seams.ron"), seams.into_bytes()));
    }
    Ok(OutputFiles(files))
}

/// Why a pattern is not written, with what can be done, at the parameter that decides it.
pub(crate) fn refused(e: WriteError) -> StageError {
    let error = StageError::invalid(e.to_string()).hint(e.remedy());
    match e {
        WriteError::Pages { .. }
        | WriteError::Sheet { .. }
        | WriteError::SmallPage { .. }
        | WriteError::LargePage { .. } => error.at("paper"),
        WriteError::Roll { .. } => error.at("width"),
        WriteError::PlotPage { .. } => error.at("page_length"),
        WriteError::PlotUnit { .. } => error.at("units"),
        _ => error,
    }
}

/// Sentences that differ in names and numbers alone, as one: the first, and how many more there
/// are.
fn folded(notes: Vec<String>) -> Vec<String> {
    let mut kinds: Vec<(String, String, Vec<String>)> = Vec::new();
    for note in notes {
        let (plain, names) = without_names(&note);
        match kinds.iter_mut().find(|(kind, ..)| *kind == plain) {
            Some((_, _, others)) => others.extend(names),
            None => kinds.push((plain, note, Vec::new())),
        }
    }
    let one = |(_, first, others): (String, String, Vec<String>)| match others.len() {
        0 => first,
        n => {
            let named = others.iter().take(NAMED).map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ");
            let more = if n > NAMED { format!(" and {} more", n - NAMED) } else { String::new() };
            format!("{first}; the same holds of {named}{more}")
        }
    };
    kinds.into_iter().map(one).collect()
}

/// Names that a folded sentence lists.
const NAMED: usize = 3;

/// A sentence without its quoted names and its numbers, and the names joined by dots, the last
/// first (`front.hem`).
fn without_names(note: &str) -> (String, Option<String>) {
    let parts: Vec<&str> = note.split('"').collect();
    let plain: Vec<String> = parts
        .iter()
        .step_by(2)
        .map(|p| p.chars().filter(|c| !c.is_ascii_digit() && *c != '.').collect())
        .collect();
    let names: Vec<&str> = parts.iter().skip(1).step_by(2).rev().copied().collect();
    (plain.join("\""), (!names.is_empty()).then(|| names.join(".")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_of_many_pieces_is_said_once() {
        let trimmed = |edge: &str, piece: &str, left: u32| {
            format!(
                "the allowance of edge \"{edge}\" of piece \"{piece}\" is trimmed where it meets that of others: {left} % of it is left"
            )
        };
        let notes: Vec<String> = ["a", "b", "c", "d", "e"].map(|p| trimmed("dart_1", p, 40)).into();
        assert_eq!(folded(notes[..1].to_vec()), notes[..1]);
        assert_eq!(
            folded([notes.clone(), vec!["the name is too long".to_owned()]].concat()),
            [
                format!(
                    "{}; the same holds of \"b.dart_1\", \"c.dart_1\", \"d.dart_1\" and 1 more",
                    notes[0]
                ),
                "the name is too long".to_owned()
            ]
        );
    }
}

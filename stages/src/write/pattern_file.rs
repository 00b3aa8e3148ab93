//! What the writers of patterns have in common.

use super::names::check_name;
use toile_core::prelude::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::{Options, WriteError, Written};

/// The widest seam allowance, metres.
pub(super) const WIDEST: f64 = 0.2;

/// The options of a drawing with these allowances.
pub(super) fn options(seam: Length, hem: Length, size: &str) -> Options {
    let allowances = Allowances { sewn: seam.metres(), free: hem.metres(), ..Allowances::default() };
    Options { allowances, size: size.to_owned(), ..Options::default() }
}

/// The file and the file of its seams; what it does not hold is told.
pub(super) fn files(
    name: &str,
    ending: &str,
    written: Result<Written, WriteError>,
    cx: &Context,
) -> Result<OutputFiles, StageError> {
    check_name(name)?;
    let Written { bytes, seams, notes } =
        written.map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()))?;
    notes.into_iter().for_each(|what| cx.warn(what));
    let mut files = vec![OutputFile::new(format!("{name}{ending}"), bytes)];
    if !seams.is_empty() {
        files.push(OutputFile::new(format!("{name}{ending}.seams.ron"), seams.into_bytes()));
    }
    Ok(OutputFiles(files))
}

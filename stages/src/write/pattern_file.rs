//! What the writers of patterns have in common.

use super::names::check_name;
use toile_core::prelude::*;
use toile_pattern_files::allowance::Allowances;
use toile_pattern_files::{Options, WriteError, Written};

/// The widest seam allowance, metres.
const WIDEST: f64 = 0.2;

/// Cloth beyond the lines that are sewn.
#[params]
#[derive(Copy)]
pub(super) struct SeamAllowances {
    /// Seam allowance of edges that are sewn.
    #[param(default = Length::mm(10.0), min = 0.0, max = WIDEST)]
    pub(super) seam_allowance: Length,
    /// Allowance of edges that are not sewn, such as hems.
    #[param(default = Length::mm(20.0), min = 0.0, max = WIDEST)]
    pub(super) hem_allowance: Length,
}

impl SeamAllowances {
    /// The options of a drawing with these allowances.
    pub(super) fn options(&self, size: &str) -> Options {
        let (sewn, free) = (self.seam_allowance.metres(), self.hem_allowance.metres());
        Options {
            allowances: Allowances { sewn, free, ..Allowances::default() },
            size: size.to_owned(),
            ..Options::default()
        }
    }
}

/// The file and the file of its seams; what it does not hold is told.
pub(super) fn files(
    name: &str,
    ending: &str,
    written: Result<Written, WriteError>,
    cx: &Context,
) -> Result<OutputFiles, StageError> {
    check_name(name)?;
    let Written { bytes, seams, notes, warnings } =
        written.map_err(|e| StageError::invalid(e.to_string()).hint(e.remedy()))?;
    notes.into_iter().for_each(|what| cx.note(what));
    warnings.into_iter().for_each(|what| cx.warn(what));
    let mut files = vec![OutputFile::new(format!("{name}{ending}"), bytes)];
    if !seams.is_empty() {
        files.push(OutputFile::new(format!("{name}{ending}.seams.ron"), seams.into_bytes()));
    }
    Ok(OutputFiles(files))
}

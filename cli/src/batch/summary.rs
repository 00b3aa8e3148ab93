//! What all shares write together at their end: the lines of the garments that are done, in the
//! manifest's order, and the contact sheet.

use super::folder::{BatchFolder, garment};
use super::manifest::GarmentLine;
use super::page::page;
use super::record::{CostLine, GarmentRecord, ResultLine};
use super::tally::BatchTally;
use super::thumb;
use serde::Serialize;
use toile_core::StageError;
use toile_core::artifact::{Digest, OutputFile};
use toile_pipeline::write_files;

/// Writes `results.jsonl`, `costs.jsonl` and `index.html`, by the records of all shares. `tickets`
/// are those of the garments as they would be run now.
///
/// Errors: a file cannot be written.
pub(crate) fn write(
    folder: &BatchFolder,
    garments: &[GarmentLine],
    tickets: &[Digest],
) -> Result<BatchTally, StageError> {
    // Records that another share writes after this look are seen by that share's own.
    let _held = folder.shared();
    let (lines, costs): (Vec<ResultLine>, Vec<CostLine>) = garments
        .iter()
        .zip(tickets)
        .filter_map(|(g, ticket)| {
            GarmentRecord::read(&garment(folder.root(), &g.id)).filter(|record| record.ticket == *ticket)
        })
        .map(|record| (record.line, record.costs))
        .unzip();
    let tally = BatchTally::of(&lines, garments.len());
    let pictured = |id: &str| folder.garment(id).join(thumb::FILE).is_file();
    let files = [
        OutputFile::new("results.jsonl", as_lines(&lines)?.into_bytes()),
        OutputFile::new("costs.jsonl", as_lines(&costs)?.into_bytes()),
        OutputFile::new("index.html", page(&lines, &tally, &pictured).into_bytes()),
    ];
    write_files(folder.root(), &files)?;
    Ok(tally)
}

fn as_lines<T: Serialize>(all: &[T]) -> Result<String, StageError> {
    let line = |one: &T| Ok(serde_json::to_string(one)? + "\n");
    let lines: Result<String, serde_json::Error> = all.iter().map(line).collect();
    lines.map_err(|e| StageError::internal(format!("the results cannot be written: {e}")))
}

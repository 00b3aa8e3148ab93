//! What all shares write together at their end: the lines of the garments that are done, in the
//! manifest's order, and the contact sheet.

use super::folder::{BatchFolder, garment};
use super::manifest::GarmentLine;
use super::page::page;
use super::record::{CostLine, GarmentRecord, ResultLine};
use super::tally::{BatchTally, Tallies};
use super::thumb;
use crate::args::Shard;
use serde::Serialize;
use toile_core::StageError;
use toile_core::artifact::{Digest, OutputFile};
use toile_pipeline::write_files;

/// Writes `results.jsonl`, `costs.jsonl` and `index.html`, by the records of all shares. `tickets`
/// are those of the garments as they would be run now. Gives how all garments stand, and those of a
/// share.
///
/// Errors: a file cannot be written.
pub(crate) fn write(
    folder: &BatchFolder,
    garments: &[GarmentLine],
    tickets: &[Digest],
    shard: Shard,
) -> Result<Tallies, StageError> {
    // Records that another share writes after this look are seen by that share's own.
    let _held = folder.shared();
    let done: Vec<(usize, GarmentRecord)> = (0..)
        .zip(garments.iter().zip(tickets))
        .filter_map(|(place, (g, ticket))| {
            let record = GarmentRecord::read(&garment(folder.root(), &g.id));
            Some((place, record.filter(|record| record.ticket == *ticket)?))
        })
        .collect();
    let of_share = done.iter().filter(|(place, _)| shard.has(*place)).map(|(_, record)| &record.line);
    let share = BatchTally::of(of_share, (0..garments.len()).filter(|place| shard.has(*place)).count());
    let (lines, costs): (Vec<ResultLine>, Vec<CostLine>) =
        done.into_iter().map(|(_, record)| (record.line, record.costs)).unzip();
    let all = BatchTally::of(&lines, garments.len());
    let pictured = |id: &str| folder.garment(id).join(thumb::FILE).is_file();
    let files = [
        OutputFile::new("results.jsonl", as_lines(&lines)?.into_bytes()),
        OutputFile::new("costs.jsonl", as_lines(&costs)?.into_bytes()),
        OutputFile::new("index.html", page(&lines, &all, &pictured).into_bytes()),
    ];
    write_files(folder.root(), &files)?;
    Ok(Tallies { all, share })
}

fn as_lines<T: Serialize>(all: &[T]) -> Result<String, StageError> {
    let line = |one: &T| Ok(serde_json::to_string(one)? + "\n");
    let lines: Result<String, serde_json::Error> = all.iter().map(line).collect();
    lines.map_err(|e| StageError::internal(format!("the results cannot be written: {e}")))
}

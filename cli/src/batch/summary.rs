//! What all shares write together at their end: the lines of the garments that are done, in the
//! manifest's order, and the contact sheet.

use super::folder::{garment, shared};
use super::mirror::Mirror;
use super::page::page;
use super::plan::BatchPlan;
use super::record::{CostLine, GarmentRecord, ResultLine};
use super::tally::{BatchTally, Tallies};
use super::thumb;
use crate::args::Shard;
use serde::Serialize;
use std::path::Path;
use toile_core::StageError;
use toile_core::artifact::{Digest, OutputFile};
use toile_pipeline::write_files;

/// Writes `results.jsonl`, `costs.jsonl` and `index.html` into a folder and the store, by the
/// records of all shares that are of the garments as they would be run now; into the folder alone
/// where the store lacks some that it has. Gives how all garments stand, and those of a share.
///
/// Errors: a file cannot be written; the store refuses.
pub(crate) fn write(
    root: &Path,
    plan: &BatchPlan,
    shard: Shard,
    mirror: &Mirror,
    all_are_sent: bool,
) -> Result<Tallies, StageError> {
    if !all_are_sent {
        return write_folder(root, plan, shard, mirror);
    }
    let own = |id: &str, ticket: &Digest| {
        GarmentRecord::read(&garment(root, id)).filter(|record| record.ticket == *ticket)
    };
    let planned = || plan.garments.iter().zip(&plan.tickets);
    let others: Vec<&str> = match mirror.has_results() {
        true => planned().filter(|(g, ticket)| own(&g.id, ticket).is_none()).map(|(g, _)| &*g.id).collect(),
        false => Vec::new(),
    };
    mirror.write_shared(&others, &|| write_folder(root, plan, shard, mirror))
}

fn write_folder(root: &Path, plan: &BatchPlan, shard: Shard, mirror: &Mirror) -> Result<Tallies, StageError> {
    // Records that another share writes after this look are seen by that share's own.
    let _held = shared(root);
    let garments = &plan.garments;
    let done = done(root, plan, mirror);
    let of_share = done.iter().filter(|(place, _)| shard.has(*place)).map(|(_, record)| &record.line);
    let share = BatchTally::of(of_share, (0..garments.len()).filter(|place| shard.has(*place)).count());
    let (lines, costs): (Vec<ResultLine>, Vec<CostLine>) =
        done.into_iter().map(|(_, record)| (record.line, record.costs)).unzip();
    let all = BatchTally::of(&lines, garments.len());
    let pictured = |id: &str| garment(root, id).join(thumb::FILE).is_file() || mirror.has_picture(id);
    let files = [
        OutputFile::new("results.jsonl", as_lines(&lines)?.into_bytes()),
        OutputFile::new("costs.jsonl", as_lines(&costs)?.into_bytes()),
        OutputFile::new("index.html", page(&lines, &all, &pictured).into_bytes()),
    ];
    write_files(root, &files)?;
    Ok(Tallies { all, share })
}

/// The garments that are done as they would be run now, each with its place and its record.
pub(crate) fn done(root: &Path, plan: &BatchPlan, mirror: &Mirror) -> Vec<(usize, GarmentRecord)> {
    (0..)
        .zip(plan.garments.iter().zip(&plan.tickets))
        .filter_map(|(place, (g, ticket))| {
            let own = GarmentRecord::read(&garment(root, &g.id));
            let mut records = own.into_iter().chain(mirror.record(&g.id));
            Some((place, records.find(|record| record.ticket == *ticket)?))
        })
        .collect()
}

fn as_lines<T: Serialize>(all: &[T]) -> Result<String, StageError> {
    let line = |one: &T| Ok(serde_json::to_string(one)? + "\n");
    let lines: Result<String, serde_json::Error> = all.iter().map(line).collect();
    lines.map_err(|e| StageError::internal(format!("the results cannot be written: {e}")))
}

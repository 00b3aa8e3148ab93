//! `toile-lab stability --map`: where each solver holds, as tables, pictures, CSV and JSON.

use super::args::StabilityArgs;
use super::{Streams, bar, begin_writing, chosen, end_writing, failed, is_stopped, tell, usage};
use crate::exit;
use crate::map::{Map, Options, Scheme, map, pictures};
use std::path::{Path, PathBuf};
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;
use toile_trade::processor_seconds;

/// Makes the maps and writes what there is, also where Ctrl-C ends them early.
pub(super) fn run(args: &StabilityArgs, streams: &mut Streams<'_>) -> u8 {
    let schemes = match chosen(&args.maps.solvers, &Scheme::ALL, |s| s.key().to_owned()) {
        Ok(schemes) => schemes,
        Err(message) => return usage(&message, streams),
    };
    let options = options(args, schemes);
    let bar = bar();
    // Ctrl-C waits for the step under way, and then for the files.
    begin_writing();
    let made = map(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    let map = match made {
        Ok(map) => map,
        Err(e) => {
            end_writing();
            streams.tell(format!("error: {e}"));
            return exit::INVALID;
        }
    };
    let out = args.maps.out.clone().unwrap_or_else(|| PathBuf::from("out/stability-map"));
    let written = write_files(&out, &files(&map));
    end_writing();
    if let Err(e) = written {
        return failed(&e, streams);
    }
    say(&map, args.json, &out, streams);
    if map.stopped { exit::STOPPED } else { exit::DONE }
}

fn options(args: &StabilityArgs, schemes: Vec<Scheme>) -> Options {
    let usual = Options::default();
    let mut along = args.maps.along.clone();
    along.sort_unstable();
    along.dedup();
    Options {
        schemes,
        cells: args.maps.cells.unwrap_or(usual.cells),
        along: if along.is_empty() { usual.along } else { along },
        keep: args.maps.max_error.unwrap_or(usual.keep),
        longest: args.maps.limit.unwrap_or(usual.longest),
        clock: processor_seconds,
        stop: is_stopped,
    }
}

fn files(map: &Map) -> Vec<OutputFile> {
    let file = |(path, bytes): (String, Vec<u8>)| OutputFile { path, bytes };
    let texts = [("map.csv", map.to_csv()), ("map.json", map.to_json())];
    let texts = texts.map(|(name, text)| (name.to_owned(), text.into_bytes()));
    texts.into_iter().chain(pictures(map)).map(file).collect()
}

fn say(map: &Map, json: bool, out: &Path, streams: &mut Streams<'_>) {
    if json {
        return streams.say(map.to_json());
    }
    streams.say(map);
    if map.stopped {
        streams.tell("stopped; the files hold the cells so far");
    }
    streams.tell(format!("{} cells; pictures, map.csv and map.json in {}", map.cells.len(), out.display()));
}

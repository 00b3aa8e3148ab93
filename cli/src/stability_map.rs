//! `toile bench stability --map`: where each solver holds, as tables, pictures, CSV and JSON.

use crate::args::StabilityArgs;
use crate::bench::{bar, chosen, tell, usage};
use crate::interrupt::{begin_writing, end_writing, on_ctrl_c};
use crate::measuring::failed;
use crate::{Streams, exit};
use std::path::{Path, PathBuf};
use toile_cloth::bench::map::{Map, Options, Scheme, map};
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;
use toile_trade::{processor_seconds, stability_pictures};

/// Makes the maps and writes what there is, also where Ctrl-C ends them early.
pub(crate) fn run(args: &StabilityArgs, streams: &mut Streams<'_>) -> u8 {
    let schemes = match chosen(&args.maps.solvers, &Scheme::ALL, |s| s.key().to_owned()) {
        Ok(schemes) => schemes,
        Err(message) => return usage(&message, streams),
    };
    let options = options(args, schemes);
    let bar = bar(streams);
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
        longest: args.maps.limit.map_or(usual.longest, |l| l.as_secs_f64()),
        clock: processor_seconds,
        stop: || on_ctrl_c().is_cancelled(),
    }
}

fn files(map: &Map) -> Vec<OutputFile> {
    let file = |(path, bytes): (String, Vec<u8>)| OutputFile { path, bytes };
    let texts = [("map.csv", map.to_csv()), ("map.json", map.to_json())];
    let texts = texts.map(|(name, text)| (name.to_owned(), text.into_bytes()));
    texts.into_iter().chain(stability_pictures(map)).map(file).collect()
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

/// A share of one, above zero.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err(format!("`{text}` is no share; write a number above 0 and at most 1, like 0.001")),
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_are_above_zero_and_at_most_one() {
        assert_eq!(share("0.001"), Ok(0.001));
        for wrong in ["0", "-1", "1.5", "NaN", "1 mm", ""] {
            let words = format!("`{wrong}` is no share; write a number above 0 and at most 1, like 0.001");
            assert_eq!(share(wrong), Err(words));
        }
    }
}

//! `toile-lab drivers`: particles and time step against time and error, as tables, CSV and JSON.

use super::args::DriversArgs;
use super::{Streams, bar, begin_writing, chosen, end_writing, failed, is_stopped, tell, usage};
use crate::drivers::{Options, Report, Way, drivers};
use crate::exit;
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;
use toile_trade::processor_seconds;

/// Measures and writes what there is, also where Ctrl-C ends it early.
pub(super) fn run(args: &DriversArgs, streams: &mut Streams<'_>) -> u8 {
    let ways = match chosen(&args.solvers, &Way::ALL, |w| w.name()) {
        Ok(ways) => ways,
        Err(message) => return usage(&message, streams),
    };
    let options = Options { ways, longest: args.limit, clock: processor_seconds, stop: is_stopped };
    let bar = bar();
    // Ctrl-C waits for the step under way, and then for the files.
    begin_writing();
    let report = drivers(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    let written = write_files(&args.out, &files(&report));
    end_writing();
    if let Err(e) = written {
        return failed(&e, streams);
    }
    streams.say(if args.json { report.to_json() } else { report.to_string() });
    if report.stopped { exit::STOPPED } else { exit::DONE }
}

fn files(report: &Report) -> [OutputFile; 2] {
    [("drivers.csv", report.to_csv()), ("drivers.json", report.to_json())]
        .map(|(path, text)| OutputFile { path: path.to_owned(), bytes: text.into_bytes() })
}

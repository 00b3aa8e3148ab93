//! `toile bench drivers`: particles and time step against time and error, as tables, CSV and JSON.

use crate::args::DriversArgs;
use crate::bench::{bar, chosen, tell, usage};
use crate::interrupt::{begin_writing, end_writing, on_ctrl_c};
use crate::measuring::failed;
use crate::{Streams, exit};
use toile_cloth::bench::drivers::{Options, Report, Way, drivers};
use toile_core::artifact::OutputFile;
use toile_pipeline::write_files;
use toile_trade::processor_seconds;

/// Measures and writes what there is, also where Ctrl-C ends it early.
pub(crate) fn run(args: &DriversArgs, streams: &mut Streams<'_>) -> u8 {
    let ways = match chosen(&args.solvers, &Way::ALL, |w| w.name()) {
        Ok(ways) => ways,
        Err(message) => return usage(&message, streams),
    };
    let (longest, stop) = (args.limit.as_secs_f64(), || on_ctrl_c().is_cancelled());
    let options = Options { ways, longest, clock: processor_seconds, stop };
    let bar = bar(streams);
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

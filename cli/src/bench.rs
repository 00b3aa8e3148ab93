//! `toile bench`: the cloth engine against exact references and against the extremes.

use crate::args::{AccuracyArgs, StabilityArgs};
use crate::interrupt::on_ctrl_c;
use crate::progress::drawn;
use crate::{Streams, exit};
use indicatif::ProgressBar;
use std::ops::ControlFlow;
use toile_cloth::bench::accuracy::Options as Accuracy;
use toile_cloth::bench::solvers::Way;
use toile_cloth::bench::stability::Options as Stability;
use toile_cloth::bench::{self, Layout, Models, Test};

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Runs the scoreboard; fails where a limit that binds is missed.
pub(crate) fn accuracy(args: &AccuracyArgs, streams: &mut Streams<'_>) -> u8 {
    let tests = match chosen(&args.tests, &Test::ALL, |t| t.label().to_owned()) {
        Ok(tests) => tests,
        Err(message) => return usage(&message, streams),
    };
    let layouts = match chosen(&args.layouts, &Layout::ALL, |l| l.label()) {
        Ok(layouts) => layouts,
        Err(message) => return usage(&message, streams),
    };
    let models = if args.models { Models::ALL.to_vec() } else { vec![Models::DEFAULT] };
    let mut resolutions = args.along.clone();
    resolutions.sort_unstable();
    let options = Accuracy { tests, layouts, resolutions, models };
    let bar = bar(streams);
    let report = bench::accuracy(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if args.json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, report.pass())
}

/// Runs every solver on the same problems.
pub(crate) fn solvers(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar(streams);
    let report = bench::solvers(&Way::ALL, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    match report {
        Ok(report) => {
            streams.say(if json { report.to_json() } else { report.to_string() });
            verdict(report.stopped, true)
        }
        Err(e) => {
            streams.tell(format!("error: {e}"));
            exit::INVALID
        }
    }
}

/// Runs the diagnostics.
pub(crate) fn diagnostics(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar(streams);
    let report = bench::diagnostics(&mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, true)
}

/// Runs the extremes; fails where an outcome is not the one that is required.
pub(crate) fn stability(args: &StabilityArgs, streams: &mut Streams<'_>) -> u8 {
    let known = bench::stability::axes();
    let axes = match chosen(&args.axes, &known, |a| (*a).to_owned()) {
        Ok(axes) if args.axes.is_empty() => axes.into_iter().take(0).map(str::to_owned).collect(),
        Ok(axes) => axes.into_iter().map(str::to_owned).collect(),
        Err(message) => return usage(&message, streams),
    };
    let options = Stability { axes, pairs: args.pairs, large: args.large };
    let bar = bar(streams);
    let report = bench::stability(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if args.json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, report.pass())
}

/// Those of `known` whose label starts with one of `names`; all where there are no names.
pub(crate) fn chosen<T: Copy>(
    names: &[String],
    known: &[T],
    label: impl Fn(&T) -> String,
) -> Result<Vec<T>, String> {
    let fits = |name: &String, item: &T| label(item).to_lowercase().starts_with(&name.to_lowercase());
    if let Some(unknown) = names.iter().find(|n| !known.iter().any(|item| fits(n, item))) {
        let all: Vec<String> = known.iter().map(label).collect();
        return Err(format!("there is no `{unknown}`; there are {}", all.join(", ")));
    }
    let is_chosen = |item: &&T| names.is_empty() || names.iter().any(|n| fits(n, item));
    Ok(known.iter().filter(is_chosen).copied().collect())
}

/// Says what is wrong with the arguments.
pub(crate) fn usage(message: &str, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {message}"));
    exit::USAGE
}

fn verdict(stopped: bool, pass: bool) -> u8 {
    match (stopped, pass) {
        (true, _) => exit::STOPPED,
        (false, true) => exit::DONE,
        (false, false) => exit::QUALITY,
    }
}

/// The bar of a bench.
pub(crate) fn bar(streams: &Streams<'_>) -> ProgressBar {
    drawn(STEPS, "{elapsed:>4} [{bar:28}] {wide_msg}", streams)
}

/// Moves the bar, and stops at Ctrl-C.
pub(crate) fn tell(bar: &ProgressBar, share: f64, what: &str) -> ControlFlow<()> {
    bar.set_position((share * STEPS as f64) as u64);
    bar.set_message(what.to_owned());
    if on_ctrl_c().is_cancelled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

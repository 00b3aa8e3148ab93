//! `toile-lab`: the program as a function, so that tests call it without a process.

mod amounts;
mod args;
mod drivers;
mod stability_map;

use crate::accuracy::Options as Accuracy;
use crate::solvers::Way;
use crate::stability::Options as Stability;
use crate::{Layout, Models, Test, exit};
use args::{AccuracyArgs, Arguments, Command, StabilityArgs};
use clap::Parser;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ffi::OsString;
use std::io::Write;
use std::ops::ControlFlow;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_core::StageError;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Ctrl-C has asked for an end.
static STOP: AtomicBool = AtomicBool::new(false);
/// Files are being written, which is not cut short.
static WRITING: AtomicBool = AtomicBool::new(false);

/// Where the program writes: `out` for its answer, `err` for messages.
struct Streams<'a> {
    out: &'a mut dyn Write,
    err: &'a mut dyn Write,
}

impl Streams<'_> {
    fn say(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.out, "{line}");
    }

    fn tell(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.err, "{line}");
    }
}

/// Runs the program with its arguments (its name first); returns the exit code.
pub fn command<A, T>(arguments: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let mut streams = Streams { out, err };
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(e) if e.use_stderr() => {
            streams.tell(e.render().to_string().trim_end());
            return exit::USAGE;
        }
        Err(e) => {
            streams.say(e.render().to_string().trim_end());
            return exit::DONE;
        }
    };
    listen();
    match arguments.command {
        Command::Accuracy(args) => accuracy(&args, &mut streams),
        Command::Solvers { json } => solvers(json, &mut streams),
        Command::Diagnostics { json } => diagnostics(json, &mut streams),
        Command::Factors { json } => factors(json, &mut streams),
        Command::Libraries { json } => libraries(json, &mut streams),
        Command::Drivers(args) => drivers::run(&args, &mut streams),
        Command::Stability(args) if args.map => stability_map::run(&args, &mut streams),
        Command::Stability(args) => stability(&args, &mut streams),
    }
}

/// Hears Ctrl-C: the first asks for an end, a second ends the program unless it writes.
fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Where another handler stands, the system's own way of stopping stays.
        let _ = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::SeqCst) && !WRITING.load(Ordering::SeqCst) {
                std::process::exit(i32::from(exit::STOPPED));
            }
        });
    });
}

/// Whether an end was requested.
fn is_stopped() -> bool {
    STOP.load(Ordering::SeqCst)
}

fn begin_writing() {
    WRITING.store(true, Ordering::SeqCst);
}

fn end_writing() {
    WRITING.store(false, Ordering::SeqCst);
}

/// Files that could not be written.
fn failed(e: &StageError, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {}", e.message));
    exit::INVALID
}

/// Runs the scoreboard; fails where a limit that binds is missed.
fn accuracy(args: &AccuracyArgs, streams: &mut Streams<'_>) -> u8 {
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
    let bar = bar();
    let report = crate::accuracy(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if args.json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, report.pass())
}

/// Runs every solver on the same problems.
fn solvers(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar();
    let report = crate::solvers(&Way::ALL, &mut |share, what| tell(&bar, share, what));
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

/// Measures factorizations.
fn factors(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar();
    let report = crate::factors::factors(&mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    match report {
        Ok(report) => {
            streams.say(if json { report.to_json() } else { report.to_string() });
            verdict(is_stopped(), true)
        }
        Err(e) => {
            streams.tell(format!("error: {e}"));
            exit::INVALID
        }
    }
}

/// Measures kernels beside those of libraries.
fn libraries(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar();
    let report = crate::libraries::libraries(&mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    match report {
        Ok(report) => {
            streams.say(if json { report.to_json() } else { report.to_string() });
            verdict(is_stopped(), true)
        }
        Err(e) => failed(&e, streams),
    }
}

/// Runs the diagnostics.
fn diagnostics(json: bool, streams: &mut Streams<'_>) -> u8 {
    let bar = bar();
    let report = crate::diagnostics(&mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, true)
}

/// Runs the extremes; fails where an outcome is not the one that is required.
fn stability(args: &StabilityArgs, streams: &mut Streams<'_>) -> u8 {
    let known = crate::stability::axes();
    let axes = match chosen(&args.axes, &known, |a| (*a).to_owned()) {
        Ok(axes) if args.axes.is_empty() => axes.into_iter().take(0).map(str::to_owned).collect(),
        Ok(axes) => axes.into_iter().map(str::to_owned).collect(),
        Err(message) => return usage(&message, streams),
    };
    let options = Stability { axes, pairs: args.pairs, large: args.large };
    let bar = bar();
    let report = crate::stability(&options, &mut |share, what| tell(&bar, share, what));
    bar.finish_and_clear();
    streams.say(if args.json { report.to_json() } else { report.to_string() });
    verdict(report.stopped, report.pass())
}

/// Those of `known` whose label starts with one of `names`; all where there are no names.
fn chosen<T: Copy>(names: &[String], known: &[T], label: impl Fn(&T) -> String) -> Result<Vec<T>, String> {
    let fits = |name: &String, item: &T| label(item).to_lowercase().starts_with(&name.to_lowercase());
    if let Some(unknown) = names.iter().find(|n| !known.iter().any(|item| fits(n, item))) {
        let all: Vec<String> = known.iter().map(label).collect();
        return Err(format!("there is no `{unknown}`; there are {}", all.join(", ")));
    }
    let is_chosen = |item: &&T| names.is_empty() || names.iter().any(|n| fits(n, item));
    Ok(known.iter().filter(is_chosen).copied().collect())
}

/// Says what is wrong with the arguments.
fn usage(message: &str, streams: &mut Streams<'_>) -> u8 {
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
fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{elapsed:>4} [{bar:28}] {wide_msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// Moves the bar, and stops at Ctrl-C.
fn tell(bar: &ProgressBar, share: f64, what: &str) -> ControlFlow<()> {
    bar.set_position((share * STEPS as f64) as u64);
    bar.set_message(what.to_owned());
    if is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

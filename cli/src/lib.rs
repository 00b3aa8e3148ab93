//! The command line of Toile as a function, so that tests call it without a process.
//!
//! Exit codes: 0 done; 2 usage; 3 invalid input; 4 the result fails its own quality limits; 5 out
//! of time or stopped; 70 a bug.

mod ablate;
mod apart;
mod args;
mod at_hand;
mod bench;
mod bench_costs;
mod cache;
mod cards;
mod costs;
mod doctor;
mod drivers;
mod explain;
mod explain_json;
mod golden;
mod interrupt;
mod lock;
mod migrate;
mod new_stage;
mod progress;
mod qualities;
mod run;
mod schema;
mod stability_map;
mod trade;
mod tune;
mod validate;
mod watch;
mod why;

use args::{Arguments, Bench, Command, Verb};
use clap::Parser;
use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use toile_core::pipeline::Faults;
use toile_core::{Registry, panics};
use toile_trade::apart::Apart;

/// Exit codes of the command.
pub mod exit {
    /// Done.
    pub const DONE: u8 = 0;
    /// The arguments are wrong.
    pub const USAGE: u8 = 2;
    /// The input is wrong.
    pub const INVALID: u8 = 3;
    /// The result misses its quality limits.
    pub const QUALITY: u8 = 4;
    /// Out of time or stopped.
    pub const STOPPED: u8 = 5;
    /// A fault of the program or of a stage.
    pub const BUG: u8 = 70;
}

/// Where a command writes: `out` for its answer, `err` for progress and messages; and how the program starts itself.
pub(crate) struct Streams<'a> {
    /// Starts a process for a run that is measured; none where the command is called as a function.
    pub(crate) apart: Option<Apart>,
    pub(crate) out: &'a mut dyn Write,
    pub(crate) err: &'a mut dyn Write,
}

impl Streams<'_> {
    /// Writes a line of the answer. A closed pipe is the reader's choice, not an error.
    pub(crate) fn say(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.out, "{line}");
    }

    /// Shows what is wrong with a pipeline file.
    pub(crate) fn fault(&mut self, faults: &Faults) {
        let text = faults.render(std::io::stderr().is_terminal());
        self.tell(text.trim_end());
    }

    /// Says why a command is refused: to a program that asked for JSON in its answer, else to the person at the terminal.
    pub(crate) fn refuse(&mut self, json: bool, words: impl std::fmt::Display) -> u8 {
        match json {
            true => {
                let code = toile_core::ErrorCode::InvalidInput.as_str();
                self.say(serde_json::json!({ "error": code, "message": words.to_string() }));
            }
            false => self.tell(format!("error: {words}")),
        }
        exit::INVALID
    }

    /// Says that the program panicked, and what to do about it.
    fn bug(&mut self, json: bool, words: &str) -> u8 {
        let message = format!("the program panicked: {words}");
        match json {
            true => {
                let code = toile_core::ErrorCode::Internal.as_str();
                self.say(serde_json::json!({ "error": code, "message": message, "hint": panics::REPORT }));
            }
            false => {
                self.tell(format!("error: {message}"));
                self.tell(format!("  help: {}", panics::REPORT));
            }
        }
        exit::BUG
    }

    /// Writes a line for the person at the terminal.
    pub(crate) fn tell(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.err, "{line}");
    }
}

/// Runs the command with its arguments (the program's name first) and the built-in stages; returns the
/// exit code.
pub fn command<A, T>(arguments: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    command_with(&registry(), arguments, out, err)
}

/// Runs the command with the stages of a registry, so that a program of one's own can add some.
pub fn command_with<A, T>(registry: &Registry, arguments: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    started(registry, arguments, Streams { apart: None, out, err })
}

/// As [`command_with`], for a program whose `main` does nothing else: it starts itself for each run that it measures, so that
/// memory is the run's own, and a run that the system ends is one lost setting.
pub fn program<A, T>(registry: &Registry, arguments: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    panics::quiet();
    started(registry, arguments, Streams { apart: Apart::this_program(Vec::new()), out, err })
}

/// Runs the command; a panic in it is told as a bug.
fn started<A, T>(registry: &Registry, arguments: A, mut streams: Streams<'_>) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let json = arguments.iter().any(|a| a == "--json");
    match panics::caught(|| answered(registry, arguments, &mut streams)) {
        Ok(code) => code,
        Err(words) => streams.bug(json, &words),
    }
}

fn answered(registry: &Registry, arguments: Vec<OsString>, streams: &mut Streams<'_>) -> u8 {
    match Arguments::try_parse_from(arguments) {
        Ok(Arguments { command: Command::Run(args), plugins }) if args.watch => {
            watch::watch(&args, &plugins, registry, streams)
        }
        Ok(Arguments { command, plugins }) => {
            // A refused plugin ends the command, but for the list of stages and the doctor, which show it.
            let (registry, all) = with_plugins(registry, &plugins);
            streams.apart = streams.apart.take().map(|program| apart::with_plugins(program, &plugins));
            match matches!(command, Command::Stages { .. } | Command::Doctor { .. }) || all {
                true => dispatch(command, &registry, streams),
                false => refused(&registry, streams),
            }
        }
        Err(e) if e.use_stderr() => {
            streams.tell(e.render());
            exit::USAGE
        }
        Err(e) => {
            streams.say(e.render());
            exit::DONE
        }
    }
}

/// The registry with the plugins that the arguments name, and whether all of them are in it.
fn with_plugins(registry: &Registry, plugins: &[PathBuf]) -> (Registry, bool) {
    let mut registry = registry.clone();
    let loads: Vec<_> = plugins.iter().map(|p| registry.load_plugin(p, None)).collect();
    (registry, loads.iter().all(Result::is_ok))
}

/// Says which plugins were refused.
fn refused(registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    for r in registry.refused() {
        streams.tell(format!("error: {r}"));
        if let Some(hint) = &r.hint {
            streams.tell(format!("  help: {hint}"));
        }
    }
    exit::INVALID
}

/// Every built-in stage.
pub fn registry() -> Registry {
    let mut registry = Registry::new();
    toile_stages::register(&mut registry);
    registry
}

fn dispatch(command: Command, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    match command {
        Command::Run(args) => run::once(&args, registry, None, streams),
        Command::Validate(args) => validate::validate(&args, registry, streams),
        Command::Stages { schema: true, .. } => cards::schema(registry, streams),
        Command::Stages { json, .. } => cards::list(json, registry, streams),
        Command::Doctor { json } => doctor::doctor(json, registry, streams),
        Command::NewStage(args) => {
            let (name, role) = (args.name.as_str(), args.role.as_str());
            let asked = new_stage::Asked { name, role, dir: args.dir.as_deref(), core: args.core.as_deref() };
            new_stage::new_stage(&asked, registry, streams)
        }
        Command::Stage { name, json } => cards::show(&name, json, registry, streams),
        Command::Explain(args) => explain::explain(&args, registry, streams),
        Command::Why(args) => why::why(&args, registry, streams),
        Command::Cache(args) => cache::cache(&args, streams),
        Command::Lock(args) => lock::lock(&args, registry, streams),
        Command::Migrate(args) => migrate::run(&args, registry, streams),
        Command::Trade(args) => trade::run(&args, registry, streams),
        Command::Tune(args) => tune::run(&args, registry, streams),
        Command::RunApart => apart::run(registry, streams),
        Command::Golden { verb: Verb::Check(args) } => golden::check(&args, registry, streams),
        Command::Bench { what: Bench::Accuracy(args) } => bench::accuracy(&args, streams),
        Command::Bench { what: Bench::Solvers { json } } => bench::solvers(json, streams),
        Command::Bench { what: Bench::Diagnostics { json } } => bench::diagnostics(json, streams),
        Command::Bench { what: Bench::Costs(args) } => bench_costs::costs(&args, registry, streams),
        Command::Bench { what: Bench::Drivers(args) } => drivers::run(&args, streams),
        Command::Bench { what: Bench::Stability(args) } if args.map => stability_map::run(&args, streams),
        Command::Bench { what: Bench::Stability(args) } => bench::stability(&args, streams),
        Command::Golden { verb: Verb::Accept(args) } => golden::accept(&args, registry, streams),
    }
}

//! The command line of Toile as a function, so that tests call it without a process.
//!
//! Exit codes: 0 done; 2 usage; 3 invalid input; 4 the result fails its own quality limits; 5 out
//! of time or stopped; 70 a bug.

mod args;
mod at_hand;
mod batch;
mod cache;
pub mod called;
mod cards;
mod contracts;
mod doctor;
mod explain;
mod failing;
mod golden;
mod live;
mod lock;
mod migrate;
mod new_stage;
mod run;
mod schema;
mod shell;
mod terminal;
mod trading;
mod validate;
mod verify;
mod why;

use args::{Arguments, BenchCommand, Command, Verb};
use clap::Parser;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use terminal::last_words::Alive;
use terminal::streams::Streams;
use toile_core::{Registry, panics};
use toile_pipeline::plugin::load_plugin;
use toile_trade::measure::apart::Apart;

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

/// Runs the command with its arguments (the program's name first) and the built-in stages; returns
/// the exit code.
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
    started(registry, arguments, Streams::new(None, out, err), false)
}

/// As [`command_with`], for a program whose `main` does nothing else: each measured run is a
/// process of its own, so that its memory is measured alone, and a run that the system kills costs
/// one setting only. If a signal or a plugin ends the program, it prints which.
pub fn program<A, T>(registry: &Registry, arguments: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    as_program(registry, arguments, Apart::this_program(Vec::new()), out, err)
}

/// As [`program`], for one that another program runs, as Python runs `python -m toile`: `start` is
/// how it is started once more, the program first.
pub fn program_run_by<A, T>(
    start: &[OsString],
    registry: &Registry,
    arguments: A,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let apart = start.split_first().map(|(program, launch)| Apart {
        program: program.into(),
        launch: launch.to_vec(),
        arguments: Vec::new(),
    });
    as_program(registry, arguments, apart, out, err)
}

fn as_program<A, T>(
    registry: &Registry,
    arguments: A,
    apart: Option<Apart>,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    panics::quiet();
    let _alive = Alive::new();
    started(registry, arguments, Streams::new(apart, out, err), true)
}

/// Runs the command; a panic in it is reported as a bug.
fn started<A, T>(registry: &Registry, arguments: A, mut streams: Streams<'_>, is_program: bool) -> u8
where
    A: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let json = arguments.iter().any(|a| a == "--json");
    if is_program {
        terminal::last_words::as_json(json);
    }
    let code = match panics::caught(|| answered(registry, arguments, &mut streams, is_program)) {
        Ok(code) => code,
        Err(words) => streams.bug(json, &words),
    };
    streams.ended(code)
}

fn answered(
    registry: &Registry,
    arguments: Vec<OsString>,
    streams: &mut Streams<'_>,
    is_program: bool,
) -> u8 {
    match Arguments::try_parse_from(arguments) {
        Ok(arguments) => asked(arguments, registry, streams, is_program),
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

fn asked(arguments: Arguments, registry: &Registry, streams: &mut Streams<'_>, is_program: bool) -> u8 {
    let Arguments { command, plugins, color, quiet } = arguments;
    streams.behave(color, quiet);
    // A run in a process of its own is ended by the one that waits for it.
    if is_program && !matches!(command, Command::RunApart | Command::RunGarment) {
        terminal::interrupt::on_ctrl_c();
    }
    match command {
        Command::Run(args) if args.watch => live::watch::watch(&args, &plugins, registry, streams),
        command => {
            // A refused plugin ends the command, but for the list of stages and the doctor, which
            // show it.
            let (registry, all) = with_plugins(registry, &plugins);
            streams.apart =
                streams.apart.take().map(|program| trading::apart::with_plugins(program, &plugins));
            match matches!(command, Command::Stages { .. } | Command::Doctor { .. }) || all {
                true => dispatch(command, &registry, streams),
                false => refused(&registry, streams),
            }
        }
    }
}

/// The registry with the plugins that the arguments name, and whether all of them are in it.
fn with_plugins(registry: &Registry, plugins: &[PathBuf]) -> (Registry, bool) {
    let mut registry = registry.clone();
    let loads: Vec<_> = plugins.iter().map(|p| load_plugin(&mut registry, p, None)).collect();
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
    if matches!(command, Command::Doctor { .. } | Command::Bench { .. }) {
        terminal::threads::for_the_program();
    }
    match command {
        Command::Run(args) => run::once(&args, registry, None, streams),
        #[cfg(feature = "studio")]
        Command::Studio(args) => live::studio::studio(&args, registry, streams),
        Command::Batch(args) => batch::batch(&args, registry, streams),
        Command::Manifest(args) => batch::make::make(&args, streams),
        Command::Validate(args) => validate::validate(&args, registry, streams),
        Command::Stages { schema: true, .. } => cards::schema(registry, streams),
        Command::Stages { json, .. } => cards::list(json, registry, streams),
        Command::Doctor(args) => doctor::doctor(&args, registry, streams),
        Command::Completions { shell } => shell::completions(shell, streams),
        Command::Man { command } => shell::man(&command, streams),
        Command::NewStage(args) => {
            let (name, role) = (args.name.as_str(), args.role.as_deref());
            let asked =
                new_stage::AskedStage { name, role, dir: args.dir.as_deref(), core: args.core.as_deref() };
            new_stage::new_stage(&asked, registry, streams)
        }
        Command::PluginHeader => {
            streams.say(toile_core::plugin::HEADER.trim_end());
            exit::DONE
        }
        Command::Stage { name, cache_dir, json } => cards::show(&name, cache_dir, json, registry, streams),
        Command::Explain(args) => explain::command::explain(&args, registry, streams),
        Command::Why(args) => why::why(&args, registry, streams),
        Command::Verify(args) => verify::verify(&args, registry, streams),
        Command::Cache(args) => cache::cache(&args, streams),
        Command::Lock(args) => lock::lock(&args, registry, streams),
        Command::Migrate(args) => migrate::run(&args, registry, streams),
        Command::Trade(args) => trading::study::run(&args, registry, streams),
        Command::Tune(args) => trading::tune::run(&args, registry, streams),
        Command::RunApart => trading::apart::run(registry, streams),
        Command::RunGarment => batch::child::run(registry, streams),
        Command::Golden { verb: Verb::Check(args) } => golden::check(&args, registry, streams),
        Command::Bench { what: BenchCommand::Costs(args) } => {
            trading::bench_costs::costs(&args, registry, streams)
        }
        Command::Golden { verb: Verb::Accept(args) } => golden::accept(&args, registry, streams),
    }
}

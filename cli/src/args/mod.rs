//! The arguments of every sub-command.

mod amounts;
mod batch;
mod bench;
pub(crate) mod color;
mod file;
mod run;
mod shared;
#[cfg(feature = "studio")]
mod studio;
mod trade;
mod verify;

pub(crate) use batch::{BatchArgs, ManifestArgs, Shard};
pub(crate) use bench::{BenchCommand, CostsArgs};
pub(crate) use file::{
    AcceptArgs, CheckArgs, DoctorArgs, LockArgs, MigrateArgs, NewStageArgs, ValidateArgs, Verb,
};
pub(crate) use run::{CacheArgs, ExplainArgs, RunArgs, WhyArgs};
pub(crate) use shared::{CacheChoice, Overrides};
#[cfg(feature = "studio")]
pub(crate) use studio::StudioArgs;
pub(crate) use trade::{StudyArgs, TradeArgs, TuneArgs};
pub(crate) use verify::VerifyArgs;

use clap::{Parser, Subcommand};
use clap_complete::Shell;
use color::Color;
use std::path::PathBuf;

/// Photos of a garment laid flat in, a sewn and draped 3D garment out.
#[derive(Debug, Parser)]
#[command(name = "toile", version = env!("TOILE_VERSION"), arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Load a plugin's stages: a library, like target/release/libtoile_sdf.so; may be given again
    #[arg(long = "plugin", value_name = "PATH", global = true)]
    pub(crate) plugins: Vec<PathBuf>,
    /// Colour messages: on a terminal unless NO_COLOR is set or TERM is dumb, always, or never
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Color::Auto, global = true)]
    pub(crate) color: Color,
    /// Say nothing but errors and the answer that is requested: no progress, no warnings, no
    /// summary
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a pipeline and write its files
    Run(RunArgs),
    /// Open a pipeline on a page in the browser, where it is edited while it runs
    #[cfg(feature = "studio")]
    Studio(StudioArgs),
    /// Run a pipeline for every garment of a manifest, and go on where it was stopped
    Batch(BatchArgs),
    /// Write a manifest for `batch` from files or from a CSV table
    Manifest(ManifestArgs),
    /// Check pipelines without running them
    Validate(ValidateArgs),
    /// List every stage
    Stages {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
        /// Print the JSON schema of pipeline files instead
        #[arg(long, conflicts_with = "json")]
        schema: bool,
    },
    /// Make every stage and plugin, run each on tiny input, and say what fails
    Doctor(DoctorArgs),
    /// Write a crate with a stage of one's own: it builds, loads, has a test and a benchmark
    NewStage(NewStageArgs),
    /// Print the C header of plugins, for stages in other languages than Rust
    PluginHeader,
    /// Show one stage's card: what it does, its ports, parameters and promises
    Stage {
        /// The stage's name, like Otsu
        name: String,
        /// Folder of the cache, where `toile doctor --contracts` keeps what it found [default:
        /// TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile]
        #[arg(long, value_name = "DIR")]
        cache_dir: Option<PathBuf>,
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// Say what a run would do, what it would leave out, and why
    Explain(ExplainArgs),
    /// Say what a run would do again and why, or where a triangle of a result comes from
    Why(WhyArgs),
    /// Judge a finished garment of any program from its files, and write a certificate
    Verify(VerifyArgs),
    /// Show the cache of results, make room in it or empty it
    Cache(CacheArgs),
    /// Keep what a pipeline is made of beside it, to run against with `run --locked`
    Lock(LockArgs),
    /// Rewrite old pipeline files to the names that stages and parameters have now
    Migrate(MigrateArgs),
    /// Measure how a pipeline trades accuracy for time: the front of settings that nothing beats
    Trade(TradeArgs),
    /// Pick a setting for an error or a time from the measured front, and prove it by fresh runs
    Tune(TuneArgs),
    /// One run of a measurement in a process of its own: its task on standard input, its answer on
    /// standard output
    #[command(hide = true)]
    RunApart,
    /// One garment of a batch in a process of its own, in the same way
    #[command(hide = true)]
    RunGarment,
    /// Keep goldens: text sheets of measures for every edge of a pipeline
    Golden {
        #[command(subcommand)]
        verb: Verb,
    },
    /// Print what a shell needs to complete the arguments
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual's page, or that of one command, like `man golden check`
    Man {
        /// The command
        command: Vec<String>,
    },
    /// Measure what stages take
    Bench {
        #[command(subcommand)]
        what: BenchCommand,
    },
}

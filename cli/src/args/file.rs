//! Arguments of what is done to pipeline files, goldens and stages.

use super::shared::{CacheChoice, Overrides};
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    /// Pipeline files; `-` reads one from standard input
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {
    /// Stages to examine [default: all]
    pub(crate) stages: Vec<String>,
    /// Hold them to the contracts that they promise, too; what is found of plugins is kept for
    /// `toile stage`
    #[arg(long)]
    pub(crate) contracts: bool,
    /// Folder of the cache, beside which that is kept [default: TOILE_CACHE, else
    /// XDG_CACHE_HOME/toile, else ~/.cache/toile]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct LockArgs {
    /// Pipeline files; the lock of `vest.ron` is `vest.ron.lock`
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
}

#[derive(Debug, Args)]
pub(crate) struct MigrateArgs {
    /// Pipeline files
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    /// Write nothing; exit code 4 where a file is not up to date
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct NewStageArgs {
    /// The stage's name, like FineMesher or fine_mesher
    pub(crate) name: String,
    /// What it is for: reader, denoiser, panorama, view-interpolator, binariser, edge-detector,
    /// style, mesher, smoother, body, fabric, placement, collider, stitcher, draper, flattener,
    /// texturer or writer [default: what NAME ends with, else binariser]
    #[arg(long)]
    pub(crate) role: Option<String>,
    /// The folder in which the crate's own folder is made [default: the current one]
    #[arg(long)]
    pub(crate) dir: Option<PathBuf>,
    /// The folder of toile-core to build against [default: that of the source tree that this
    /// program was built from]
    #[arg(long, value_name = "PATH")]
    pub(crate) core: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Run pipelines and name the first stage that differs from the golden
    Check(CheckArgs),
    /// Record new goldens, each from two equal runs
    Accept(AcceptArgs),
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Pipeline files
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Skip a pipeline that has no golden instead of failing
    #[arg(long)]
    pub(crate) allow_missing: bool,
    /// Folder for the pictures of what differs
    #[arg(long, default_value = "out/goldens")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct AcceptArgs {
    /// Pipeline files
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
}

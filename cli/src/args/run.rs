//! Arguments of runs and of what is said before and after them.

use super::shared::{CacheChoice, Overrides};
use clap::Args;
use std::path::PathBuf;
use toile_pipeline::cache::Bytes;

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The pipeline file; `-` reads it from standard input, with paths relative to the current
    /// folder
    pub(crate) pipeline: PathBuf,
    /// Folder for the results [default: out/NAME, of standard input out/stdin]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Stop after this stage and write what it made
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Run this stage although no requested result depends on it; may be given again
    #[arg(long, value_name = "STAGE")]
    pub(crate) also: Vec<String>,
    /// Write every stage's artifacts as files as well
    #[arg(long)]
    pub(crate) keep: bool,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Number of threads, at most one for each core, which is the default; the result is the same
    /// for any number
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print the metrics as one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Run again on every edit of the pipeline, its files or its plugins, until Ctrl-C
    #[arg(long, conflicts_with = "json")]
    pub(crate) watch: bool,
    /// Compare with PIPELINE.lock and say what differs
    #[arg(long)]
    pub(crate) locked: bool,
    /// Say what was decided, and what each stage was expected to take beside what it took
    #[arg(long, short, conflicts_with = "json")]
    pub(crate) verbose: bool,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// The pipeline file; `-` reads it from standard input
    pub(crate) pipeline: PathBuf,
    /// Explain a run that stops after this stage
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Folder of a `toile trade --ablate` of this pipeline, for what decisions save [default:
    /// out/NAME-ablation or, with --quality, out/NAME-QUALITY-ablation, where it is of the pipeline
    /// as it is]
    #[arg(long, value_name = "DIR")]
    pub(crate) ablation: Option<PathBuf>,
    /// Print one JSON object and nothing else: the stages with what each will take and its range,
    /// and the decisions (docs/reference/costs.md)
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Number of threads that the run would have [default: one for each core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
}

#[derive(Debug, Args)]
pub(crate) struct WhyArgs {
    /// A pipeline file, or a result of one with --face
    pub(crate) target: PathBuf,
    /// The stage to explain [default: all that would run]
    pub(crate) stage: Option<String>,
    /// A triangle of the result, counted from 0 in the order of the file
    #[arg(long, value_name = "N", conflicts_with = "stage")]
    pub(crate) face: Option<usize>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Folder of the cache [default: TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CacheArgs {
    /// Delete what was used longest ago until this much is left, like "500 MB"
    #[arg(long, value_name = "SIZE", conflicts_with = "clear")]
    pub(crate) prune: Option<Bytes>,
    /// Delete everything
    #[arg(long)]
    pub(crate) clear: bool,
    /// Folder of the cache [default: TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

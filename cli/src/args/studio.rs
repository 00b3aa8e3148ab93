//! Arguments of `toile studio`.

use super::CacheChoice;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct StudioArgs {
    /// A pipeline file, or the folder of a project, which may be empty [default: the current
    /// folder]
    #[arg(value_name = "FILE|FOLDER")]
    pub(crate) target: Option<PathBuf>,
    /// Port of 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "N")]
    pub(crate) port: Option<u16>,
    /// Print the address and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Number of threads of a run, at most one for each core, which is the default
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
}

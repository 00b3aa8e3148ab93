//! Arguments of the bench.

use super::Overrides;
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
pub(crate) enum BenchCommand {
    /// What stages take at several edge lengths and photo sizes, and how well that is predicted
    Costs(CostsArgs),
}

#[derive(Debug, Args)]
pub(crate) struct CostsArgs {
    /// Pipeline files to measure [default: those of --from alone]
    #[arg(required_unless_present = "from")]
    pub(crate) pipelines: Vec<PathBuf>,
    /// Leave out each pipeline in turn, fit to the others, and say how well it is predicted
    #[arg(long)]
    pub(crate) check: bool,
    /// With --check: leave out this pipeline only; may be given again
    #[arg(long, value_name = "NAME", requires = "check")]
    pub(crate) without: Vec<String>,
    /// Records of an earlier measurement, to which this one is added
    #[arg(long, value_name = "FILE")]
    pub(crate) from: Option<PathBuf>,
    /// Write the records
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Write them as they are shipped: without what only a check needs
    #[arg(long, requires = "out")]
    pub(crate) slim: bool,
    /// Runs of each setting; each stage's shortest counts
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=100))]
    pub(crate) repeats: usize,
    /// Folder for photos of other sizes
    #[arg(long, value_name = "DIR", default_value = "out/costs")]
    pub(crate) work: PathBuf,
    /// The pipelines as they are, once, in this process
    #[arg(long, hide = true)]
    pub(crate) one_run: bool,
    /// Number of threads [default: one for each core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
}

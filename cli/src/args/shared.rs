//! Arguments that several commands have.

use clap::Args;
use std::path::PathBuf;
use toile_pipeline::Override;

/// Arguments that change a pipeline before it is loaded.
#[derive(Debug, Args, Default, Clone)]
pub(crate) struct Overrides {
    /// Take the settings of a named quality of the pipeline, like Draft, before those of --set
    #[arg(long, value_name = "NAME")]
    pub(crate) quality: Option<String>,
    /// Set a value of the pipeline, like `stages.GridMesher.edge="6 mm"`; may be given again
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = <Override as std::str::FromStr>::from_str)]
    pub(crate) set: Vec<Override>,
}

/// Which cache a command uses.
#[derive(Debug, Clone, Args, Default)]
pub(crate) struct CacheChoice {
    /// Run every stage, and keep no results
    #[arg(long, conflicts_with = "cache_dir")]
    pub(crate) no_cache: bool,
    /// Folder of the cache [default: TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
}

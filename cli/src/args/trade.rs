//! Arguments of measurements: trade and tune.

use super::Overrides;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;
use toile_core::Length;
use toile_pipeline::Override;
use toile_trade::knobs::slot::ReferenceValue;
use toile_trade::qualities::AskedQuality;

#[derive(Debug, Args)]
pub(crate) struct TradeArgs {
    /// The pipeline file
    pub(crate) pipeline: PathBuf,
    /// What to turn, like `mesher.edge=6..24 mm` or `solver=StaticEquilibrium,Xpbd`; may be given
    /// again [default: edge length, mesher and solver]
    #[arg(long = "knob", value_name = "KEY=VALUES")]
    pub(crate) knobs: Vec<String>,
    /// Folder for the results, and for going on with them [default: out/NAME-trade or, with
    /// --quality, out/NAME-QUALITY-trade; with --ablate -ablation]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Measure runs that stop after this stage
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Most settings, those of earlier sessions counted [default: as many as the budget allows]
    #[arg(long, value_name = "COUNT")]
    pub(crate) points: Option<usize>,
    /// Moved starts of the reference, which tell its own spread; with 0 no neighbouring meshes are
    /// tried either
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    pub(crate) starts: usize,
    /// Instead: turn round each decision that `toile explain` shows, one at a time, and print what
    /// it saves and changes
    #[arg(long, conflicts_with_all = ["knobs", "points", "starts", "jitter", "reference", "clock"])]
    pub(crate) ablate: bool,
    /// Print the record as one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
}

/// How a front is measured.
#[derive(Debug, Args)]
pub(crate) struct StudyArgs {
    /// Time for everything, like 90s, 5m or 1h [default: 5m; with `trade --ablate` none]
    #[arg(long, value_parser = super::amounts::duration)]
    pub(crate) budget: Option<Duration>,
    /// Longest run of a setting [default: a tenth of the budget; with `trade --ablate` none]
    #[arg(long, value_parser = super::amounts::duration)]
    pub(crate) limit: Option<Duration>,
    /// Runs of each setting
    #[arg(long, value_name = "COUNT", default_value_t = 2, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=100))]
    pub(crate) repeats: usize,
    /// Root mean square move of a moved start
    #[arg(long, value_name = "LENGTH", default_value = "1 mm", value_parser = super::amounts::length)]
    pub(crate) jitter: Length,
    /// Value of a knob for the reference alone, like `StaticEquilibrium.bending_continuation=true`;
    /// may be given again [default: the pipeline's own]
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) reference: Vec<ReferenceValue>,
    /// Clock of the front; on a busy machine the processors' own is steadier
    #[arg(long, value_parser = ["wall", "cpu"], default_value = "wall")]
    pub(crate) clock: String,
    /// Number of threads [default: one for each core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

impl StudyArgs {
    /// Time for a front.
    pub(crate) fn budget(&self) -> Duration {
        self.budget.unwrap_or(Duration::from_secs(300))
    }
}

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    /// The pipeline file
    pub(crate) pipeline: PathBuf,
    /// Keep 95 % of the surface this near to the reference, like "2 mm"
    #[arg(long, value_name = "LENGTH", value_parser = super::amounts::length, required_unless_present_any = ["max_time", "qualities"])]
    pub(crate) max_error: Option<Length>,
    /// Keep a run this short, like 800ms or 1s
    #[arg(long, value_name = "TIME", value_parser = super::amounts::duration)]
    pub(crate) max_time: Option<Duration>,
    /// Instead: the quickest setting for each of several errors, like "Draft=10 mm", written as the
    /// pipeline's named qualities; may be given again
    #[arg(long = "quality", value_name = "NAME=LENGTH", conflicts_with_all = ["max_error", "max_time"])]
    pub(crate) qualities: Vec<AskedQuality>,
    /// Folder of `toile trade` to pick from [default: measure now, in out/NAME-trade]
    #[arg(long, value_name = "DIR")]
    pub(crate) from: Option<PathBuf>,
    /// The pipeline file to write, beside the given one [default: NAME-tuned.ron there]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Moved starts that must keep the error as well
    #[arg(long, value_name = "COUNT", default_value_t = 10)]
    pub(crate) starts: usize,
    /// What to turn where nothing is measured yet, as for `toile trade`
    #[arg(long = "knob", value_name = "KEY=VALUES")]
    pub(crate) knobs: Vec<String>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Set a value of the pipeline, like `stages.GridMesher.edge="6 mm"`; may be given again
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = <Override as std::str::FromStr>::from_str)]
    pub(crate) set: Vec<Override>,
}

//! The arguments of every sub-command.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use std::time::Duration;
use toile_core::Length;
use toile_core::cache::Bytes;
use toile_core::pipeline::Override;
use toile_trade::qualities::Asked;
use toile_trade::slot::ReferenceValue;

/// Photos of a garment laid flat in, a sewn and draped 3D garment out.
#[derive(Debug, Parser)]
#[command(name = "toile", version, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Load a plugin's stages: a library, like target/release/libtoile_sdf.so; may be given again
    #[arg(long = "plugin", value_name = "PATH", global = true)]
    pub(crate) plugins: Vec<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a pipeline and write its files
    Run(RunArgs),
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
    Doctor {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// Write a crate with a stage of one's own: it builds, loads, has a test and a benchmark
    NewStage(NewStageArgs),
    /// Show one stage's card: what it does, its ports, parameters and promises
    Stage {
        /// The stage's name, like Otsu
        name: String,
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// Say what a run would do, what it would leave out, and why
    Explain(ExplainArgs),
    /// Say what a run would do again and why, or where a triangle of a result comes from
    Why(WhyArgs),
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
    /// One run of a measurement in a process of its own: its task on standard input, its answer on standard output
    #[command(hide = true)]
    RunApart,
    /// Keep goldens: text sheets of measures for every edge of a pipeline
    Golden {
        #[command(subcommand)]
        verb: Verb,
    },
    /// Hold the cloth engine against exact references and extremes
    Bench {
        #[command(subcommand)]
        what: Bench,
    },
}

#[derive(Debug, Subcommand)]
pub(crate) enum Bench {
    /// Six tests against exact references, at several resolutions on several meshes
    Accuracy(AccuracyArgs),
    /// Every solver on the same problems of rest: error beside time
    Solvers {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// Figures without limits: buckling, sliding, loops, shear, swinging, drape
    Diagnostics {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// The two drivers of cost, particles and time step, against time and error for every solver
    Drivers(DriversArgs),
    /// Extreme parameters, sizes and inputs: each converges or is refused by name
    Stability(StabilityArgs),
    /// What stages take at several edge lengths and photo sizes, and how well that is predicted
    Costs(CostsArgs),
}

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Tests, like E1 [default: all]
    pub(crate) tests: Vec<String>,
    /// A mesh, like irregular; may be given again [default: all]
    #[arg(long = "mesh", value_name = "MESH")]
    pub(crate) layouts: Vec<String>,
    /// Triangles along the longest side; may be given again [default: each test's own three]
    #[arg(long, value_name = "COUNT", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=2000))]
    pub(crate) along: Vec<usize>,
    /// Every membrane and bending model, not the default ones alone
    #[arg(long)]
    pub(crate) models: bool,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DriversArgs {
    /// Solvers, like xpbd or "static newton" [default: all]
    pub(crate) solvers: Vec<String>,
    /// Folder for drivers.csv and drivers.json
    #[arg(long, value_name = "DIR", default_value = "out/drivers")]
    pub(crate) out: PathBuf,
    /// Longest time of a run; what would take longer is not made
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = crate::trade::duration)]
    pub(crate) limit: Duration,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct StabilityArgs {
    /// Axes, like friction [default: all]
    pub(crate) axes: Vec<String>,
    /// All pairs of ends as well: minutes
    #[arg(long)]
    pub(crate) pairs: bool,
    /// Also the sizes that take minutes and gigabytes
    #[arg(long)]
    pub(crate) large: bool,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Instead: where each solver holds, time step against stiffness and edge length; minutes
    #[arg(long, conflicts_with_all = ["axes", "pairs", "large"])]
    pub(crate) map: bool,
    #[command(flatten)]
    pub(crate) maps: MapArgs,
}

/// How stability maps are made.
#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    /// Folder for the maps' pictures, CSV and JSON [default: out/stability-map]
    #[arg(long, value_name = "DIR", requires = "map")]
    pub(crate) out: Option<PathBuf>,
    /// A solver of the maps, like xpbd; may be given again [default: all]
    #[arg(long = "solver", value_name = "NAME", requires = "map")]
    pub(crate) solvers: Vec<String>,
    /// Values of the time step and of the stiffness [default: 9]
    #[arg(long, value_name = "COUNT", requires = "map", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=60))]
    pub(crate) cells: Option<usize>,
    /// Edges along the side of 10 cm, about; may be given again [default: 2, 6 and 14: edges of 29, 14 and 7 mm]
    #[arg(long, value_name = "COUNT", requires = "map", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=64))]
    pub(crate) along: Vec<usize>,
    /// The error that the quickest cell keeps, in lengths of the sheet [default: 0.001]
    #[arg(long, value_name = "SHARE", requires = "map", value_parser = crate::stability_map::share)]
    pub(crate) max_error: Option<f64>,
    /// Longest time of a cell; what would take longer is not run [default: 2s]
    #[arg(long, value_name = "TIME", requires = "map", value_parser = crate::trade::duration)]
    pub(crate) limit: Option<Duration>,
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
    /// Runs of each setting
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=100))]
    pub(crate) repeats: usize,
    /// Folder for photos of other sizes
    #[arg(long, value_name = "DIR", default_value = "out/costs")]
    pub(crate) work: PathBuf,
    /// Number of threads [default: one for each core]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Run pipelines and name the first stage that differs from the golden
    Check(GoldenArgs),
    /// Record new goldens, each from two equal runs
    Accept(GoldenArgs),
}

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

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The pipeline file
    pub(crate) pipeline: PathBuf,
    /// Folder for the results [default: out/NAME]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Stop after this stage and write what it made
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Run this stage though nothing asked for depends on it; may be given again
    #[arg(long, value_name = "STAGE")]
    pub(crate) also: Vec<String>,
    /// Write every stage's artifacts as files as well
    #[arg(long)]
    pub(crate) keep: bool,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Number of threads [default: one for each core]; the result is the same for any number
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
    /// Say what each stage was expected to take beside what it took
    #[arg(long, short, conflicts_with = "json")]
    pub(crate) verbose: bool,
    #[command(flatten)]
    pub(crate) cache: CacheChoice,
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

/// Which cache a command uses.
#[derive(Debug, Args, Default)]
pub(crate) struct CacheChoice {
    /// Run every stage, and keep no results
    #[arg(long, conflicts_with = "cache_dir")]
    pub(crate) no_cache: bool,
    /// Folder of the cache [default: TOILE_CACHE, else XDG_CACHE_HOME/toile, else ~/.cache/toile]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache_dir: Option<PathBuf>,
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

#[derive(Debug, Args)]
pub(crate) struct TradeArgs {
    /// The pipeline file
    pub(crate) pipeline: PathBuf,
    /// What to turn, like `mesher.edge=6..24 mm` or `solver=Rest,Xpbd`; may be given again [default: edge length, mesher and solver]
    #[arg(long = "knob", value_name = "KEY=VALUES")]
    pub(crate) knobs: Vec<String>,
    /// Folder for the results, and for going on with them [default: out/NAME-trade or, with --quality, out/NAME-QUALITY-trade; with --ablate -ablation]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Measure runs that stop after this stage
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Most settings, those of earlier sessions counted [default: as many as the budget allows]
    #[arg(long, value_name = "COUNT")]
    pub(crate) points: Option<usize>,
    /// Moved starts of the reference, which tell its own spread
    #[arg(long, value_name = "COUNT", default_value_t = 3)]
    pub(crate) starts: usize,
    /// Instead: turn round each decision that `toile explain` shows, one at a time, and print what it saves and changes
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
    #[arg(long, value_parser = crate::trade::duration)]
    pub(crate) budget: Option<Duration>,
    /// Longest run of a setting [default: a tenth of the budget; with `trade --ablate` none]
    #[arg(long, value_parser = crate::trade::duration)]
    pub(crate) limit: Option<Duration>,
    /// Runs of each setting
    #[arg(long, value_name = "COUNT", default_value_t = 2, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=100))]
    pub(crate) repeats: usize,
    /// Root mean square move of a moved start
    #[arg(long, value_name = "LENGTH", default_value = "1 mm", value_parser = crate::trade::length)]
    pub(crate) jitter: Length,
    /// Value of a knob for the reference alone, like `Rest.graded=true`; may be given again [default: the pipeline's own]
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
    #[arg(long, value_name = "LENGTH", value_parser = crate::trade::length, required_unless_present_any = ["max_time", "qualities"])]
    pub(crate) max_error: Option<Length>,
    /// Keep a run this short, like 800ms or 1s
    #[arg(long, value_name = "TIME", value_parser = crate::trade::duration)]
    pub(crate) max_time: Option<Duration>,
    /// Instead: the quickest setting for each of several errors, like "Draft=10 mm", written as the pipeline's named qualities; may be given again
    #[arg(long = "quality", value_name = "NAME=LENGTH", conflicts_with_all = ["max_error", "max_time"])]
    pub(crate) qualities: Vec<Asked>,
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
pub(crate) struct NewStageArgs {
    /// The stage's name, one word that begins with a capital, like FineMesher
    pub(crate) name: String,
    /// What it is for: denoiser, binariser, edge-detector, mesher, smoother, stitcher, collider or texturer
    #[arg(long)]
    pub(crate) role: String,
    /// The folder in which the crate's own folder is made [default: the current one]
    #[arg(long)]
    pub(crate) dir: Option<PathBuf>,
    /// The folder of toile-core, to build against it instead of the published version
    #[arg(long, value_name = "PATH")]
    pub(crate) core: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    /// Pipeline files
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Print one JSON object and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// The pipeline file
    pub(crate) pipeline: PathBuf,
    /// Explain a run that stops after this stage
    #[arg(long, value_name = "STAGE")]
    pub(crate) until: Option<String>,
    /// Folder of a `toile trade --ablate` of this pipeline, for what decisions save [default: out/NAME-ablation or, with --quality, out/NAME-QUALITY-ablation, where it is of the pipeline as it is]
    #[arg(long, value_name = "DIR")]
    pub(crate) ablation: Option<PathBuf>,
    /// Print one JSON object and nothing else: the stages with what each will take and its range, and the decisions (docs/costs.md)
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
pub(crate) struct GoldenArgs {
    /// Pipeline files
    #[arg(required = true)]
    pub(crate) pipelines: Vec<PathBuf>,
    /// Folder for the pictures of what differs
    #[arg(long, default_value = "out/goldens")]
    pub(crate) out: PathBuf,
}

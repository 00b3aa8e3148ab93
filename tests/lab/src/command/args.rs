//! Arguments of `toile-lab`.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// The cloth engine against exact references and against the extremes
#[derive(Debug, Parser)]
#[command(name = "toile-lab", version)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
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
    /// The own sparse factorization beside faer's, on matrices of cloth
    Factors {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// Own kernels beside those of libraries: times and differences
    Libraries {
        /// Print one JSON object and nothing else
        #[arg(long)]
        json: bool,
    },
    /// The two drivers of cost, particles and time step, against time and error for every solver
    Drivers(DriversArgs),
    /// Extreme parameters, sizes and inputs: each converges or is refused by name
    Stability(StabilityArgs),
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
    /// Longest time of a run, s; what would take longer is not made
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = super::amounts::seconds)]
    pub(crate) limit: f64,
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
    /// Edges along the side of 10 cm, about; may be given again [default: 2, 6 and 14: edges of 29,
    /// 14 and 7 mm]
    #[arg(long, value_name = "COUNT", requires = "map", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=64))]
    pub(crate) along: Vec<usize>,
    /// The error that the quickest cell keeps, in lengths of the sheet [default: 0.001]
    #[arg(long, value_name = "SHARE", requires = "map", value_parser = super::amounts::share)]
    pub(crate) max_error: Option<f64>,
    /// Longest time of a cell, s; what would take longer is not run [default: 2]
    #[arg(long, value_name = "SECONDS", requires = "map", value_parser = super::amounts::seconds)]
    pub(crate) limit: Option<f64>,
}

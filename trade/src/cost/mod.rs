//! What a run will take, predicted from what earlier runs took.
//!
//! Core says how much each stage is given and makes ([`toile_core::cost`]); this module holds the
//! laws that lead from there to seconds and bytes:
//!
//! - `terms`, `fit`, `law`: a stage's law, a sum of terms of its sizes with factors that are not
//!   negative; `kinds`: what a kind of garment adds to it;
//! - `bias`: how far the rules of sizes lie beside the facts;
//! - `record`, `store`, `shipped`: what stages took, on this machine and on the one of the shipped
//!   file;
//! - `costs`: the laws of all stages; `predict`: a pipeline's forecast; `meter`, `note`: facts of a
//!   run;
//! - `sweep`, `repeats`, `check`: the measurement that the shipped file comes from, and the proof
//!   by leaving pipelines out;
//! - `words`: what people read.
//!
//! docs/reference/costs.md has the figures.

mod bias;
mod check;
mod costs;
mod fit;
mod kinds;
mod law;
mod meter;
mod named;
mod note;
mod predict;
mod record;
mod repeats;
mod seen;
mod shipped;
mod store;
mod sweep;
mod terms;
mod words;
mod work;

#[cfg(test)]
mod tests;

pub use check::{PredictionCheck, StageVerdict, Tally, check};
pub use costs::{Costs, StagePlace};
pub use meter::{MemoryCount, Stopwatch};
pub use note::note;
pub use predict::{Forecast, forecast, predict, sizes, total};
pub use record::{CostFigure, CostRecord, HostMachine};
pub use repeats::shortest;
pub use shipped::{Collection, parse as parse_collection, shipped};
pub use store::{CostStore, Opened};
pub use sweep::{Variation, variations};
pub(crate) use words::time;
pub use words::{beside, check_lines, forecast_lines};

//! What `toile explain` says of a pipeline.

use crate::validate::JudgedQuality;
use toile_pipeline::Pipeline;
use toile_trade::cost::Forecast;
use toile_trade::decided::Told;

/// What is said of a pipeline.
pub(crate) struct Explained<'a> {
    pub(crate) pipeline: &'a Pipeline,
    /// Its qualities with what their claims are worth.
    pub(crate) qualities: Vec<JudgedQuality>,
    /// For each stage `None` where it runs, or why it is left out.
    pub(crate) plan: Vec<Option<String>>,
    /// What each stage is expected to take.
    pub(crate) forecasts: Vec<Forecast>,
    /// What the forecasts rest on.
    pub(crate) source: String,
    pub(crate) told: Vec<Told>,
}

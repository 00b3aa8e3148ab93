//! What runs are expected to take: the store of earlier runs, the clocks of this one.

use crate::args::CacheChoice;
use crate::cache;
use peak_alloc::PeakAlloc;
use std::collections::BTreeMap;
use toile_core::Metrics;
use toile_core::cost::{Predicted, StageCost};
use toile_core::pipeline::Pipeline;
use toile_trade::cost::{
    Collection, CostStore, Costs, Host, MemoryCount, Opened, Stopwatch, beside as lines, note, predict,
    shipped,
};

/// What is known of this machine's runs.
pub(crate) struct Known {
    pub(crate) costs: Costs,
    /// What is wrong with the store.
    pub(crate) warning: Option<String>,
    store: Option<CostStore>,
    host: Host,
    shipped: Collection,
    threads: usize,
}

impl Known {
    /// Reads the store in the cache's folder and fits; without a cache what is shipped counts alone.
    pub(crate) fn open(choice: &CacheChoice, threads: Option<u16>) -> Self {
        let cache = if choice.no_cache { None } else { cache::at(choice.cache_dir.clone()) };
        let store = cache.map(|c| CostStore::new(c.folder()));
        let (host, shipped) = (Host::here(), shipped());
        let Opened { records, warning } = store.as_ref().map_or_else(Opened::default, |s| s.open(&host));
        let threads = threads.map_or(host.cores, usize::from).min(host.cores);
        let costs = Costs::fit(&records, &shipped.records, threads);
        Known { costs, warning, store, host, shipped, threads }
    }

    /// What the laws rest on, in words.
    pub(crate) fn source(&self) -> String {
        let shipped = format!("the shipped figures of {}", self.shipped.host);
        match self.costs.own_runs() {
            0 => format!("from {shipped}; none of this machine's runs is known yet"),
            1 => format!("from one run of a stage on this machine and {shipped}"),
            n => format!("from {n} runs of stages on this machine and {shipped}"),
        }
    }

    /// What each stage is expected to take.
    pub(crate) fn by_stage(&self, pipeline: &Pipeline) -> BTreeMap<String, Predicted> {
        predict(pipeline, &self.costs).into_iter().map(|f| (f.stage, f.predicted)).collect()
    }

    /// Keeps what a run took for later forecasts. A store that cannot be written does not touch the run.
    pub(crate) fn keep(&self, pipeline: &Pipeline, costs: &[StageCost]) {
        let Some(store) = self.store.as_ref().filter(|_| !costs.is_empty()) else { return };
        let _ = store.add(&self.host, note(pipeline, costs, &self.costs, self.threads));
    }
}

/// Clocks and memory of one stage after the other; memory where the program counts it.
pub(crate) fn stopwatch() -> Stopwatch {
    Stopwatch::new(MemoryCount {
        held: || PeakAlloc.current_usage(),
        peak: || PeakAlloc.peak_usage(),
        forget: || PeakAlloc.reset_peak_usage(),
    })
}

/// Prediction beside fact, for people.
pub(crate) fn beside(metrics: &Metrics) -> Vec<String> {
    let both = |s: &toile_core::StageMetrics| Some((s.id.clone(), s.used?, s.predicted?));
    let stages: Vec<_> = metrics.stages.iter().filter_map(both).collect();
    lines(&stages.iter().map(|(id, used, predicted)| (id.as_str(), *used, *predicted)).collect::<Vec<_>>())
}

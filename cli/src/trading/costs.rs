//! What runs are expected to take: the store of earlier runs, the clocks of this one.

use crate::args::CacheChoice;
use crate::cache;
use peak_alloc::PeakAlloc;
use std::sync::OnceLock;
use toile_core::cost::{Predicted, Size};
use toile_pipeline::cost::{Expect, StageCost};
use toile_pipeline::{Metrics, Pipeline};
use toile_trade::cost::{
    Collection, CostStore, Costs, HostMachine, MemoryCount, Opened, Stopwatch, beside as lines, forecast,
    note, shipped, sizes,
};

/// What is known of this machine's runs; read, and fitted, when it is first asked for.
#[derive(Debug)]
pub(crate) struct KnownCosts {
    store: Option<CostStore>,
    host: HostMachine,
    threads: usize,
    opened: OnceLock<Opened>,
    shipped: OnceLock<Collection>,
    costs: OnceLock<Costs>,
    /// How much the stages of the pipeline that is run will be given and make.
    sizes: OnceLock<Vec<Size>>,
}

impl KnownCosts {
    /// Of the store in the cache's folder; without a cache what is shipped counts alone.
    pub(crate) fn of(choice: &CacheChoice, threads: Option<u16>) -> Self {
        let cache = if choice.no_cache { None } else { cache::at(choice.cache_dir.clone()) };
        let host = HostMachine::here();
        let threads = threads.map_or(host.cores, usize::from).min(host.cores);
        let store = cache.map(|c| CostStore::new(c.folder()));
        let (opened, shipped) = (OnceLock::new(), OnceLock::new());
        KnownCosts { store, host, threads, opened, shipped, costs: OnceLock::new(), sizes: OnceLock::new() }
    }

    /// What is wrong with the store.
    pub(crate) fn warning(&self) -> Option<&str> {
        self.opened().warning.as_deref()
    }

    /// The laws.
    pub(crate) fn costs(&self) -> &Costs {
        let fit = || Costs::fit(&self.opened().records, &self.shipped().records, self.threads);
        self.costs.get_or_init(fit)
    }

    /// What the laws rest on, in words.
    pub(crate) fn source(&self) -> String {
        let shipped = format!("the shipped figures of {}", self.shipped().host);
        match self.costs().own_runs() {
            0 => format!("from {shipped}; none of this machine's runs is known yet"),
            1 => format!("from one run of a stage on this machine and {shipped}"),
            n => format!("from {n} runs of stages on this machine and {shipped}"),
        }
    }

    /// Keeps what a run took for later forecasts. A store that cannot be written does not touch the
    /// run.
    pub(crate) fn keep(&self, pipeline: &Pipeline, costs: &[StageCost]) {
        let Some(store) = self.store.as_ref().filter(|_| !costs.is_empty()) else { return };
        // What stages made before; nothing is fitted for that.
        let earlier = Costs::fit(&self.opened().records, &[], self.threads);
        let _ = store.add(&self.host, note(pipeline, costs, &earlier, self.threads));
    }

    fn opened(&self) -> &Opened {
        self.opened.get_or_init(|| self.store.as_ref().map_or_else(Opened::default, |s| s.open(&self.host)))
    }

    fn shipped(&self) -> &Collection {
        self.shipped.get_or_init(shipped)
    }
}

impl Expect for KnownCosts {
    fn expected(&self, pipeline: &Pipeline, node: usize) -> Option<Predicted> {
        let sizes = self.sizes.get_or_init(|| sizes(pipeline, self.costs()));
        Some(forecast(pipeline, self.costs(), node, sizes.get(node)?.clone())?.predicted)
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
pub(crate) fn beside(metrics: &Metrics, known: &KnownCosts) -> Vec<String> {
    let both = |s: &toile_pipeline::StageMetrics| Some((s.id.clone(), s.used?, s.predicted?));
    let stages: Vec<_> = metrics.stages.iter().filter_map(both).collect();
    let mut lines = lines(
        &stages.iter().map(|(id, used, predicted)| (id.as_str(), *used, *predicted)).collect::<Vec<_>>(),
    );
    if !lines.is_empty() && known.costs().own_runs() == 0 {
        lines.push(format!("not measured here: what was expected is {}", known.source()));
    }
    lines
}

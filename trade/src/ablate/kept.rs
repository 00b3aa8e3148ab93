//! The runs of an ablation that are done, as `ablation.jsonl` keeps them: a line a run.

use super::AblationOptions;
use super::record::{GarmentChange, SCHEME};
use crate::digest::digest;
use crate::journal::{Journal, JournalKind};
use crate::measure::Ran;
use crate::record::{Machine, today};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;
use toile_core::StageError;
use toile_pipeline::Pipeline;

/// The record's kind.
const KIND: JournalKind = JournalKind {
    name: "ablation",
    scheme: SCHEME,
    changed: "the pipeline, --until, the machine or its number of threads has changed",
};

/// A run that is done; rounds count from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Done {
    /// The pipeline as decided.
    AsDecided { round: usize, cpu_s: f64 },
    /// With a decision turned round by an option.
    Turned { round: usize, by: String, came: Came },
}

/// What came of a run with a decision turned round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Came {
    /// It ran: processor time, what the decision saved against the run beside it, and, once a
    /// decision, what it changed.
    Ran { cpu_s: f64, saved_s: f64, change: Option<GarmentChange> },
    /// A stage refused or failed.
    Failed { message: String },
    /// It was stopped after so many seconds.
    OverLimit { seconds: f64 },
}

impl Came {
    /// Why there are no figures.
    pub(super) fn failed(&self) -> Option<String> {
        match self {
            Came::Ran { .. } => None,
            Came::Failed { message } => Some(message.clone()),
            Came::OverLimit { seconds } => Some(format!("stopped after {seconds:.0} s")),
        }
    }

    /// Whether it was stopped at a limit, which says nothing of the pipeline.
    pub(super) fn is_cut(&self) -> bool {
        matches!(self, Came::OverLimit { .. })
    }

    /// Whether a run with that limit would end no later.
    pub(super) fn stands(&self, limit: Option<Duration>) -> bool {
        match self {
            Came::OverLimit { seconds } => limit.is_some_and(|l| l.as_secs_f64() <= *seconds),
            _ => true,
        }
    }
}

/// When and where the last run was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Last {
    pub(super) date: String,
    pub(super) machine: Machine,
}

impl Last {
    fn now() -> Self {
        Last { date: today(), machine: Machine::here() }
    }
}

/// The record with its runs.
pub(super) struct KeptRecord(Journal<Last, Done>);

impl KeptRecord {
    /// The record of an earlier session of the same pipeline on the same machine, else a new one.
    ///
    /// Runs that were stopped at a shorter limit than there is now are forgotten.
    pub(super) fn open(pipeline: &Pipeline, options: &AblationOptions, tell: &mut dyn FnMut(String)) -> Self {
        let (Machine { system, cores, threads, .. }, until) =
            (Machine::here(), options.bench.until.as_deref());
        let place = format!("{system}, {cores} cores, {threads} threads");
        let base = digest(pipeline, &[until.unwrap_or(""), &place]);
        let new = || Journal::new(&options.out, KIND, base.clone(), BTreeMap::new(), Last::now());
        let mut journal = Journal::taken_up(&options.out, KIND, &base, tell).unwrap_or_else(new);
        journal.lines.retain(|done| match done {
            Done::AsDecided { .. } => true,
            Done::Turned { came, .. } => came.stands(options.limit),
        });
        if !journal.lines.is_empty() {
            tell(format!("goes on from {} runs in {}", journal.lines.len(), options.out.display()));
        }
        KeptRecord(journal)
    }

    /// Adds the first run as decided of a round, and writes.
    ///
    /// Errors: the folder cannot be written.
    pub(super) fn add_own(&mut self, round: usize, ran: &Ran) -> Result<(), StageError> {
        self.0.head.reads.clone_from(&ran.reads);
        self.add(Done::AsDecided { round, cpu_s: ran.cpu_s })
    }

    /// Adds a run with a decision turned round, and writes.
    ///
    /// Errors: the folder cannot be written.
    pub(super) fn add_turned(&mut self, round: usize, by: &str, came: Came) -> Result<(), StageError> {
        self.add(Done::Turned { round, by: by.to_owned(), came })
    }

    fn add(&mut self, done: Done) -> Result<(), StageError> {
        self.0.head.on = Last::now();
        self.0.add(done)
    }

    /// Files that the pipeline read, with the digests of their contents.
    pub(super) fn reads(&self) -> &BTreeMap<String, Option<String>> {
        &self.0.head.reads
    }

    /// When and where the last run was.
    pub(super) fn last(&self) -> &Last {
        &self.0.head.on
    }

    /// Processor times of the runs as decided by their rounds, seconds.
    pub(super) fn own(&self) -> BTreeMap<usize, f64> {
        let one = |done: &Done| match done {
            Done::AsDecided { round, cpu_s } => Some((*round, *cpu_s)),
            Done::Turned { .. } => None,
        };
        self.0.lines.iter().filter_map(one).collect()
    }

    /// What came of the runs with a decision turned round, by their rounds.
    pub(super) fn turned(&self, option: &str) -> BTreeMap<usize, &Came> {
        let lines = self.0.lines.iter();
        let its = lines.filter_map(|done| match done {
            Done::Turned { round, by, came } if by == option => Some((*round, came)),
            _ => None,
        });
        its.collect()
    }

    /// Whether a decision is to be turned round in a round: what failed once is not run again.
    pub(super) fn is_missing(&self, option: &str, round: usize) -> bool {
        let came = self.turned(option);
        !came.contains_key(&round) && came.values().all(|c| c.failed().is_none())
    }

    /// Whether it is known what a decision changes.
    pub(super) fn has_change(&self, option: &str) -> bool {
        self.turned(option).values().any(|c| matches!(c, Came::Ran { change: Some(_), .. }))
    }
}

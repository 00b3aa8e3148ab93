//! `toile trade`: how a pipeline trades accuracy for time.

use crate::args::{StudyArgs, TradeArgs};
use crate::terminal::progress::with_budget;
use crate::trading::measuring::{bench, default_folder, failed, inspected, opened, quality};
use crate::{Streams, exit, terminal::interrupt, trading::ablate};
use std::path::PathBuf;
use toile_core::{Registry, StageError};
use toile_pipeline::{Pipeline, write_files};
use toile_trade::knobs::default_knobs::default_knobs;
use toile_trade::knobs::knob::KnobSpec;
use toile_trade::knobs::source::Source;
use toile_trade::record::{Clock, Trade};
use toile_trade::study::{StudyOptions, study};
use toile_trade::table;

/// Measures, writes the files of the measurement and prints its table.
pub(crate) fn run(args: &TradeArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let (source, pipeline) = match opened(&args.pipeline, &args.overrides, registry, false, streams) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = inspected(&pipeline, args.until.clone(), streams) {
        return code;
    }
    if args.ablate {
        return ablate::run(args, &source, &pipeline, streams);
    }
    let asked = StudyRequest {
        knobs: &args.knobs,
        out: args
            .out
            .clone()
            .unwrap_or_else(|| default_folder(&args.pipeline, quality(&args.overrides), "trade")),
        until: args.until.clone(),
        points: args.points,
        starts: args.starts,
        study: &args.study,
    };
    match measured(&asked, &source, &pipeline, streams) {
        Err(e) => failed(&e, streams),
        Ok(trade) => {
            match args.json {
                true => streams.say(serde_json::to_string_pretty(&trade).unwrap_or_default()),
                false => {
                    table::lines(&trade, false).iter().for_each(|l| streams.say(l));
                    streams.say(format!("table, pictures and page in {}", asked.out.display()));
                }
            }
            exit::DONE
        }
    }
}

/// What a measurement takes from the command line.
pub(crate) struct StudyRequest<'a> {
    pub(crate) knobs: &'a [String],
    pub(crate) out: PathBuf,
    pub(crate) until: Option<String>,
    pub(crate) points: Option<usize>,
    pub(crate) starts: usize,
    pub(crate) study: &'a StudyArgs,
}

/// Measures and writes; progress goes to standard error.
pub(crate) fn measured(
    asked: &StudyRequest<'_>,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<Trade, StageError> {
    let mut knobs = asked.knobs.iter().map(|k| k.parse()).collect::<Result<Vec<KnobSpec>, _>>()?;
    if knobs.is_empty() {
        knobs = default_knobs(pipeline, source.registry);
    }
    if knobs.is_empty() {
        let message = "the pipeline has no knob that is turned by itself";
        return Err(StageError::invalid(message).hint("name some, like `--knob \"mesher.edge=6..24 mm\"`"));
    }
    let options = StudyOptions {
        out: asked.out.clone(),
        budget: asked.study.budget(),
        limit: asked.study.limit,
        points: asked.points,
        repeats: asked.study.repeats,
        starts: asked.starts,
        jitter: asked.study.jitter,
        reference: asked.study.reference.clone(),
        clock: clock(asked.study),
        bench: bench(asked.until.clone(), streams),
    };
    let trade = with_budget(asked.study, streams, |tell| study(source, pipeline, &knobs, &options, tell))?;
    let files = toile_trade::files(&trade, &asked.out)?;
    interrupt::begin_writing();
    let written = write_files(&asked.out, &files);
    interrupt::end_writing();
    written.map(|_| trade)
}

/// The clock of the front.
fn clock(study: &StudyArgs) -> Clock {
    if study.clock == "cpu" { Clock::Cpu } else { Clock::Wall }
}

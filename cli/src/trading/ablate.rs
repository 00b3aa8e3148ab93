//! `toile trade PIPELINE --ablate`: each decision of a pipeline turned round.

use crate::args::TradeArgs;
use crate::terminal::progress::with_runs;
use crate::trading::measuring::{bench, default_folder, failed, quality};
use crate::{Streams, exit, terminal::interrupt};
use std::path::Path;
use toile_core::StageError;
use toile_pipeline::{Pipeline, write_files};
use toile_trade::ablate::{Ablation, AblationOptions, ablate, files, lines};
use toile_trade::knobs::source::Source;

/// Measures, writes the files and prints the table.
pub(crate) fn run(
    args: &TradeArgs,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> u8 {
    let folder = || default_folder(&args.pipeline, quality(&args.overrides), "ablation");
    let options = AblationOptions {
        out: args.out.clone().unwrap_or_else(folder),
        repeats: args.study.repeats,
        budget: args.study.budget,
        limit: args.study.limit,
        bench: bench(args.until.clone(), streams),
    };
    let measured = with_runs(args.study.threads, streams, |tell| ablate(source, pipeline, &options, tell));
    match measured.and_then(|ablation| written(&ablation, &options.out).map(|()| ablation)) {
        Err(e) => failed(&e, streams),
        Ok(ablation) => {
            match args.json {
                true => streams.say(serde_json::to_string_pretty(&ablation).unwrap_or_default()),
                false => {
                    lines(&ablation).iter().for_each(|l| streams.say(l));
                    streams.say(format!("table in {}", options.out.display()));
                }
            }
            exit::DONE
        }
    }
}

fn written(ablation: &Ablation, out: &Path) -> Result<(), StageError> {
    let files = files(ablation)?;
    interrupt::begin_writing();
    let written = write_files(out, &files);
    interrupt::end_writing();
    written.map(drop)
}

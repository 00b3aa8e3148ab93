//! `toile bench costs`: what stages take over edge lengths and photo sizes, and how well that is predicted.

use crate::args::{CostsArgs, Overrides};
use crate::run::fail_run;
use crate::validate::open;
use crate::{Streams, costs, exit, interrupt};
use std::path::Path;
use std::sync::Arc;
use toile_core::artifact::OutputFile;
use toile_core::pipeline::Pipeline;
use toile_core::{Listener, Registry, RunError, RunOptions, run, write_files};
use toile_trade::cost::{
    Collection, CostRecord, Costs, Figure, check, check_lines, note, parse_collection, variations,
};

/// Measures, writes the records, and checks predictions on pipelines that are left out.
pub(crate) fn costs(args: &CostsArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let mut collection = match args.from.as_deref().map(read).transpose() {
        Ok(from) => from.unwrap_or_else(|| Collection::here(Vec::new())),
        Err(e) => return refused(&e, streams),
    };
    for file in &args.pipelines {
        match measure(file, args, registry, streams) {
            Ok(records) => collection.records.extend(records),
            Err(code) => return code,
        }
    }
    if let Some(out) = &args.out
        && let Err(e) = write(&collection, args.slim, out)
    {
        return refused(&e, streams);
    }
    streams.say(format!("{} runs of stages on {}", collection.records.len(), collection.host));
    if args.check {
        for figure in Figure::ALL {
            check_lines(&check(&collection.records, &args.without, figure))
                .iter()
                .for_each(|l| streams.say(l));
        }
    }
    exit::DONE
}

/// Runs a pipeline in each of its settings.
fn measure(
    file: &Path,
    args: &CostsArgs,
    registry: &Registry,
    streams: &mut Streams<'_>,
) -> Result<Vec<CostRecord>, u8> {
    let load = |overrides: &[toile_core::pipeline::Override], streams: &mut Streams<'_>| {
        let set = args.overrides.set.iter().chain(overrides).cloned().collect();
        let all = Overrides { set, ..args.overrides.clone() };
        open(file, &all, registry).map_err(|faults| {
            streams.fault(&faults);
            exit::INVALID
        })
    };
    let settings =
        variations(&load(&[], streams)?, &args.work).map_err(|e| refused(&e.to_string(), streams))?;
    // One pool for all runs: threads that end give memory back in the midst of the next run.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads.map_or(0, usize::from)).build();
    let pool = pool.map_err(|e| refused(&format!("there are no threads: {e}"), streams))?;
    let mut records = Vec::new();
    for setting in &settings {
        let pipeline = load(&setting.overrides, streams)?;
        for _ in 0..args.repeats {
            streams.tell(format!("{}: {}", pipeline.name, setting.words));
            let ran =
                pool.install(|| once(&pipeline)).map_err(|e| fail_run(&pipeline, &e, false, streams))?;
            records.extend(ran);
        }
    }
    Ok(records)
}

/// What the stages of a run without cache take.
fn once(pipeline: &Pipeline) -> Result<Vec<CostRecord>, RunError> {
    let options = RunOptions { meter: Some(Arc::new(costs::stopwatch())), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let result = run(pipeline, &options, &interrupt::on_ctrl_c(), &listener)?;
    Ok(note(pipeline, &result.costs, &Costs::default(), rayon::current_num_threads()))
}

fn read(path: &Path) -> Result<Collection, String> {
    let name = path.display();
    let text = std::fs::read_to_string(path).map_err(|e| format!("cannot read \"{name}\": {e}"))?;
    parse_collection(&text).map_err(|why| format!("\"{name}\" {why}"))
}

fn write(collection: &Collection, slim: bool, path: &Path) -> Result<(), String> {
    let text = if slim { collection.clone().slim().to_text() } else { collection.to_text() };
    let (folder, name) = (path.parent().unwrap_or(Path::new("")), path.file_name().unwrap_or_default());
    let file = OutputFile { path: name.to_string_lossy().into_owned(), bytes: text.into_bytes() };
    write_files(folder, &[file]).map(|_| ()).map_err(|e| e.to_string())
}

fn refused(message: &str, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {message}"));
    exit::INVALID
}

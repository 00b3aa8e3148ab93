//! `toile tune`: a setting for an error or a time, proved and written into the pipeline file.

use crate::args::{Overrides, TuneArgs};
use crate::terminal::progress::with_budget;
use crate::trading::measuring::{bench, failed, inspected, opened};
use crate::trading::tuned::{front, target, write};
use crate::{Streams, exit, terminal::stdin, trading::qualities};
use serde_json::json;
use std::path::Path;
use toile_core::{Registry, StageError};
use toile_pipeline::Pipeline;
use toile_trade::knobs::slot::setting_words;
use toile_trade::knobs::source::Source;
use toile_trade::record::{Clock, Trade, today};
use toile_trade::table;
use toile_trade::tune::{Prover, SettingProof, Wish, refusal};

/// Picks, proves, writes.
pub(crate) fn run(args: &TuneArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    if let Err(e) = stdin::refused(&args.pipeline, "cannot be tuned") {
        return streams.refuse(false, e);
    }
    let overrides = Overrides { set: args.set.clone(), ..Overrides::default() };
    let (source, pipeline) = match opened(&args.pipeline, &overrides, registry, false, streams) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = inspected(&pipeline, None, streams) {
        return code;
    }
    if !args.qualities.is_empty() {
        return qualities::run(args, &source, &pipeline, streams);
    }
    match tuned(args, &source, &pipeline, streams) {
        Ok(()) => exit::DONE,
        Err(e) => failed(&e, streams),
    }
}

fn tuned(
    args: &TuneArgs,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<(), StageError> {
    let file = target(args)?;
    let (trade, folder) = front(args, source, pipeline, streams)?;
    let wish = Wish {
        max_error_mm: args.max_error.map(|e| e.metres() * 1e3),
        max_time_s: args.max_time.map(|t| t.as_secs_f64()),
    };
    let bench = bench(trade.until.clone(), streams);
    let prover = Prover {
        source,
        trade: &trade,
        bench: &bench,
        folder: &folder,
        starts: args.starts,
        jitter: args.study.jitter,
    };
    let proof = match refusal(&trade, &wish) {
        // Nothing has to be run to refuse.
        Some(refused) => Err(refused),
        None => with_budget(&args.study, streams, |tell| prover.prove(&wish, tell)),
    };
    let proof = proof.inspect_err(|_| table::lines(&trade, true).iter().for_each(|l| streams.tell(l)))?;
    let text = prover.tuned(&wish, &proof, &today())?;
    write(&file, text)?;
    say(args, &trade, &wish, &proof, &file, streams);
    Ok(())
}

fn say(
    args: &TuneArgs,
    trade: &Trade,
    wish: &Wish,
    proof: &SettingProof,
    file: &Path,
    streams: &mut Streams<'_>,
) {
    let point = &trade.points[proof.point];
    let (fresh, d) = (&proof.fresh, &proof.fresh.errors.distance_mm);
    let starts: Vec<f64> = proof.starts.iter().map(|m| m.p95).collect();
    if args.json {
        streams.say(json!({
            "setting": point.setting, "overrides": point.overrides, "file": file.display().to_string(),
            "wall_s": fresh.time(Clock::Wall), "cpu_s": fresh.time(Clock::Cpu), "errors": fresh.errors,
            "starts_p95_mm": starts,
        }));
        return;
    }
    streams.say(format!("{}: {}", wish.words(), setting_words(&point.setting)));
    streams.say(format!(
        "fresh run: {:.2} s wall, {:.2} s cpu, 95 % of the surface within {:.2} mm (mean {:.2}, worst {:.2})",
        fresh.time(Clock::Wall),
        fresh.time(Clock::Cpu),
        d.p95,
        d.mean,
        d.max
    ));
    proof.starts_in_words(wish).into_iter().for_each(|words| streams.say(words));
    streams.say(format!("written: {}", file.display()));
}

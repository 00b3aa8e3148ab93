//! `toile tune PIPELINE --quality NAME=LENGTH ...`: the named qualities of a pipeline, measured and
//! written into its file.

use crate::args::TuneArgs;
use crate::terminal::progress::with_budget;
use crate::trading::measuring::{bench, failed};
use crate::trading::tuned::{front, target, write};
use crate::{Streams, exit};
use serde_json::{Value, json};
use std::path::Path;
use toile_core::StageError;
use toile_pipeline::Pipeline;
use toile_trade::knobs::slot::setting_words;
use toile_trade::knobs::source::Source;
use toile_trade::qualities::{AskedQuality, Proved, prove, written};
use toile_trade::record::{Clock, Trade, today};
use toile_trade::table;
use toile_trade::tune::{Prover, SettingProof};

/// Proves each quality, writes those that are kept, and refuses the others with the front.
pub(crate) fn run(
    args: &TuneArgs,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> u8 {
    if let Some(name) = given_twice(&args.qualities) {
        return streams.misused(&format!("the quality `{name}` is given twice"));
    }
    match tuned(args, source, pipeline, streams) {
        Ok(code) => code,
        Err(e) => failed(&e, streams),
    }
}

fn given_twice(asked: &[AskedQuality]) -> Option<&str> {
    let is_again = |(i, a): &(usize, &AskedQuality)| asked[..*i].iter().any(|b| b.name == a.name);
    asked.iter().enumerate().find(is_again).map(|(_, a)| a.name.as_str())
}

fn tuned(
    args: &TuneArgs,
    source: &Source<'_>,
    pipeline: &Pipeline,
    streams: &mut Streams<'_>,
) -> Result<u8, StageError> {
    let file = target(args)?;
    let (trade, folder) = front(args, source, pipeline, streams)?;
    let (bench, jitter) = (bench(trade.until.clone(), streams), args.study.jitter);
    let (trade, folder) = (&trade, folder.as_path());
    let prover = Prover { source, trade, bench: &bench, folder, starts: args.starts, jitter };
    let proved = with_budget(&args.study, streams, |tell| prove(&prover, &args.qualities, tell))?;
    if !proved.kept.is_empty() {
        write(&file, written(&prover, &proved.kept, &today())?)?;
    }
    match args.json {
        true => streams.say(record(&proved, trade, &file)),
        false => say(&proved, trade, &file, streams),
    }
    Ok(refuse(&proved, trade, streams))
}

fn say(proved: &Proved, trade: &Trade, file: &Path, streams: &mut Streams<'_>) {
    for (asked, proof) in &proved.kept {
        let setting = setting_words(&trade.points[proof.point].setting);
        streams.say(format!("{} ({}): {setting}", asked.name, asked.max_error));
        streams.say(format!(
            "    fresh run: {:.2} s cpu, 95 % of the surface within {:.2} mm",
            proof.fresh.time(Clock::Cpu),
            proof.fresh.errors.distance_mm.p95
        ));
        let starts = proof.starts_in_words(&asked.wish());
        starts.into_iter().for_each(|words| streams.say(format!("    {words}")));
    }
    if !proved.kept.is_empty() {
        streams.say(format!("written: {}", file.display()));
    }
}

/// Says what is not kept, with the front; gives the exit code.
fn refuse(proved: &Proved, trade: &Trade, streams: &mut Streams<'_>) -> u8 {
    if proved.refused.is_empty() {
        return exit::DONE;
    }
    table::lines(trade, true).iter().for_each(|l| streams.tell(l));
    for (asked, e) in &proved.refused {
        streams.tell(format!("error: quality `{}`: {e}", asked.name));
        e.hint.iter().for_each(|hint| streams.tell(format!("  help: {hint}")));
    }
    exit::QUALITY
}

fn record(proved: &Proved, trade: &Trade, file: &Path) -> Value {
    let millimetres = |a: &AskedQuality| a.wish().max_error_mm;
    let kept = |(a, proof): &(AskedQuality, SettingProof)| {
        let (point, fresh) = (&trade.points[proof.point], &proof.fresh);
        json!({
            "name": a.name, "max_error_mm": millimetres(a), "kept_mm": proof.worst_mm(),
            "setting": point.setting, "overrides": point.overrides,
            "wall_s": fresh.time(Clock::Wall), "cpu_s": fresh.time(Clock::Cpu), "errors": fresh.errors,
            "starts_p95_mm": proof.starts.iter().map(|m| m.p95).collect::<Vec<_>>(),
        })
    };
    let refused = |(a, e): &(AskedQuality, StageError)| json!({ "name": a.name, "max_error_mm": millimetres(a), "error": e.to_string(), "hint": e.hint });
    let file = (!proved.kept.is_empty()).then(|| file.display().to_string());
    json!({
        "file": file,
        "qualities": proved.kept.iter().map(kept).collect::<Vec<_>>(),
        "refused": proved.refused.iter().map(refused).collect::<Vec<_>>(),
    })
}

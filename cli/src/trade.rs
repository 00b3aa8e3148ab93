//! `toile trade`: how a pipeline trades accuracy for time.

use crate::args::{Overrides, StudyArgs, TradeArgs};
use crate::progress::with_budget;
use crate::run::{fail_load, fail_run};
use crate::validate::{Refused, inspect, open};
use crate::{Streams, ablate, at_hand, exit, interrupt, stdin};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use toile_core::{Length, Registry, StageError};
use toile_pipeline::{Pipeline, RunOptions, write_files};
use toile_trade::default_knobs::default_knobs;
use toile_trade::knob::KnobSpec;
use toile_trade::measure::Bench;
use toile_trade::record::{Clock, Trade};
use toile_trade::source::Source;
use toile_trade::study::{Options, study};
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
    let asked = Asked {
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
pub(crate) struct Asked<'a> {
    pub(crate) knobs: &'a [String],
    pub(crate) out: PathBuf,
    pub(crate) until: Option<String>,
    pub(crate) points: Option<usize>,
    pub(crate) starts: usize,
    pub(crate) study: &'a StudyArgs,
}

/// Measures and writes; progress goes to standard error.
pub(crate) fn measured(
    asked: &Asked<'_>,
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
    let options = Options {
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

/// The pipeline with its source, checked; faults are shown, as JSON where asked for.
pub(crate) fn opened<'a>(
    path: &Path,
    overrides: &Overrides,
    registry: &'a Registry,
    json: bool,
    streams: &mut Streams<'_>,
) -> Result<(Source<'a>, Pipeline), u8> {
    let opened = open(path, overrides, registry);
    let pipeline = opened.map_err(|faults| fail_load(&faults, json, streams))?;
    let text = stdin::text(path).map_err(|why| {
        streams.tell(format!("error: cannot read the pipeline \"{}\": {why}", stdin::name(path)));
        exit::INVALID
    })?;
    let source = Source {
        text,
        file: stdin::name(path),
        base: stdin::folder(path).to_owned(),
        quality: overrides.quality.clone(),
        set: at_hand::found(&overrides.set),
        registry,
    };
    Ok((source, pipeline))
}

/// Asks the stages that will run what is wrong with their parameters and files: a measurement would tell it of its first run alone.
pub(crate) fn inspected(
    pipeline: &Pipeline,
    until: Option<String>,
    streams: &mut Streams<'_>,
) -> Result<(), u8> {
    inspect(pipeline, &RunOptions { until, ..RunOptions::default() }).map_err(|refused| match refused {
        Refused::Run(e) => fail_run(pipeline, &e, false, streams),
        Refused::File(faults) => fail_load(&faults, false, streams),
    })
}

/// How runs are made.
pub(crate) fn bench(until: Option<String>, streams: &Streams<'_>) -> Bench {
    Bench { until, cancel: interrupt::on_ctrl_c(), listener: Arc::new(()), apart: streams.apart.clone() }
}

/// The clock of the front.
fn clock(study: &StudyArgs) -> Clock {
    if study.clock == "cpu" { Clock::Cpu } else { Clock::Wall }
}

/// Shows an error and gives its exit code.
pub(crate) fn failed(e: &StageError, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {e}"));
    if let Some(hint) = &e.hint {
        streams.tell(format!("  help: {hint}"));
    }
    e.code.exit_code()
}

/// The quality that is asked for.
pub(crate) fn quality(overrides: &Overrides) -> Option<&str> {
    overrides.quality.as_deref()
}

/// Where a measurement of a pipeline lies; each quality, which is another pipeline, has a folder of its own.
pub(crate) fn default_folder(pipeline: &Path, quality: Option<&str>, what: &str) -> PathBuf {
    let stem = stdin::stem(pipeline);
    let quality = quality.map_or_else(String::new, |q| format!("-{q}"));
    PathBuf::from("out").join(format!("{stem}{quality}-{what}"))
}

/// `90s`, `800ms`, `5m`, `1h`.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let fault = || format!("`{text}` is no time; write a number and a unit, like 90s (ms, s, m, h)");
    let text = text.trim();
    let split = text.find(|c: char| c.is_ascii_alphabetic()).ok_or_else(fault)?;
    let (number, unit) = text.split_at(split);
    let seconds = match unit {
        "ms" => 1e-3,
        "s" => 1.0,
        "m" => 60.0,
        "h" => 3600.0,
        _ => return Err(fault()),
    };
    let seconds = number.trim().parse::<f64>().map_err(|_| fault())? * seconds;
    // A week is more than anybody means.
    let is_sound = seconds > 0.0 && seconds < 604_800.0;
    if is_sound { Ok(Duration::from_secs_f64(seconds)) } else { Err(fault()) }
}

/// A length with its unit.
pub(crate) fn length(text: &str) -> Result<Length, String> {
    let length: Length = text.parse()?;
    if length.metres() > 0.0 { Ok(length) } else { Err(format!("`{text}` is not above zero")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_quality_has_a_folder_of_its_own() {
        let folder = |quality| default_folder(Path::new("my/vest.ron"), quality, "trade");
        assert_eq!(folder(None), Path::new("out/vest-trade"));
        assert_eq!(folder(Some("Very fine")), Path::new("out/vest-Very fine-trade"));
    }

    #[test]
    fn times_carry_their_unit() {
        assert_eq!(duration("90s"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("1.5 m"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("800ms"), Ok(Duration::from_millis(800)));
        for wrong in ["5", "-1s", "s", "1d", "1e9h", "NaNs"] {
            let words = format!("`{wrong}` is no time; write a number and a unit, like 90s (ms, s, m, h)");
            assert_eq!(duration(wrong), Err(words));
        }
        assert_eq!(length("0 mm"), Err("`0 mm` is not above zero".into()));
    }
}

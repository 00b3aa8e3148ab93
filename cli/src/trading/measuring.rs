//! What the commands that measure share: the pipeline with its source, how runs are made, where
//! measurements lie.

use crate::args::Overrides;
use crate::failing::{fail_load, fail_run};
use crate::validate::{RefusedPipeline, inspect, open};
use crate::{Streams, at_hand, exit, terminal::interrupt, terminal::stdin};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_core::{Registry, StageError};
use toile_pipeline::{Pipeline, RunOptions};
use toile_trade::knobs::source::Source;
use toile_trade::measure::Bench;

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

/// Asks the stages that will run what is wrong with their parameters and files: a measurement would
/// tell it of its first run alone.
pub(crate) fn inspected(
    pipeline: &Pipeline,
    until: Option<String>,
    streams: &mut Streams<'_>,
) -> Result<(), u8> {
    inspect(pipeline, &RunOptions { until, ..RunOptions::default() }).map_err(|refused| match refused {
        RefusedPipeline::Run(e) => fail_run(pipeline, &e, false, streams),
        RefusedPipeline::File(faults) => fail_load(&faults, false, streams),
    })
}

/// How runs are made.
pub(crate) fn bench(until: Option<String>, streams: &Streams<'_>) -> Bench {
    Bench { until, cancel: interrupt::on_ctrl_c(), listener: Arc::new(()), apart: streams.apart.clone() }
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

/// Where a measurement of a pipeline lies; each quality, which is another pipeline, has a folder of
/// its own.
pub(crate) fn default_folder(pipeline: &Path, quality: Option<&str>, what: &str) -> PathBuf {
    let stem = stdin::stem(pipeline);
    let quality = quality.map_or_else(String::new, |q| format!("-{q}"));
    PathBuf::from("out").join(format!("{stem}{quality}-{what}"))
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
}

//! One writer run by itself: a pattern to print, a model to take along.

use super::ask::{RunAsk, RunKind};
use super::{RunTools, in_threads};
use crate::fault::StudioFault;
use crate::project::outputs::OUT;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_core::artifact::OutputFile;
use toile_core::{Cancel, Listener};
use toile_pipeline::{PipelineEdit, RunOptions, edited, load, run, with_plugins, write_files};

/// Writers that may be asked for.
pub(crate) const PRINTERS: [&str; 5] =
    ["PatternPdf", "PatternSvg", "PatternDxf", "PatternPlt", "PatternJson"];

/// What plotters' files are called, and the stage that writes them.
const PLOTTER: (&str, &str) = ("PatternHpgl", "PatternPlt");

/// Runs a writer after all stages of a text, and writes its files; gives their paths.
///
/// Errors: the writer is none of [`PRINTERS`]; the text with it has faults; the run's.
pub(crate) fn print(ask: &RunAsk, writer: &str, tools: &RunTools) -> Result<Vec<String>, StudioFault> {
    let writer = writer.trim().replacen(PLOTTER.0, PLOTTER.1, 1);
    let name = writer.split('(').next().unwrap_or("").trim();
    if !PRINTERS.contains(&name) {
        let message = format!("`{name}` is no writer of patterns");
        return Err(
            StudioFault::malformed(message).hint(format!("there is {}", toile_core::quoted(&PRINTERS)))
        );
    }
    let registry = with_plugins(&ask.text, &ask.base, &tools.registry);
    let ids = |text: &str| -> Result<Vec<String>, StudioFault> {
        let pipeline = load(text, &ask.file, &ask.base, &registry, &[])?;
        Ok(pipeline.nodes.into_iter().map(|node| node.id).collect())
    };
    let before: BTreeSet<String> = ids(&ask.text)?.into_iter().collect();
    let add = PipelineEdit::Add { stage: writer, after: None };
    let text = edited(&ask.text, &registry, &[add])?;
    let until = ids(&text)?.into_iter().rev().find(|id| !before.contains(id));
    let more = RunAsk { text, ..ask.clone() };
    let pipeline = more.pipeline(&RunKind::Full(None), &tools.registry)?;
    let options = RunOptions { until: until.clone(), cache: tools.cache.clone(), ..RunOptions::default() };
    let listener: Arc<dyn Listener> = Arc::new(());
    let result = in_threads(tools, || run(&pipeline, &options, &Cancel::new(), &listener));
    let result = result.map_err(|e| {
        let fault = StudioFault::new("run", e.to_string());
        StudioFault { hint: e.error.hint, ..fault }
    })?;
    // What the stage is asked for beside its files is no print.
    let kept = format!("stages/{}/", until.unwrap_or_default());
    let files: Vec<OutputFile> = result.files.into_iter().filter(|f| !f.path.starts_with(&kept)).collect();
    write_files(&ask.base.join(OUT), &files).map_err(|e| StudioFault::new("file", e.message))?;
    Ok(files.into_iter().map(|f| f.path).collect())
}

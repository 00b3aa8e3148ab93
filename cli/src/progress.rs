//! The progress line: which stage is at work, how far it is and what it says.

use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Mutex;
use std::sync::PoisonError;
use std::time::Duration;
use toile_core::pipeline::Pipeline;
use toile_core::{Event, Listener};

/// Steps of the bar a stage.
const STEPS: u64 = 100;

/// A bar over all stages, on standard error; silent where that is no terminal.
pub(crate) struct Bar {
    bar: ProgressBar,
    ids: Vec<String>,
    warnings: Mutex<Vec<String>>,
}

impl Bar {
    pub(crate) fn new(pipeline: &Pipeline) -> Self {
        let ids: Vec<String> = pipeline.nodes.iter().map(|n| n.id.clone()).collect();
        let bar = ProgressBar::new(ids.len() as u64 * STEPS);
        if let Ok(style) =
            ProgressStyle::with_template("{spinner} {elapsed:>4} [{bar:28}] {prefix}: {wide_msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Bar { bar, ids, warnings: Mutex::default() }
    }

    /// Takes the bar away and gives the warnings that came.
    pub(crate) fn finish(&self) -> Vec<String> {
        self.bar.finish_and_clear();
        std::mem::take(&mut *self.warnings.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Listener for Bar {
    fn event(&self, stage: &str, entry: &str, event: &Event) {
        let who = if entry.is_empty() { stage.to_owned() } else { format!("{stage} ({entry})") };
        match event {
            Event::Progress { share, text } => {
                let before = self.ids.iter().position(|id| id == stage).unwrap_or(0) as u64;
                self.bar.set_position(before * STEPS + (share * STEPS as f64) as u64);
                self.bar.set_prefix(who);
                self.bar.set_message(text.clone());
            }
            Event::Warning(text) => {
                self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{who}: {text}"));
            }
        }
    }
}

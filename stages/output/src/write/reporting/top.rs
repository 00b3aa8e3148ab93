//! What the report says first: the verdict, and every warning and note with the stage that gave it.

use serde::Serialize;
use toile_core::Remarks;
use toile_core::artifact::{Garment, SeamState};
use toile_core::{RunLog, StageRecord};

/// Whether the result is good, in a word and a sentence.
#[derive(Debug, Serialize, PartialEq, Eq)]
pub(crate) struct ResultVerdict {
    /// `good`, `short` or `failed`: the look of the page.
    pub class: &'static str,
    pub word: String,
    pub sentence: String,
}

/// What a stage told.
#[derive(Debug, Serialize, PartialEq, Eq)]
pub(crate) struct StageRemark {
    pub stage: String,
    pub text: String,
}

/// The verdict on a run that misses so many limits.
pub(crate) fn verdict(run: &RunLog, garment: Option<&Garment>, missed: usize) -> ResultVerdict {
    if let Some(failure) = &run.failure {
        let sentence = format!("The run ended in {}: {}", failure.stage, failure.message);
        return ResultVerdict { class: "failed", word: "Not made".to_owned(), sentence };
    }
    let sentence = garment.map_or_else(String::new, made);
    match missed {
        0 => ResultVerdict { class: "good", word: "Good".to_owned(), sentence },
        1 => ResultVerdict { class: "short", word: "Made, but it misses a limit".to_owned(), sentence },
        n => ResultVerdict { class: "short", word: format!("Made, but it misses {n} limits"), sentence },
    }
}

fn made(garment: &Garment) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let open = garment.seams.iter().filter(|s| s.state == SeamState::Open).count();
    let seams = match open {
        0 => format!("{} closed", count(garment.seams.len(), "seam")),
        _ => format!("{open} of {} open", count(garment.seams.len(), "seam")),
    };
    let rest = if garment.status.converged { "at rest" } else { "not at rest" };
    format!("{}, {seams}, {rest}.", count(garment.panels.len(), "panel"))
}

/// Every warning, in the order of the stages.
pub(crate) fn warnings(run: &RunLog) -> Vec<StageRemark> {
    told(run, |remarks| &remarks.warnings)
}

/// Every note, in the order of the stages.
pub(crate) fn notes(run: &RunLog) -> Vec<StageRemark> {
    told(run, |remarks| &remarks.notes)
}

fn told(run: &RunLog, texts: impl Fn(&Remarks) -> &Vec<String>) -> Vec<StageRemark> {
    let of = |s: &StageRecord| -> Vec<StageRemark> {
        texts(&s.remarks).iter().map(|text| StageRemark { stage: s.id.clone(), text: text.clone() }).collect()
    };
    run.stages.iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_core::Failure;
    use toile_core::testkit::dress;

    #[test]
    fn a_verdict_is_a_word_and_what_was_made() {
        let garment = dress::garment();
        let found = |missed| verdict(&RunLog::default(), Some(&garment), missed);
        assert_eq!((found(0).class, found(0).word.as_str()), ("good", "Good"));
        assert_eq!(found(0).sentence, "2 panels, 4 of 4 seams open, not at rest.");
        assert_eq!(found(2).word, "Made, but it misses 2 limits");
    }

    #[test]
    fn a_run_that_ended_early_says_where_and_why() {
        let failure = Failure {
            stage: "Otsu".into(),
            message: "the picture is one colour".into(),
            hint: None,
            detail: None,
        };
        let run = RunLog { failure: Some(failure), ..RunLog::default() };
        let found = verdict(&run, None, 0);
        assert_eq!(
            (found.class, found.sentence.as_str()),
            ("failed", "The run ended in Otsu: the picture is one colour")
        );
    }
}

//! The decisions of a pipeline as people read them before it runs.

use crate::ablate::path_to;
use crate::saving::{Evidence, Saving};
use toile_pipeline::decide::StageDecision;

/// A decision with the words that need more than itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The decision.
    pub decided: StageDecision,
    /// What it saves.
    pub saving: Saving,
    /// How it is turned round.
    pub turned: String,
}

/// Adds to decisions what they save and how they are turned round.
pub fn told(evidence: &Evidence<'_>, decided: Vec<StageDecision>) -> Vec<Told> {
    let one = |decided: StageDecision| {
        let path = path_to(evidence.source, evidence.pipeline, &decided.stage);
        Told { saving: evidence.saving(&decided), turned: decided.words(&path), decided }
    };
    decided.into_iter().map(one).collect()
}

/// The table that `toile explain` prints.
pub fn lines(told: &[Told]) -> Vec<String> {
    if told.is_empty() {
        return vec!["decisions: nothing is left out or simplified".into()];
    }
    let mut lines = vec![
        "decisions: what is left out or simplified (`toile trade PIPELINE --ablate` measures each)"
            .to_owned(),
    ];
    for t in told {
        let d = &t.decided.decision;
        lines.push(format!("  {:<20} {:<10} {} ({})", t.decided.stage, d.state.as_str(), d.what, d.rule));
        for (head, words) in [
            ("by", d.fact.clone()),
            ("within", d.tolerance.to_string()),
            ("saves", t.saving.words()),
            ("else", t.turned.clone()),
            ("source", d.source.clone()),
        ] {
            lines.push(format!("      {head:<7} {words}"));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Clock;
    use crate::saving::SavingBasis;
    use toile_core::decide::{Decision, Saves, State, Tolerance, Turn};

    #[test]
    fn the_table_word_for_word() {
        let decision = Decision {
            rule: "few-pixels".into(),
            state: State::Simplified,
            what: "photos: fewer pixels".into(),
            fact: "large photos".into(),
            tolerance: Tolerance::Outline(1e-3),
            saves: Saves::Modelled,
            source: "Nyquist 1928".into(),
            turn: Turn::Also,
        };
        let decided = StageDecision { stage: "Mean".into(), decision };
        let saving = Saving {
            basis: SavingBasis::Modelled,
            seconds: Some(2.0),
            clock: Clock::Wall,
            noise_s: None,
            share: None,
            date: None,
        };
        let told = Told { turned: decided.words(""), saving, decided };
        let words = "\
decisions: what is left out or simplified (`toile trade PIPELINE --ablate` measures each)
  Mean                 simplified photos: fewer pixels (few-pixels)
      by      large photos
      within  outline 1 mm
      saves   about 2.0 s of an expected run
      else    --also Mean
      source  Nyquist 1928";
        assert_eq!(lines(&[told]).join("\n"), words);
        assert_eq!(lines(&[]), ["decisions: nothing is left out or simplified"]);
    }
}

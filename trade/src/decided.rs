//! The decisions of a pipeline as people read them before it runs.

use crate::ablate::path_to;
use crate::cost::{Costs, predict, total};
use crate::slot::Source;
use toile_core::cost::Predicted;
use toile_core::decide::{Decided, Saves, Turn};
use toile_core::pipeline::{Override, Pipeline};

/// A decision with the words that need more than itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The decision.
    pub decided: Decided,
    /// What it saves.
    pub saves: String,
    /// How it is turned round.
    pub turned: String,
}

/// Adds to decisions what they are expected to save and how they are turned round.
pub fn told(source: &Source<'_>, pipeline: &Pipeline, decided: Vec<Decided>, costs: &Costs) -> Vec<Told> {
    let one = |decided: Decided| {
        let path = path_to(source, pipeline, &decided.stage);
        let saves = saves(source, pipeline, &decided, &path, costs);
        Told { saves, turned: decided.words(&path), decided }
    };
    decided.into_iter().map(one).collect()
}

fn saves(source: &Source<'_>, pipeline: &Pipeline, decided: &Decided, path: &str, costs: &Costs) -> String {
    if let Saves::Share(share) = decided.decision.saves {
        return format!("{:.0} % of what the stage takes without it, as measured", share * 100.0);
    }
    let seconds = match &decided.decision.turn {
        Turn::Also => seconds_of(pipeline, costs, |stage| stage == decided.stage),
        Turn::Param { name, value } => {
            let turned = Override { path: format!("{path}.{name}"), value: value.clone() };
            let without = source.load(&[turned]).ok();
            let without = without.and_then(|p| seconds_of(&p, costs, |_| true));
            without.zip(seconds_of(pipeline, costs, |_| true)).map(|(without, with)| without - with)
        }
    };
    match seconds {
        Some(s) if s >= 1e-3 => format!("about {} of an expected run", crate::cost::time(s)),
        Some(_) => "nothing that could be expected".into(),
        None => "not known".into(),
    }
}

/// The expected wall time of some stages together, seconds.
fn seconds_of(pipeline: &Pipeline, costs: &Costs, of: impl Fn(&str) -> bool) -> Option<f64> {
    let forecasts = predict(pipeline, costs);
    let own: Vec<&Predicted> = forecasts.iter().filter(|f| of(&f.stage)).map(|f| &f.predicted).collect();
    total(&own).wall_s.map(|e| e.value)
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
            ("saves", t.saves.clone()),
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
    use toile_core::decide::{Decision, State, Tolerance};

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
        let decided = Decided { stage: "Mean".into(), decision };
        let told = Told { turned: decided.words(""), saves: "about 2 s".into(), decided };
        let words = "\
decisions: what is left out or simplified (`toile trade PIPELINE --ablate` measures each)
  Mean                 simplified photos: fewer pixels (few-pixels)
      by      large photos
      within  outline 1 mm
      saves   about 2 s
      else    --also Mean
      source  Nyquist 1928";
        assert_eq!(lines(&[told]).join("\n"), words);
        assert_eq!(lines(&[]), ["decisions: nothing is left out or simplified"]);
    }
}

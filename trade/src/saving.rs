//! What a decision saves: as it was measured, by the cost model, or by an estimate that its rule
//! carries; and which of these.

use crate::ablate::{Ablation, DecisionRow, path_to};
use crate::cost::{Costs, predict, time, total};
use crate::knobs::source::Source;
use crate::record::Clock;
use serde::Serialize;
use toile_core::cost::Predicted;
use toile_core::decide::{Saves, Turn};
use toile_pipeline::decide::StageDecision;
use toile_pipeline::{Override, Pipeline};

/// What a figure rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SavingBasis {
    /// Runs of this very pipeline with the decision turned round (`toile trade --ablate`).
    Measured,
    /// The cost model, for the pipeline with the decision and without it.
    Modelled,
    /// A share that the rule carries from the shipped pipelines, of what the cost model expects.
    Estimated,
    /// Nothing.
    Unknown,
}

/// What a decision saves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Saving {
    /// What the figures rest on.
    pub basis: SavingBasis,
    /// Seconds; none where they are not known.
    pub seconds: Option<f64>,
    /// Which clock the seconds are by.
    pub clock: Clock,
    /// Twice the standard error of measured seconds; none for a single round.
    pub noise_s: Option<f64>,
    /// Share of the stage's time as it would be without the decision, where that is what is
    /// estimated.
    pub share: Option<f64>,
    /// Day of the measurement.
    pub date: Option<String>,
}

impl Saving {
    fn by(basis: SavingBasis, seconds: Option<f64>) -> Self {
        Saving { basis, seconds, clock: Clock::Wall, noise_s: None, share: None, date: None }
    }

    /// In words: `about 0.2 s of an expected run`.
    pub fn words(&self) -> String {
        let about = |s: f64| format!("about {} of an expected run", time(s));
        match (self.basis, self.seconds) {
            (SavingBasis::Measured, seconds) => self.measured(seconds.unwrap_or(0.0)),
            (SavingBasis::Estimated, seconds) => {
                let share = self.share.map_or_else(String::new, |s| {
                    format!(": {:.0} % of what the stage takes without it", s * 100.0)
                });
                let seconds = seconds.filter(|s| *s >= 1e-3);
                format!("estimated{share}{}", seconds.map_or_else(String::new, |s| format!(", {}", about(s))))
            }
            (SavingBasis::Modelled, Some(s)) if s >= 1e-3 => about(s),
            (SavingBasis::Modelled, _) => "nothing that could be expected".into(),
            (SavingBasis::Unknown, _) => "not known".into(),
        }
    }

    fn measured(&self, seconds: f64) -> String {
        let when = self.date.as_deref().map_or_else(String::new, |d| format!(" on {d}"));
        let noise = self.noise_s.map_or_else(|| " in one round".to_owned(), |n| format!(" (+- {n:.2} s)"));
        match self.noise_s.is_none_or(|n| seconds > n) {
            true => format!("{seconds:.2} s of processor time{noise}, measured{when}"),
            false => format!("nothing that could be measured{when}: {seconds:.2} s of processor time{noise}"),
        }
    }
}

/// What is known of a pipeline's savings.
pub struct Evidence<'a> {
    /// The pipeline's file.
    pub source: &'a Source<'a>,
    /// It, loaded.
    pub pipeline: &'a Pipeline,
    /// The cost model.
    pub costs: &'a Costs,
    /// An ablation of this very pipeline.
    pub ablation: Option<&'a Ablation>,
}

impl Evidence<'_> {
    /// What a decision saves, by the best that is known.
    pub fn saving(&self, decided: &StageDecision) -> Saving {
        self.measured(decided).unwrap_or_else(|| match decided.decision.saves {
            Saves::Share(share) => self.estimated(decided, share),
            Saves::Modelled => {
                let seconds = self.modelled(decided);
                Saving::by(
                    if seconds.is_some() { SavingBasis::Modelled } else { SavingBasis::Unknown },
                    seconds,
                )
            }
        })
    }

    fn measured(&self, decided: &StageDecision) -> Option<Saving> {
        let ablation = self.ablation?;
        let is_it = |r: &&DecisionRow| {
            r.decided.stage == decided.stage && r.decided.decision.rule == decided.decision.rule
        };
        let row = ablation.rows.iter().find(is_it).filter(|r| r.failed.is_none())?;
        let saved = row.saved()?;
        Some(Saving {
            clock: Clock::Cpu,
            noise_s: Some(saved.noise).filter(|n| n.is_finite()),
            date: Some(ablation.date.clone()),
            ..Saving::by(SavingBasis::Measured, Some(saved.mean))
        })
    }

    /// The stage is expected to take what is left of it by the share.
    fn estimated(&self, decided: &StageDecision, share: f64) -> Saving {
        let left = self.seconds(self.pipeline, |stage| stage == decided.stage);
        let seconds = left.map(|s| s * share / (1.0 - share)).filter(|s| s.is_finite());
        Saving { share: Some(share), ..Saving::by(SavingBasis::Estimated, seconds) }
    }

    fn modelled(&self, decided: &StageDecision) -> Option<f64> {
        match &decided.decision.turn {
            Turn::Also => self.seconds(self.pipeline, |stage| stage == decided.stage),
            Turn::Param { name, value } => {
                let path = path_to(self.source, self.pipeline, &decided.stage);
                let turned = Override { path: format!("{path}.{name}"), value: value.clone() };
                let without = self.seconds(&self.source.load(&[turned]).ok()?, |_| true)?;
                Some(without - self.seconds(self.pipeline, |_| true)?)
            }
        }
    }

    /// The expected wall time of some stages together, seconds.
    fn seconds(&self, pipeline: &Pipeline, of: impl Fn(&str) -> bool) -> Option<f64> {
        let forecasts = predict(pipeline, self.costs);
        let own: Vec<&Predicted> = forecasts.iter().filter(|f| of(&f.stage)).map(|f| &f.predicted).collect();
        total(&own).wall_s.map(|e| e.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn saving(basis: SavingBasis, seconds: Option<f64>) -> Saving {
        Saving::by(basis, seconds)
    }

    #[test]
    fn words_say_what_a_figure_rests_on() {
        let measured = |seconds: f64, noise_s: Option<f64>| Saving {
            noise_s,
            date: Some("2026-11-22".into()),
            ..saving(SavingBasis::Measured, Some(seconds))
        };
        let words = [
            (measured(0.368, Some(0.095)), "0.37 s of processor time (+- 0.10 s), measured on 2026-11-22"),
            (measured(0.2, None), "0.20 s of processor time in one round, measured on 2026-11-22"),
            (
                measured(0.02, Some(0.05)),
                "nothing that could be measured on 2026-11-22: 0.02 s of processor time (+- 0.05 s)",
            ),
            (saving(SavingBasis::Modelled, Some(0.5)), "about 500 ms of an expected run"),
            (saving(SavingBasis::Modelled, Some(-0.5)), "nothing that could be expected"),
            (
                Saving { share: Some(0.4), ..saving(SavingBasis::Estimated, Some(0.12)) },
                "estimated: 40 % of what the stage takes without it, about 120 ms of an expected run",
            ),
            (
                Saving { share: Some(0.4), ..saving(SavingBasis::Estimated, None) },
                "estimated: 40 % of what the stage takes without it",
            ),
            (saving(SavingBasis::Unknown, None), "not known"),
        ];
        for (saving, expected) in words {
            assert_eq!(saving.words(), expected);
        }
    }
}

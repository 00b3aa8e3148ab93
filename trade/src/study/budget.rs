//! Whether a budget is long enough to say anything, and the least that is.
//!
//! A setting may take a tenth of the budget, so a budget of less than ten runs of the pipeline as
//! it is stops every setting. The reference is refined once at least, which takes some three times
//! as long as the pipeline as it is: without that, errors mean nothing.

use super::{LIMIT_SHARE, REFERENCE_SHARE};
use crate::cost::time;
use std::time::Duration;
use toile_core::{ErrorCode, StageError};

/// Time of a level in times of the level before it, where only one is known.
pub(crate) const GROWTH: f64 = 3.0;

/// What a run may take beyond what it took, since no two runs take equally long.
const SPARE: f64 = 1.25;

/// What the user allows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Allowed {
    /// For everything.
    pub(crate) budget: Duration,
    /// For a run of a setting; none where it is a share of the budget.
    pub(crate) limit: Option<Duration>,
}

impl Allowed {
    /// Longest run of a setting.
    pub(super) fn limit(&self) -> Duration {
        self.limit.unwrap_or_else(|| self.budget.mul_f64(LIMIT_SHARE))
    }

    /// Whether a pipeline that takes so many seconds as it is can be measured.
    ///
    /// Errors: every setting would be stopped.
    pub(crate) fn holds(&self, own_s: f64) -> Result<(), StageError> {
        let limit = self.limit();
        if limit.as_secs_f64() >= own_s {
            return Ok(());
        }
        // Whether a run that is longer than the budget is stopped or still ends is up to the
        // machine; the words are the same.
        if self.limit.is_none() && own_s > self.budget.as_secs_f64() {
            return Err(self.ended_first());
        }
        let takes = format!("the pipeline as it is takes {}: every setting would be stopped", time(own_s));
        Err(match self.limit {
            Some(_) => refused(
                format!("a run may take {}, and {takes}", seconds(limit)),
                format!("give `--limit {}` or more", rounded_up(own_s * SPARE)),
            ),
            None => refused(
                format!(
                    "a budget of {} leaves {} for a run, and {takes}",
                    seconds(self.budget),
                    seconds(limit)
                ),
                format!("give `--budget {}` or more", rounded_up(least(own_s))),
            ),
        })
    }

    /// The pipeline as it is takes longer than the whole budget.
    pub(crate) fn ended_first(&self) -> StageError {
        refused(
            format!(
                "a run of the pipeline as it is takes longer than the whole budget of {}",
                seconds(self.budget)
            ),
            format!("give `--budget {}` or more", rounded_up(least(self.budget.as_secs_f64()))),
        )
    }

    /// The reference of a pipeline that takes so many seconds as it is could not be refined once.
    pub(crate) fn unrefined(&self, own_s: f64) -> StageError {
        let more = least(own_s).max(2.0 * self.budget.as_secs_f64());
        refused(
            format!(
                "the reference could not be refined in its share of a budget of {}, so that errors would mean nothing",
                seconds(self.budget)
            ),
            format!("give `--budget {}` or more", rounded_up(more)),
        )
    }

    /// The pipeline as it is, a setting like the others, was stopped or not come to.
    pub(super) fn nothing_measured(&self) -> StageError {
        let hint = match self.limit {
            Some(limit) => format!("give `--limit {}` or more", rounded_up(2.0 * limit.as_secs_f64())),
            None => format!("give `--budget {}` or more", rounded_up(2.0 * self.budget.as_secs_f64())),
        };
        let words = format!(
            "the pipeline as it is was not done within the limit of {} for a run, so that nothing was measured",
            seconds(self.limit())
        );
        refused(words, hint)
    }
}

/// The least budget for a pipeline that takes so many seconds as it is.
fn least(own_s: f64) -> f64 {
    (SPARE * own_s / LIMIT_SHARE).max((1.0 + GROWTH) * own_s / REFERENCE_SHARE[0])
}

fn refused(message: String, hint: String) -> StageError {
    StageError::new(ErrorCode::Timeout, message).hint(hint)
}

/// A time as the user may have given it.
fn seconds(t: Duration) -> String {
    match t.as_millis() {
        ms if ms >= 1000 && ms.is_multiple_of(1000) => format!("{} s", ms / 1000),
        _ => time(t.as_secs_f64()),
    }
}

/// A time as the command line takes it, rounded up: `9s`, `90s`, `3m`.
fn rounded_up(seconds: f64) -> String {
    match seconds {
        s if s <= 10.0 => format!("{}s", s.ceil().max(1.0)),
        s if s <= 120.0 => format!("{}s", (s / 10.0).ceil() * 10.0),
        s => format!("{}m", (s / 60.0).ceil()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn allowed(budget: u64, limit: Option<u64>) -> Allowed {
        Allowed { budget: Duration::from_secs(budget), limit: limit.map(Duration::from_secs) }
    }

    fn words(e: StageError) -> (String, String) {
        assert_eq!(e.code.exit_code(), 5);
        (e.message, e.hint.unwrap())
    }

    #[test]
    fn a_budget_that_would_stop_every_setting_is_refused_with_the_least_that_does_not() {
        assert!(allowed(300, None).holds(7.1).is_ok());
        assert_eq!(
            words(allowed(30, None).holds(7.1).unwrap_err()),
            (
                "a budget of 30 s leaves 3 s for a run, and the pipeline as it is takes 7.1 s: every setting would be stopped"
                    .into(),
                "give `--budget 90s` or more".into()
            )
        );
        // What is proposed is taken.
        assert!(allowed(90, None).holds(7.1).is_ok());
        assert_eq!(
            words(allowed(300, Some(5)).holds(7.1).unwrap_err()),
            (
                "a run may take 5 s, and the pipeline as it is takes 7.1 s: every setting would be stopped"
                    .into(),
                "give `--limit 9s` or more".into()
            )
        );
    }

    #[test]
    fn what_was_cut_short_says_how_much_longer_it_needs() {
        assert_eq!(
            words(allowed(30, None).ended_first()),
            (
                "a run of the pipeline as it is takes longer than the whole budget of 30 s".into(),
                "give `--budget 7m` or more".into()
            )
        );
        assert_eq!(
            words(allowed(100, None).unrefined(7.1)),
            (
                "the reference could not be refined in its share of a budget of 100 s, so that errors would mean nothing".into(),
                "give `--budget 4m` or more".into()
            )
        );
        assert_eq!(
            words(allowed(100, None).nothing_measured()),
            (
                "the pipeline as it is was not done within the limit of 10 s for a run, so that nothing was measured".into(),
                "give `--budget 4m` or more".into()
            )
        );
    }

    #[test]
    fn times_are_rounded_up_as_the_command_line_takes_them() {
        let all = [0.2, 8.9, 10.0, 88.75, 120.0, 121.0].map(rounded_up);
        assert_eq!(all, ["1s", "9s", "10s", "90s", "120s", "3m"]);
    }
}

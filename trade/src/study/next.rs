//! Which setting is measured next.

use super::Study;
use crate::front::Cost;
use crate::knobs::slot::{Knob, Setting};
use crate::record::{Clock, SettingOutcome, front_of};
use crate::reference::sample::{candidates, halton};
use crate::study::ladder::FINER;

/// Space-filling settings a knob, before the front is refined.
const START: usize = 4;
/// Every so many-th setting after the start is space-filling again, so that nothing is left out for
/// good.
const LOOK_AROUND: usize = 5;
/// Settings without result after which a choice of stage is given up.
const HOPELESS: usize = 2;
/// Settings nearer than this to a measured one with the same choices, as a share of the knobs'
/// ranges, tell nothing new.
const LEAST_STEP: f64 = 0.03;
/// Proposals that are looked at before there is said to be nothing new.
const PROPOSALS: usize = 4000;

impl Study<'_> {
    /// The next setting to measure; none where nothing new is left that fits into the budget.
    pub(super) fn next(&self) -> Option<Setting> {
        let n = self.store.lines.len();
        if n == 0 {
            return Some(self.board.own());
        }
        let dimensions = self.board.knobs.len();
        let around = n <= START * dimensions || n.is_multiple_of(LOOK_AROUND);
        let spread = (0..PROPOSALS).map(|i| halton(i, dimensions));
        let near = candidates(&self.front_places(), &self.discrete()).into_iter();
        let proposals: Box<dyn Iterator<Item = Vec<f64>>> =
            if around { Box::new(spread.chain(near)) } else { Box::new(near.chain(spread)) };
        proposals.map(|place| self.board.setting(&place)).find(|s| self.is_worth(s))
    }

    fn front_places(&self) -> Vec<(Vec<f64>, Cost)> {
        let clock = self.options.clock;
        let place = |i: usize| {
            let point = &self.store.lines[i];
            Some((self.board.place(&point.setting), point.measured()?.cost(clock)))
        };
        front_of(&self.store.lines, clock).into_iter().filter_map(place).collect()
    }

    fn discrete(&self) -> Vec<bool> {
        self.board.knobs.iter().map(|k| k.dial.is_discrete()).collect()
    }

    /// New, coarser than the reference, not of a hopeless choice, and likely to be done in time.
    fn is_worth(&self, setting: &Setting) -> bool {
        let is_known =
            self.store.lines.iter().any(|p| p.setting == *setting || self.is_beside(setting, &p.setting));
        let finest = self.found.reference.levels.last().map(|l| &l.setting);
        let too_fine = finest.is_some_and(|f| self.board.is_too_fine(setting, f, FINER));
        !is_known
            && !too_fine
            && !self.is_hopeless(setting)
            && self.expected(setting) <= self.left().as_secs_f64()
    }

    /// True where two settings differ in no choice and hardly in numbers.
    fn is_beside(&self, a: &Setting, b: &Setting) -> bool {
        let is_near = |k: &Knob| match (a.get(&k.key), b.get(&k.key)) {
            (Some(x), Some(y)) => k.dial.is_near(x, y, LEAST_STEP),
            (x, y) => x == y,
        };
        self.board.knobs.iter().all(is_near)
    }

    fn is_hopeless(&self, setting: &Setting) -> bool {
        let choices = self.board.knobs.iter().filter(|k| k.param.is_none());
        choices.filter_map(|k| Some((&k.key, setting.get(&k.key)?))).any(|(key, stage)| {
            let mut tried = self.store.lines.iter().filter(|p| p.setting.get(key) == Some(stage)).peekable();
            let count = tried.clone().count();
            tried.peek().is_some() && count >= HOPELESS && tried.all(|p| p.measured().is_none())
        })
    }

    /// Seconds that all runs of a setting may take, by its nearest neighbour with the same choices.
    fn expected(&self, setting: &Setting) -> f64 {
        let (at, discrete) = (self.board.place(setting), self.discrete());
        let near = self.store.lines.iter().filter_map(|p| {
            let there = self.board.place(&p.setting);
            let far = (0..at.len()).map(|k| (at[k] - there[k]).abs() * if discrete[k] { 100.0 } else { 1.0 });
            let seconds = match &p.outcome {
                SettingOutcome::Measured(m) => m.time(Clock::Wall) * self.options.repeats as f64,
                SettingOutcome::OverLimit { seconds } => *seconds,
                SettingOutcome::Failed { .. } => return None,
            };
            Some((far.sum::<f64>(), seconds))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, seconds)| seconds)
    }
}

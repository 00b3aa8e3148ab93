//! Settings as places of the unit cube, one coordinate a knob.

use super::{Knob, KnobBoard, Setting};
use crate::knobs::dial::Dial;
use crate::knobs::split::field;

impl KnobBoard {
    /// The setting at a point of the unit cube, one coordinate a knob.
    pub fn setting(&self, at: &[f64]) -> Setting {
        let value = |i: usize| at.get(i).copied().unwrap_or(0.5).clamp(0.0, 1.0);
        let picked: Vec<(usize, String)> =
            self.knobs.iter().enumerate().map(|(i, k)| (i, k.dial.at(value(i)))).collect();
        let stage = |slot: usize| {
            let of_slot = |(i, _): &&(usize, String)| {
                self.knobs[*i].slot == slot && matches!(self.knobs[*i].dial, Dial::Stage(_))
            };
            picked.iter().find(of_slot).map_or(self.slots[slot].own.name, |(_, name)| name)
        };
        let acts = |(i, _): &&(usize, String)| self.acts(&self.knobs[*i], stage(self.knobs[*i].slot));
        picked.iter().filter(acts).map(|(i, v)| (self.knobs[*i].key.clone(), v.clone())).collect()
    }

    /// Whether a knob acts on the stage of that name in its slot.
    fn acts(&self, knob: &Knob, stage: &str) -> bool {
        let Some(param) = &knob.param else { return true };
        let card = self.card(self.slots[knob.slot].own.role, stage);
        knob.only.as_ref().is_none_or(|only| only == stage)
            && card.is_some_and(|c| c.params.iter().any(|p| p.name == param))
    }

    /// What the pipeline's own file says, as a setting.
    pub fn own(&self) -> Setting {
        let own = |k: &Knob| {
            let slot = &self.slots[k.slot];
            let value = match &k.param {
                None => slot.own.name.to_owned(),
                Some(param) => field(&slot.params, param)?.to_owned(),
            };
            self.acts(k, slot.own.name).then(|| (k.key.clone(), value))
        };
        self.knobs.iter().filter_map(own).collect()
    }

    /// The place of a setting in the unit cube; knobs that do not act are at their middle.
    pub fn place(&self, setting: &Setting) -> Vec<f64> {
        self.knobs.iter().map(|k| setting.get(&k.key).and_then(|v| k.dial.place(v)).unwrap_or(0.5)).collect()
    }
}

//! Settings as overrides of the pipeline file.

use super::{KnobBoard, KnobSlot, Setting};
use std::collections::BTreeMap;
use toile_core::ParamDoc;
use toile_pipeline::Override;

impl KnobBoard {
    /// The overrides that make a setting, in the order in which they are applied.
    pub fn overrides(&self, setting: &Setting) -> Vec<Override> {
        (0..self.slots.len()).flat_map(|slot| self.slot_overrides(slot, setting)).collect()
    }

    fn slot_overrides(&self, index: usize, setting: &Setting) -> Vec<Override> {
        let slot = &self.slots[index];
        let knobs = || self.knobs.iter().filter(|k| k.slot == index);
        let chosen = knobs().find(|k| k.param.is_none()).and_then(|k| setting.get(&k.key));
        let turned: Vec<(&String, &String)> =
            knobs().filter_map(|k| Some((k.param.as_ref()?, setting.get(&k.key)?))).collect();
        match chosen.filter(|name| **name != slot.own.name) {
            None => turned
                .iter()
                .map(|(param, value)| Override {
                    path: format!("{}.{param}", slot.path),
                    value: (*value).clone(),
                })
                .collect(),
            Some(name) => {
                let mut params = self.carried(slot, name);
                params.extend(turned.iter().map(|(p, v)| ((*p).clone(), (*v).clone())));
                let params: Vec<String> = params.iter().map(|(p, v)| format!("{p}: {v}")).collect();
                vec![Override { path: slot.path.clone(), value: format!("{name}({})", params.join(", ")) }]
            }
        }
    }

    /// What the file gives of the slot's own stage that a stage in its place takes as well.
    fn carried(&self, slot: &KnobSlot, name: &str) -> BTreeMap<String, String> {
        let Some(card) = self.card(slot.own.role, name) else { return BTreeMap::new() };
        let same = |p: &ParamDoc| slot.own.params.iter().any(|q| q.name == p.name && q.kind == p.kind);
        let takes = |name: &str, text: &str| {
            card.params.iter().any(|p| p.name == name && same(p) && p.check.run(text, p).is_ok())
        };
        slot.given
            .iter()
            .filter(|(name, text)| takes(name, text))
            .map(|(n, t)| (n.clone(), t.clone()))
            .collect()
    }
}

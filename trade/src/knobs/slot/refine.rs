//! Which knobs are resolutions, and settings in which these are finer.

use super::{Knob, KnobBoard, Setting};
use crate::knobs::dial::{NumberForm, is_finer, is_spatial, numeric, rounded, way};
use toile_core::ParamDoc;

impl KnobBoard {
    /// The reference's setting, the pipeline's own where it was given none, with every resolution
    /// refined by a factor, as far as its parameters go.
    pub fn refined(&self, factor: f64) -> Setting {
        let mut setting = self.unrefined();
        for knob in &self.knobs {
            let Some((way, doc)) = self.resolution(knob) else { continue };
            let Some(own) = setting.get(&knob.key).and_then(|v| numeric(v)) else { continue };
            let finer =
                (own / factor.powf(way)).clamp(doc.min.unwrap_or(f64::MIN), doc.max.unwrap_or(f64::MAX));
            if let (Some(form), true) = (NumberForm::of(doc), finer != own) {
                setting.insert(knob.key.clone(), form.write(rounded(finer)));
            }
        }
        setting
    }

    /// True where every resolution of a setting is finer by a factor than all that its knob may be
    /// set to.
    pub fn is_finer(&self, setting: &Setting, factor: f64) -> bool {
        self.resolutions(setting).all(|(way, finest, value)| is_finer(way, value, finest, factor))
    }

    /// True where a setting has a resolution that is not coarser by a factor than the reference's.
    pub fn is_too_fine(&self, setting: &Setting, reference: &Setting, factor: f64) -> bool {
        let pair = |k: &Knob| {
            let (way, _) = self.resolution(k)?;
            let (own, other) = (numeric(setting.get(&k.key)?)?, numeric(reference.get(&k.key)?)?);
            Some(!is_finer(way, other, own, factor))
        };
        self.knobs.iter().filter(|k| self.is_spatial(k)).filter_map(pair).any(|too_fine| too_fine)
    }

    /// By which factor a setting is finer than another: by the resolution in space that is refined
    /// the least of those that are, or by any where none is; 1 where nothing is finer.
    pub fn ratio(&self, fine: &Setting, coarse: &Setting) -> f64 {
        let finer = |k: &Knob| {
            let (way, _) = self.resolution(k)?;
            let (own, other) = (numeric(fine.get(&k.key)?)?, numeric(coarse.get(&k.key)?)?);
            Some((other / own).powf(way)).filter(|r| *r > 1.0 && r.is_finite())
        };
        let least = |knobs: &mut dyn Iterator<Item = &Knob>| knobs.filter_map(finer).reduce(f64::min);
        let spatial = least(&mut self.knobs.iter().filter(|k| self.is_spatial(k)));
        spatial.or_else(|| least(&mut self.knobs.iter())).unwrap_or(1.0)
    }

    /// True where two settings differ in a resolution in space, or there is none to differ in.
    pub fn differ_in_space(&self, a: &Setting, b: &Setting) -> bool {
        let mut spatial = self.knobs.iter().filter(|k| self.is_spatial(k)).peekable();
        spatial.peek().is_none() || spatial.any(|k| a.get(&k.key) != b.get(&k.key))
    }

    /// Direction, finest value of the dial and value in a setting, of every knob that is a
    /// resolution in space.
    fn resolutions<'b>(&'b self, setting: &'b Setting) -> impl Iterator<Item = (f64, f64, f64)> + 'b {
        self.knobs.iter().filter(|k| self.is_spatial(k)).filter_map(|k| {
            let (way, _) = self.resolution(k)?;
            Some((way, k.dial.finest(way)?, numeric(setting.get(&k.key)?)?))
        })
    }

    /// Which way a knob is refined, with its parameter; none where it is no resolution of the
    /// pipeline's own stage.
    fn resolution(&self, knob: &Knob) -> Option<(f64, &ParamDoc)> {
        let param = knob.param.as_deref()?;
        let doc = self.slots[knob.slot].own.params.iter().find(|p| p.name == param)?;
        Some((way(doc)?, doc))
    }

    fn is_spatial(&self, knob: &Knob) -> bool {
        self.resolution(knob).is_some_and(|(_, doc)| is_spatial(doc))
    }
}

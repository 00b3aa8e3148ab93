//! Values that the reference has in place of the pipeline's own.
//!
//! What a pipeline does by default is not always what its garment converges with: where a switch
//! that is off by default makes the garment forget where it began, the reference needs it on, and
//! settings without it are judged against that.

use super::{KnobBoard, Setting};
use crate::knobs::dial::dial;
use crate::knobs::knob::{Values, fault};
use std::str::FromStr;
use toile_core::StageError;

/// The reference's value of a knob: `StaticEquilibrium.bending_continuation=true`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReferenceValue {
    /// The knob's key.
    pub key: String,
    /// Its value, as in a pipeline file; a length's quotes may be missing.
    pub value: String,
}

impl FromStr for ReferenceValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        match parts.filter(|(key, value)| !key.is_empty() && !value.is_empty()) {
            Some((key, value)) => Ok(ReferenceValue { key: key.to_owned(), value: value.to_owned() }),
            None => Err("write KEY=VALUE, like `StaticEquilibrium.bending_continuation=true`".to_owned()),
        }
    }
}

impl KnobBoard {
    /// Gives the reference these values; it is refined from there.
    ///
    /// Errors: no such knob, the choice of a stage, a value that the parameter does not take.
    pub fn with_reference(mut self, values: &[ReferenceValue]) -> Result<KnobBoard, StageError> {
        for given in values {
            let value = self.checked(given)?;
            self.reference.insert(given.key.clone(), value);
        }
        Ok(self)
    }

    fn checked(&self, given: &ReferenceValue) -> Result<String, StageError> {
        let key = &given.key;
        let refuse = |why: &str, hint: String| fault(format!("--reference `{key}`: {why}")).hint(hint);
        let Some(knob) = self.knobs.iter().find(|k| k.key == *key) else {
            let hint = format!("add `--knob \"{key}=...\"`, or give it by --set");
            return Err(refuse("there is no such knob", hint));
        };
        let doc = |param: &String| {
            let cards = self.cards_in(knob.slot).into_iter();
            let mut docs =
                cards.filter(|c| knob.only.as_ref().is_none_or(|o| o == c.name)).flat_map(|c| &c.params);
            docs.find(|d| d.name == param)
        };
        let Some(doc) = knob.param.as_ref().and_then(doc) else {
            let hint = "name a parameter, like `StaticEquilibrium.bending_continuation=true`";
            return Err(refuse("the reference keeps the pipeline's own stages", hint.to_owned()));
        };
        let one = dial(key, doc, &Values::List(vec![given.value.clone()]))?;
        Ok(one.at(0.0))
    }

    /// What the reference is refined from: its own values, else the pipeline's.
    pub(super) fn unrefined(&self) -> Setting {
        let mut setting = self.own();
        setting.extend(self.reference.clone());
        setting
    }
}

//! `--knob KEY=VALUES`: what may be turned, as the user writes it.
//!
//! A key names a stage of the pipeline or a role (`mesher`, `collider`, `solver` for the draper),
//! alone for the choice of the stage itself, or with a parameter. Values are a range with a unit,
//! or a list:
//!
//! ```text
//! mesher.edge=6..24 mm        GridMesher.edge=6 mm..2.4 cm      StaticEquilibrium.speed=1e-4..1e-2
//! BvhCollider.volume=Aabb,Obb,KDop(14)      solver=StaticEquilibrium,Xpbd      mesher.edge=8 mm,12 mm
//! ```
//!
//! This file reads the text alone; `slot` holds it against a pipeline.

use crate::knobs::split::at_commas;
use std::str::FromStr;
use toile_core::{ErrorCode, Length, StageError};

/// A knob as written.
#[derive(Debug, Clone, PartialEq)]
pub struct KnobSpec {
    /// Stage or role.
    pub owner: String,
    /// The parameter; none for the choice of the stage.
    pub param: Option<String>,
    /// What it may be.
    pub values: Values,
}

/// What a knob may be set to.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers between two, both included.
    Range(Number, Number),
    /// These texts.
    List(Vec<String>),
}

/// A number or a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    /// A bare number.
    Plain(f64),
    /// Metres.
    Length(f64),
}

impl Number {
    /// Its value, a length's in metres.
    pub fn value(self) -> f64 {
        match self {
            Number::Plain(x) | Number::Length(x) => x,
        }
    }
}

/// A fault of a knob.
pub(crate) fn fault(message: impl Into<String>) -> StageError {
    StageError::new(ErrorCode::InvalidParameter, message)
}

impl FromStr for KnobSpec {
    type Err = StageError;

    fn from_str(text: &str) -> Result<Self, StageError> {
        let no_knob = || {
            fault(format!("`{text}` is no knob"))
                .hint("write KEY=VALUES, like `mesher.edge=6..24 mm` or `solver=StaticEquilibrium,Xpbd`")
        };
        let (key, values) = text.split_once('=').ok_or_else(no_knob)?;
        let (owner, param) = match key.trim().split_once('.') {
            Some((owner, param)) => (owner.trim(), Some(param.trim())),
            None => (key.trim(), None),
        };
        if owner.is_empty() || param.is_some_and(str::is_empty) || values.trim().is_empty() {
            return Err(no_knob());
        }
        let values = match values.split_once("..") {
            Some((lo, hi)) if !values.contains('"') => range(key.trim(), lo.trim(), hi.trim())?,
            _ => list(key.trim(), values)?,
        };
        Ok(KnobSpec { owner: owner.to_owned(), param: param.map(str::to_owned), values })
    }
}

impl KnobSpec {
    /// The key as written: `mesher.edge`.
    pub fn key(&self) -> String {
        match &self.param {
            Some(param) => format!("{}.{param}", self.owner),
            None => self.owner.clone(),
        }
    }
}

/// `6`, `24 mm`: the unit of the second stands for the first as well.
fn range(key: &str, lo: &str, hi: &str) -> Result<Values, StageError> {
    let no_range = || {
        fault(format!("`{key}`: `{lo}..{hi}` is no range"))
            .hint("write two numbers, the second with the unit, like `6..24 mm` or `0.001..0.01`")
    };
    let high = number(hi).ok_or_else(no_range)?;
    let low = match (number(lo).ok_or_else(no_range)?, high) {
        (Number::Plain(_), Number::Length(_)) => {
            let unit = hi.trim_start_matches(|c: char| !c.is_alphabetic() || c == 'e' || c == 'E');
            number(&format!("{lo} {unit}")).ok_or_else(no_range)?
        }
        (Number::Length(_), Number::Plain(_)) => return Err(no_range()),
        (low, _) => low,
    };
    match low.value() < high.value() {
        true => Ok(Values::Range(low, high)),
        false => {
            Err(fault(format!("`{key}`: the range {lo}..{hi} is empty"))
                .hint("the smaller number comes first"))
        }
    }
}

fn list(key: &str, values: &str) -> Result<Values, StageError> {
    let mut parts: Vec<String> = at_commas(values).into_iter().map(str::to_owned).collect();
    let mut seen = Vec::new();
    parts.retain(|p| {
        !seen.contains(p) && {
            seen.push(p.clone());
            true
        }
    });
    match parts.len() {
        0 | 1 => Err(fault(format!("`{key}` has one value and cannot be turned")).hint(format!(
            "give a range or two values, or fix it by `--set`, like `--set stages.{key}=...`"
        ))),
        _ => Ok(Values::List(parts)),
    }
}

fn number(text: &str) -> Option<Number> {
    let plain = text.parse::<f64>().ok().filter(|x| x.is_finite()).map(Number::Plain);
    plain.or_else(|| text.parse::<Length>().ok().map(|l| Number::Length(l.metres())))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn knob(text: &str) -> KnobSpec {
        text.parse().unwrap()
    }

    fn refused(text: &str) -> (String, String) {
        let e = text.parse::<KnobSpec>().unwrap_err();
        (e.message, e.hint.unwrap())
    }

    #[test]
    fn ranges_take_the_unit_of_their_end() {
        let six_to_24 = Values::Range(Number::Length(0.006), Number::Length(0.024));
        assert_eq!(knob("mesher.edge=6..24 mm").values, six_to_24);
        assert_eq!(knob(" mesher.edge = 6 mm .. 2.4 cm ").values, six_to_24);
        assert_eq!(knob("mesher.edge=6..24 mm").key(), "mesher.edge");
        assert_eq!(
            knob("StaticEquilibrium.speed=1e-4..1e-2").values,
            Values::Range(Number::Plain(1e-4), Number::Plain(1e-2))
        );
    }

    #[test]
    fn lists_are_cut_at_their_own_commas() {
        let found = knob("collider.volume=Aabb, KDop(14),Aabb");
        assert_eq!((found.owner.as_str(), found.param.as_deref()), ("collider", Some("volume")));
        assert_eq!(found.values, Values::List(vec!["Aabb".into(), "KDop(14)".into()]));
        assert_eq!(knob("solver=StaticEquilibrium,Xpbd").param, None);
    }

    #[test]
    fn faults_word_for_word() {
        let write = "write KEY=VALUES, like `mesher.edge=6..24 mm` or `solver=StaticEquilibrium,Xpbd`";
        assert_eq!(refused("mesher"), ("`mesher` is no knob".into(), write.into()));
        assert_eq!(refused("mesher.=1,2"), ("`mesher.=1,2` is no knob".into(), write.into()));
        assert_eq!(
            refused("mesher.edge=24..6 mm"),
            ("`mesher.edge`: the range 24..6 mm is empty".into(), "the smaller number comes first".into())
        );
        assert_eq!(
            refused("a.b=x..3"),
            (
                "`a.b`: `x..3` is no range".into(),
                "write two numbers, the second with the unit, like `6..24 mm` or `0.001..0.01`".into()
            )
        );
        assert_eq!(
            refused("solver=StaticEquilibrium"),
            (
                "`solver` has one value and cannot be turned".into(),
                "give a range or two values, or fix it by `--set`, like `--set stages.solver=...`".into()
            )
        );
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "[a-zA-Z.=,0-9 ()\"\\\\é-]{0,40}") {
            let _ = text.parse::<KnobSpec>();
        }

        #[test]
        fn a_written_range_is_read_back(lo in 1e-6..1.0f64, more in 1e-3..10.0f64) {
            let hi = lo + more;
            let found: KnobSpec = format!("a.b={lo}..{hi}").parse().unwrap();
            prop_assert_eq!(found.values, Values::Range(Number::Plain(lo), Number::Plain(hi)));
        }
    }
}

//! What a knob may be set to, as a dial from 0 to 1, and how its values stand in a pipeline file.

use crate::digits::to_digits;
use crate::knobs::knob::{Number, Values, fault};
use toile_core::{Finer, Length, ParamDoc, StageError};

/// What a knob may be.
#[derive(Debug, Clone, PartialEq)]
pub enum Dial {
    /// One of several stages, by name; the slot's own is among them or not.
    Stage(Vec<String>),
    /// One of several texts.
    List(Vec<String>),
    /// Between two numbers; `log` where steps are factors.
    Range {
        /// Least.
        lo: f64,
        /// Greatest.
        hi: f64,
        /// True where it is turned by factors.
        log: bool,
        /// How a number is written.
        form: NumberForm,
    },
}

/// How a number stands in a pipeline file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberForm {
    /// `"12 mm"`.
    Length,
    /// `12`.
    Whole,
    /// `0.5`.
    Real,
}

impl Dial {
    /// The value at a share of the dial, as it stands in a file.
    pub fn at(&self, share: f64) -> String {
        let nth = |list: &[String]| {
            let i = ((share * list.len() as f64) as usize).min(list.len().saturating_sub(1));
            list.get(i).cloned().unwrap_or_default()
        };
        match self {
            Dial::Stage(list) | Dial::List(list) => nth(list),
            Dial::Range { lo, hi, log, form } => {
                let x = if *log { lo * (hi / lo).powf(share) } else { lo + (hi - lo) * share };
                form.write(rounded(x).clamp(*lo, *hi))
            }
        }
    }

    /// Its finest number, by the way in which the parameter is refined.
    pub(crate) fn finest(&self, way: f64) -> Option<f64> {
        match self {
            Dial::Stage(_) => None,
            Dial::List(list) => {
                list.iter().filter_map(|v| numeric(v)).reduce(|a, b| if a * way < b * way { a } else { b })
            }
            Dial::Range { lo, hi, .. } => Some(if way > 0.0 { *lo } else { *hi }),
        }
    }

    /// In words, for the record.
    pub fn words(&self) -> String {
        match self {
            Dial::Stage(list) | Dial::List(list) => list.join(", "),
            Dial::Range { lo, hi, form, .. } => {
                format!("{} to {}", form.write(*lo).trim_matches('"'), form.write(*hi).trim_matches('"'))
            }
        }
    }

    /// True where it takes single values that cannot be averaged.
    pub fn is_discrete(&self) -> bool {
        !matches!(self, Dial::Range { .. })
    }

    /// The share at which a value stands; none for a value that the dial does not have.
    pub fn place(&self, value: &str) -> Option<f64> {
        match self {
            Dial::Stage(list) | Dial::List(list) => {
                let i = list.iter().position(|v| is_same(v, value))?;
                Some((i as f64 + 0.5) / list.len() as f64)
            }
            Dial::Range { .. } => self.share(value).map(|share| share.clamp(0.0, 1.0)),
        }
    }

    /// Whether two values are one, or nearer to each other than a share of the range.
    pub fn is_near(&self, a: &str, b: &str, share: f64) -> bool {
        is_same(a, b) || matches!((self.share(a), self.share(b)), (Some(x), Some(y)) if (x - y).abs() < share)
    }

    /// The share of its range at which a number stands, below 0 or above 1 for one outside; none
    /// where there is no range.
    fn share(&self, value: &str) -> Option<f64> {
        let Dial::Range { lo, hi, log, .. } = self else { return None };
        let x = numeric(value)?;
        let share = if *log { (x / lo).ln() / (hi / lo).ln() } else { (x - lo) / (hi - lo) };
        share.is_finite().then_some(share)
    }
}

/// Whether two texts of a file stand for one value: `1e-3` and `0.001`.
fn is_same(a: &str, b: &str) -> bool {
    a == b || numeric(a).is_some_and(|x| numeric(b) == Some(x))
}

impl NumberForm {
    /// A number as it stands in a file.
    pub fn write(self, x: f64) -> String {
        match self {
            NumberForm::Length => format!("\"{}\"", Length::m(x)),
            NumberForm::Whole => format!("{}", x.round()),
            NumberForm::Real => format!("{x:?}"),
        }
    }

    /// How a parameter is written; none for one that is no number.
    pub fn of(doc: &ParamDoc) -> Option<NumberForm> {
        match doc.kind.trim_end_matches(" (or None)") {
            "length" => Some(NumberForm::Length),
            "whole number" => Some(NumberForm::Whole),
            "number" => Some(NumberForm::Real),
            _ => None,
        }
    }
}

/// A number or a quoted length of a file; a length in metres.
pub fn numeric(text: &str) -> Option<f64> {
    let bare = text.trim().trim_matches('"');
    bare.parse::<f64>().ok().or_else(|| bare.parse::<Length>().ok().map(Length::metres))
}

/// Which way a parameter is refined, by its card: 1 where less is finer, -1 where more is; none
/// where it is no resolution.
pub(crate) fn way(doc: &ParamDoc) -> Option<f64> {
    doc.finer.map(|finer| match finer {
        Finer::Less => 1.0,
        Finer::More => -1.0,
    })
}

/// True of a resolution in space, such as an edge length or the parts of an edge: the reference
/// must have a finer one than what it judges. Steps and tolerances may be equal.
pub(crate) fn is_spatial(doc: &ParamDoc) -> bool {
    let parts = NumberForm::of(doc) == Some(NumberForm::Whole) && doc.unit == "parts";
    doc.finer.is_some() && (NumberForm::of(doc) == Some(NumberForm::Length) || parts)
}

/// To three digits, so that settings that are alike become equal.
pub(crate) fn rounded(x: f64) -> f64 {
    to_digits(x, 3)
}

/// True where `value` is finer than `other` by a factor; `way` is 1 where less is finer, -1 where
/// more is.
pub(crate) fn is_finer(way: f64, value: f64, other: f64, factor: f64) -> bool {
    (other / value).powf(way) >= factor * (1.0 - 1e-9)
}

/// The dial of a parameter for the values of a knob.
///
/// Errors: values that the parameter does not take.
pub(crate) fn dial(key: &str, doc: &ParamDoc, values: &Values) -> Result<Dial, StageError> {
    match values {
        Values::List(list) => {
            let text = |v: &String| match NumberForm::of(doc) {
                Some(NumberForm::Length) if v.parse::<Length>().is_ok() => format!("\"{v}\""),
                _ => v.clone(),
            };
            let list: Vec<String> = list.iter().map(text).collect();
            list.iter().try_for_each(|v| check(key, doc, v))?;
            Ok(Dial::List(list))
        }
        Values::Range(lo, hi) => range(key, doc, *lo, *hi),
    }
}

fn range(key: &str, doc: &ParamDoc, lo: Number, hi: Number) -> Result<Dial, StageError> {
    let no_range = || fault(format!("`{key}` is {}, which has no range", doc.kind));
    let form = NumberForm::of(doc).ok_or_else(|| no_range().hint("list its values with commas"))?;
    if (form == NumberForm::Length) != matches!(hi, Number::Length(_)) {
        let unit = "write the unit, like `6..24 mm`";
        let hint = if form == NumberForm::Length { unit } else { "write bare numbers" };
        return Err(fault(format!("`{key}` is a {}", doc.kind)).hint(hint));
    }
    let (lo, hi) = (lo.value(), hi.value());
    check(key, doc, &form.write(lo))?;
    check(key, doc, &form.write(hi))?;
    Ok(Dial::Range { lo, hi, log: lo > 0.0, form })
}

fn check(key: &str, doc: &ParamDoc, text: &str) -> Result<(), StageError> {
    doc.check.run(text, doc).map_err(|f| {
        let e = fault(format!("`{key}`: {}", f.message));
        match f.hint {
            Some(hint) => e.hint(hint),
            None => e,
        }
    })
}
